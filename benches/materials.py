#!/usr/bin/env python3
"""Errors of the shading models on every real material, as a table.

Runs `roughcast compare` on each normal map of a folder of materials (one a folder; all of a folder that holds numbered
maps) and prints the root mean square error of models relative to that of ordinary bump mapping (blinn-phong) in each view,
each against the supersampled ground truth of its own base lobe, and the medians.

    cargo build --release
    benches/materials.py ../shared/data/materials target/release/roughcast [options of compare]
"""

import json
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

MODELS = ["lean", "clean", "variance", "toksvig"]
PLAIN = "blinn-phong"
VIEWS = ["near", "mid", "far", "grazing"]
NORMAL_MAP = re.compile(r"(normal|normals|_nrm|_nrm_rgh|\d{4})\.(png|jpe?g|webp)$", re.IGNORECASE)


def normal_maps(materials: Path) -> list[Path]:
    """The normal maps of a folder of materials, in order."""
    return sorted(path for path in materials.glob("*/*") if NORMAL_MAP.search(path.name))


def errors(program: Path, image: Path, options: list[str]) -> dict[tuple[str, str], float]:
    """The root mean square error by view and model, with the anisotropic filter; empty where the program refuses."""
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "compare", image, "-o", f"{folder}/report", "--frames", "0", "--filters", "anisotropic"]
        done = subprocess.run([*command, *options], capture_output=True, text=True)
        if done.returncode != 0:
            said = done.stderr.strip().splitlines() or ["it was stopped without a word"]
            print(f"{image.name}: {said[-1]}", file=sys.stderr)
            return {}
        results = json.loads(Path(folder, "report", "results.json").read_text())
    return {(row["view"], row["method"]): row["rmse"] for row in results if row["map"] == image.name}


def main() -> int:
    if len(sys.argv) < 3:
        print("usage: materials.py FOLDER_OF_MATERIALS PROGRAM [OPTIONS OF compare]", file=sys.stderr)
        return 2
    materials, program, options = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]
    columns = [(view, model) for view in VIEWS for model in MODELS]
    ratios = {column: [] for column in columns}
    print("| material | " + " | ".join(f"{view} {model}" for view, model in columns) + " |")
    print("|---" * (len(columns) + 1) + "|")
    for image in normal_maps(materials):
        found = errors(program, image, options)
        if not found:
            continue
        cells = []
        for view, model in columns:
            ratio = found[view, model] / found[view, PLAIN]
            ratios[view, model].append(ratio)
            cells.append(f"{ratio:.3f}")
        print(f"| {image.parent.name}/{image.stem} | " + " | ".join(cells) + " |", flush=True)
    print("| **median** | " + " | ".join(f"**{statistics.median(ratios[column]):.3f}**" for column in columns) + " |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
