#!/usr/bin/env bash
# Times roughcast against OpenImageIO's maketx at the same work: a 4096x4096 16-bit height map in, a tiled, mip-mapped EXR
# with the six half channels of bump slopes out, compressed with ZIP. Whole processes, alternating.
#
#   benches/compare.sh [HEIGHTS]      HEIGHTS: a height map, tiled to 4096x4096; default: one of testdata/
#
# ROUGHCAST=path  the program to time (default: built here, in release)
# RUNS=n          turns of each program (default 3)
#
# Needs Python 3 with venv and pip; OpenImageIO is installed under target/compare only. Ends with an error if
# the two programs disagree about level 0, since then they did not do the same work.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
heights=$(realpath "${1:-$root/testdata/heights/jme_mountains512.png}")
work=${CARGO_TARGET_DIR:-$root/target}/compare
runs=${RUNS:-3}

if [[ ! -r $heights ]]; then
    echo "compare.sh: there is no height map at $heights: name one" >&2
    exit 1
fi
mkdir -p "$work"
if [[ ! -x $work/venv/bin/maketx ]]; then
    python3 -m venv "$work/venv"
    "$work/venv/bin/pip" install --quiet OpenImageIO numpy
fi
if [[ -z ${ROUGHCAST:-} ]]; then
    cargo build --quiet --release --manifest-path "$root/Cargo.toml" --package roughcast-cli
    ROUGHCAST=${CARGO_TARGET_DIR:-$root/target}/release/roughcast
fi

cat >"$work/compare.py" <<'PYTHON'
"""Makes the input, runs both programs in turns, compares what they wrote, prints a table."""

import json
import os
import statistics
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio

SIDE = 4096
CHANNELS = ("b0_h", "b1_dhds", "b2_dhdt", "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt")
# Both programs sum in single floats, in orders of their own, and round to half: a sum may fall on the other side of a
# rounding boundary (one unit in the last place of a half), and near zero its own rounding error shows.
HALF_UNITS = 1
SUM_ERROR = 2.0**-21

# Runs a program in a process of its own, so that the peak of memory is that program's alone.
RUNNER = """
import json, resource, subprocess, sys, time
start = time.perf_counter()
code = subprocess.run(sys.argv[1:], stdout=sys.stderr).returncode
seconds = time.perf_counter() - start
print(json.dumps([code, seconds, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss]))
"""


def make_input(heights, path):
    source = oiio.ImageInput.open(heights)
    if source is None:
        sys.exit(f"compare.sh: {heights}: {oiio.geterror()}")
    spec = source.spec()
    pixels = np.asarray(source.read_image("uint16")).reshape(spec.height, spec.width, -1)[..., :1]
    times = (-(-SIDE // spec.height), -(-SIDE // spec.width), 1)
    pixels = np.ascontiguousarray(np.tile(pixels, times)[:SIDE, :SIDE])
    target = oiio.ImageOutput.create(path)
    target.open(path, oiio.ImageSpec(SIDE, SIDE, 1, "uint16"))
    target.write_image(pixels)
    target.close()


def timed(command):
    run = subprocess.run([sys.executable, "-c", RUNNER, *command], stdout=subprocess.PIPE, check=True)
    code, seconds, peak_kib = json.loads(run.stdout)
    if code != 0:
        sys.exit(f"compare.sh: this ended with {code}: {' '.join(command)}")
    return seconds, peak_kib / 1024


def level(path, index):
    source = oiio.ImageInput.open(path)
    if source is None or not source.seek_subimage(0, index):
        sys.exit(f"compare.sh: {path} has no level {index}")
    spec = source.spec()
    if spec.channelnames != CHANNELS or spec.format != oiio.TypeHalf or spec["compression"] != "zip":
        sys.exit(f"compare.sh: {path}: {spec.format} {spec.channelnames}, {spec['compression']}: not the same work")
    pixels = np.asarray(source.read_image(0, index, 0, spec.nchannels, "half"))
    return pixels.reshape(spec.height, spec.width, spec.nchannels).astype(np.float32)


def check_agreement(first, second):
    """Prints the largest difference of each level; exits where those of level 0 are more than rounding."""
    for index in range(SIDE.bit_length()):
        a, b = level(first, index), level(second, index)
        difference = np.abs(a - b)
        print(f"level {index:2}, largest difference:", *(f"{n}" for n in difference.max(axis=(0, 1))))
        unit = np.spacing(np.maximum(np.abs(a), np.abs(b)).astype(np.float16)).astype(np.float32)
        if index == 0 and (difference > np.maximum(HALF_UNITS * unit, SUM_ERROR)).any():
            sys.exit("compare.sh: level 0 differs by more than rounding: the programs did not do the same work")


def main(heights, roughcast, work, runs):
    source = os.path.join(work, "heights-4096.png")
    outputs = {name: os.path.join(work, f"{name}.exr") for name in ("maketx", "roughcast")}
    make_input(heights, source)
    # The program itself: the wheel's command of this name is a Python script that starts it.
    maketx = os.path.join(os.path.dirname(oiio.__file__), "bin", "maketx")
    # maketx takes heights in texels; one unit of roughcast's height scale is the width of the map.
    commands = {
        "maketx": [maketx, source, "--bumpslopes", "--bumpformat", "height", "-d", "half"]
        + ["--compression", "zip", "--format", "exr", "--wrap", "clamp", "-o", outputs["maketx"]],
        "roughcast": [roughcast, "bake", source, "--as", "bump-slopes", "--kind", "height", "--bits", "half"]
        + ["--wrap", "clamp", "--height-scale", repr(1 / SIDE), "-o", outputs["roughcast"]],
    }
    results = {name: [] for name in commands}
    for _ in range(runs):
        for name, command in commands.items():
            results[name].append(timed(command))
    check_agreement(outputs["maketx"], outputs["roughcast"])

    medians = {name: statistics.median(seconds for seconds, _ in rows) for name, rows in results.items()}
    load = os.getloadavg()[0]
    print(f"\nOpenImageIO {oiio.VERSION_STRING}, {os.cpu_count()} processors, load {load:.1f}, {runs} runs each\n")
    print("| tool | seconds, median | seconds, least | peak MiB | output MiB | times faster |")
    print("|---|---|---|---|---|---|")
    for name, rows in results.items():
        least = min(seconds for seconds, _ in rows)
        peak = max(peak for _, peak in rows)
        size = os.path.getsize(outputs[name]) / 2**20
        ratio = medians["maketx"] / medians[name]
        print(f"| {name} | {medians[name]:.2f} | {least:.2f} | {peak:.0f} | {size:.1f} | {ratio:.1f} |")


main(sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4]))
PYTHON
"$work/venv/bin/python" "$work/compare.py" "$heights" "$ROUGHCAST" "$work" "$runs"
