"""Compares our decoded pixels with those of other decoders, over the cross product of what each format allows.

    python tools/oracle [--format NAME]... [--full | --random SECONDS] [--seed N] [--decoder PROGRAM] [--keep FOLDER]

Without options it uses files in which each pair of values of two axes occurs, several times over (half a minute);
--full uses every combination, up to a bound (many minutes); --random uses random ones until the time is up. A file is
equal, or refused for a reason in the table (refusals.py), or a failure, which is kept.
"""

import argparse
import itertools
import subprocess
import tempfile
import time
from pathlib import Path

import case as cases
import formats.registry
from decoder import decode
from tally import Tally

REPOSITORY = Path(__file__).resolve().parent.parent.parent
# Files per run of the decoder.
BATCH = 256
# How many times a short run covers all pairs, each time with different files.
ROUNDS = 4
# Maximum number of combinations of one family with --full; they are chosen at random if there are more.
FULL_LIMIT = 4000
# The run stops after this many consecutive random combinations without anything new.
PATIENCE = 1000


def arguments(words=None):
    parser = argparse.ArgumentParser(prog="oracle", description="Compares our readers with other decoders.")
    parser.add_argument("--format", action="append", help="only this format; may be repeated")
    amount = parser.add_mutually_exclusive_group()
    amount.add_argument("--full", action="store_true", help="every combination, up to a bound")
    amount.add_argument("--random", type=float, metavar="SECONDS", help="random combinations for this long")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--decoder", type=Path, help="the program dump of roughcast-fuzz, if it is already built")
    parser.add_argument("--keep", type=Path, default=REPOSITORY / "target/oracle-failures", help="where failures go")
    parser.add_argument("--report", type=Path, help="writes all failures and counts of refusals into this file")
    return parser.parse_args(words)


def build():
    """The program that decodes, built as the fuzzing builds it."""
    command = ["cargo", "build", "--release", "--locked", "-p", "roughcast-fuzz", "--bin", "dump"]
    subprocess.run(command, cwd=REPOSITORY, check=True)
    return REPOSITORY / "target/release/dump"


def chosen(options, families):
    """The cases of a run."""
    if options.random is not None:
        end = time.monotonic() + options.random
        return itertools.takewhile(lambda _: time.monotonic() < end, cases.at_random(families, options.seed))
    return itertools.chain.from_iterable(of_family(family, options) for family in families)


def of_family(family, options):
    if not options.full:
        rounds = (cases.pairs(family, options.seed + index) for index in range(ROUNDS))
        return distinct(itertools.chain.from_iterable(rounds))
    if family.size() <= FULL_LIMIT:
        return cases.every(family)
    return itertools.islice(distinct(cases.at_random([family], options.seed)), FULL_LIMIT)


def distinct(stream):
    """Each case once; ends when nothing new has appeared for a while."""
    seen, repeated = set(), 0
    for case in stream:
        repeated = repeated + 1 if case.name in seen else 0
        if repeated > PATIENCE:
            return
        if case.name not in seen:
            seen.add(case.name)
            yield case


def compare_all(source, program, tally):
    """Decodes and judges all cases, a batch at a time."""
    with tempfile.TemporaryDirectory(prefix="oracle-") as folder:
        while batch := list(itertools.islice(source, BATCH)):
            for case, outcome in zip(batch, decode(program, batch, folder), strict=True):
                tally.add(case, outcome)


def main(words=None):
    """The whole comparison; returns the exit status."""
    options = arguments(words)
    families = formats.registry.families(options.format)
    program, begin = options.decoder or build(), time.monotonic()
    tally = Tally(options.keep)
    compare_all(iter(chosen(options, families)), program, tally)
    lines = tally.lines()
    if options.random is None:
        lines += tally.stale_rules({family.format for family in families})
    print("\n".join(lines))
    if options.report:
        options.report.write_text("\n".join([*lines, *tally.refusal_lines()]) + "\n")
    is_fine = len(lines) == len(list(tally.table())) and tally.total() > 0
    print(f"oracle: {tally.total()} files in {time.monotonic() - begin:.0f} s, {'all in order' if is_fine else 'FAILED'}")
    return 0 if is_fine else 1
