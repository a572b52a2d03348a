"""Compares our decoded pixels with those of other decoders, over the cross product of what each format allows.

    python tools/oracle [--format NAME]... [--full | --random SECONDS] [--seed N] [--decoder PROGRAM] [--keep FOLDER]

Without options it takes files in which each pair of values of two axes occurs (tens of seconds); --full takes every
combination, up to a bound; --random takes random ones until the time is over. A file is equal, refused for a reason that
is in the table (refusals.py), or it is a failure and is kept.
"""

import argparse
import itertools
import random
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from pathlib import Path

import case as cases
import formats.registry
from compare import DIFFERENT, EQUAL, REFUSED, UNEXPECTED, judge
from decoder import decode
from refusals import REFUSALS

REPOSITORY = Path(__file__).resolve().parent.parent.parent
# Files that one run of the decoder takes, and most failures of one format that are printed.
BATCH = 256
SHOWN = 12
# Combinations of one family that --full takes at most, chosen at random where there are more.
FULL_LIMIT = 4000


def arguments():
    parser = argparse.ArgumentParser(prog="oracle", description="Compares our readers with other decoders.")
    parser.add_argument("--format", action="append", help="only this format; may be repeated")
    parser.add_argument("--full", action="store_true", help="every combination, up to a bound")
    parser.add_argument("--random", type=float, metavar="SECONDS", help="random combinations for so long")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--decoder", type=Path, help="the program dump of roughcast-fuzz, if it is built already")
    parser.add_argument("--keep", type=Path, default=REPOSITORY / "target/oracle-failures", help="where failures go")
    parser.add_argument("--report", type=Path, help="writes every failure and refusal into this file")
    return parser.parse_args()


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
        return itertools.islice(cases.pairs(family, options.seed), family.short)
    if family.size() <= FULL_LIMIT:
        return cases.every(family)
    return itertools.islice(distinct(cases.at_random([family], options.seed)), FULL_LIMIT)


def distinct(endless):
    """Each case once; ends where nothing new has come for long."""
    seen, repeated = set(), 0
    for case in endless:
        repeated = repeated + 1 if case.name in seen else 0
        if repeated > 1000:
            return
        if case.name not in seen:
            seen.add(case.name)
            yield case


class Tally:
    """What became of the files."""

    def __init__(self, keep):
        self.counts = defaultdict(Counter)
        self.failures = defaultdict(list)
        self.equal_traits = defaultdict(set)
        self.refusals = defaultdict(Counter)
        self.keep = keep

    def add(self, case, outcome):
        verdict = judge(case, outcome, REFUSALS)
        self.counts[case.format][verdict.word] += 1
        if verdict.word == REFUSED:
            self.refusals[case.format][verdict.rule] += 1
        elif verdict.word == EQUAL:
            self.equal_traits[case.format].update(case.traits.items())
        else:
            self.failures[case.format].append((case, verdict))
            self.save(case, len(self.failures[case.format]))

    def save(self, case, number):
        if number <= SHOWN:
            self.keep.mkdir(parents=True, exist_ok=True)
            path = self.keep / f"{case.format.lower()}-{number}.{case.suffix}"
            path.write_bytes(case.data)

    def stale(self, families, complete):
        """Rows of the table that no file of a complete run was refused for: they are not true any more."""
        run = {family.format for family in families}
        met = {rule for counts in self.refusals.values() for rule in counts}
        return [rule for rule in REFUSALS if complete and rule.format in run and rule not in met]

    def table(self):
        yield f"{'format':<8}{'tried':>8}{'equal':>8}{'refused':>9}{'different':>11}{'unexpected refusals':>21}"
        for name, counts in self.counts.items():
            words = (counts[EQUAL], counts[REFUSED], counts[DIFFERENT], counts[UNEXPECTED])
            yield "{:<8}{:>8}{:>8}{:>9}{:>11}{:>21}".format(name, sum(words), *words)


def summary_of_failures(failures, equal):
    """Failures with the same words together: how many, what they share that no equal file has, and one of them."""
    groups = defaultdict(list)
    for case, verdict in failures:
        words = re.sub(r"[-+]?\d[\d.e+-]*%?|inf", "N", verdict.detail)
        groups[(verdict.word, words[:70])].append((case, verdict))
    for (word, _), members in sorted(groups.items(), key=lambda item: -len(item[1])):
        first, verdict = members[0]
        yield f"{len(members)} {word}: {verdict.detail}"
        seen = Counter(trait for case, _ in members for trait in case.traits.items())
        # Values of the axes that only failures have; of these, those of many files first.
        guilty = [f"{key} {value} ({count})" for (key, value), count in seen.most_common() if (key, value) not in equal]
        if guilty:
            yield f"    never equal with: {'; '.join(guilty[:20])}"
        shared = [f"{key} {value}" for (key, value), count in seen.items() if count == len(members) > 1]
        if shared:
            yield f"    all have: {'; '.join(shared)}"
        yield f"    one: {first.name}"


def main():
    options = arguments()
    families = formats.registry.families(options.format)
    program = options.decoder or build()
    tally, begin = Tally(options.keep), time.monotonic()
    source = iter(chosen(options, families))
    with tempfile.TemporaryDirectory(prefix="oracle-") as folder:
        while batch := list(itertools.islice(source, BATCH)):
            for case, outcome in zip(batch, decode(program, batch, folder)):
                tally.add(case, outcome)
    lines = list(tally.table())
    for name, failures in tally.failures.items():
        lines += ["", f"{name}:", *summary_of_failures(failures, tally.equal_traits[name])]
    for rule in tally.stale(families, options.random is None):
        lines += ["", f"the table of refusals says {rule.format}: {rule.what}, but no such file was refused"]
    print("\n".join(lines))
    if options.report:
        write_report(options.report, lines, tally)
    failed = any(tally.failures.values()) or tally.stale(families, options.random is None)
    print(f"oracle: {sum(c.total() for c in tally.counts.values())} files in {time.monotonic() - begin:.0f} s")
    return 1 if failed else 0


def write_report(path, lines, tally):
    more = []
    for name, counts in tally.refusals.items():
        more += ["", f"{name}, refused as the table says:"]
        more += [f"- {count}: {rule.what}" for rule, count in counts.items()]
    path.write_text("\n".join([*lines, *more]) + "\n")


if __name__ == "__main__":
    sys.exit(main())
