"""Runs our reader over many files: the program `dump` of roughcast-fuzz."""

import subprocess
from pathlib import Path

import numpy as np

from compare import Outcome

TYPES = {"u8": np.uint8, "u16": np.dtype("<u2"), "f16": np.dtype("<f2"), "f32": np.dtype("<f4")}


def decode(program, cases, folder):
    """The outcome of each case, whose files are written to the folder and removed again."""
    folder = Path(folder)
    lines, paths = [], []
    for index, case in enumerate(cases):
        path = folder / f"{index:06}.{case.suffix}"
        path.write_bytes(case.data)
        paths.append(path)
        lines.append("\t".join([str(path), case.layer, ",".join(case.channels)]))
    listing, pixels = folder / "files.tsv", folder / "pixels.bin"
    listing.write_text("".join(line + "\n" for line in lines))
    # Panics are caught and reported on standard output; their traces on standard error add nothing.
    done = subprocess.run([program, listing, pixels], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    answers = done.stdout.decode().splitlines()
    if done.returncode != 0 or len(answers) != len(cases):
        crashed = cases[len(answers)].name if len(answers) < len(cases) else "the end"
        raise RuntimeError(f"{program} ended with {done.returncode} at {crashed}: {done.stderr.decode()[-500:]}")
    outcomes = list(outcomes_of(answers, pixels.read_bytes()))
    for path in [*paths, listing, pixels]:
        path.unlink()
    return outcomes


def outcomes_of(answers, pixels):
    """Parses the program's lines and its file of samples."""
    start = 0
    for answer in answers:
        word, *fields = answer.split("\t")
        if word != "read":
            yield Outcome(error=fields[0], panicked=word == "panicked")
            continue
        width, height, channels, sample, value_range, warnings = fields
        names = tuple(channels.split(","))
        shape = (int(height), int(width), len(names))
        kind = np.dtype(TYPES[sample])
        count = int(np.prod(shape))
        samples = np.frombuffer(pixels, kind, count, start).reshape(shape)
        start += count * kind.itemsize
        yield Outcome(samples=samples, range=value_range, channels=names, warnings=warnings)
