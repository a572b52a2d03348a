"""The outcomes of all files: counts, and descriptions of the failures."""

import re
from collections import Counter, defaultdict

from compare import DIFFERENT, EQUAL, REFUSED, UNEXPECTED, judge
from refusals import REFUSALS

# Maximum number of failures per format that are kept as files.
KEPT = 12
# Maximum number of axis values that are listed as suspects.
SUSPECTS = 20
# Failures whose words agree up to this length count as the same.
SAME_WORDS = 70


class Tally:
    """The outcomes of the files."""

    def __init__(self, keep, rules=REFUSALS):
        self.rules = rules
        self.counts = defaultdict(Counter)
        self.failures = defaultdict(list)
        self.equal_traits = defaultdict(set)
        self.refusals = defaultdict(Counter)
        self.keep = keep

    def add(self, case, outcome):
        """Judges a case, and keeps its file if it fails."""
        verdict = judge(case, outcome, self.rules)
        self.counts[case.format][verdict.word] += 1
        if verdict.word == REFUSED:
            self.refusals[case.format][verdict.rule] += 1
        elif verdict.word == EQUAL:
            self.equal_traits[case.format].update(case.traits.items())
        else:
            self.failures[case.format].append((case.name, case.traits, verdict))
            self.save(case, len(self.failures[case.format]))

    def save(self, case, number):
        if number <= KEPT:
            self.keep.mkdir(parents=True, exist_ok=True)
            (self.keep / f"{case.format.lower()}-{number}.{case.suffix}").write_bytes(case.data)

    def total(self):
        """How many files there were."""
        return sum(counts.total() for counts in self.counts.values())

    def table(self):
        """A line per format."""
        yield f"{'format':<8}{'tried':>8}{'equal':>8}{'refused':>9}{'different':>11}{'unexpected refusals':>21}"
        for name, counts in self.counts.items():
            words = (counts[EQUAL], counts[REFUSED], counts[DIFFERENT], counts[UNEXPECTED])
            yield "{:<8}{:>8}{:>8}{:>9}{:>11}{:>21}".format(name, sum(words), *words)

    def lines(self):
        """The table, and below it the failures of each format."""
        lines = list(self.table())
        for name, failures in self.failures.items():
            lines += ["", f"{name}:", *summary_of_failures(failures, self.equal_traits[name])]
        return lines

    def stale_rules(self, run):
        """A line for each row of the table for which no file was refused: it is outdated."""
        met = {rule for counts in self.refusals.values() for rule in counts}
        for rule in self.rules:
            if rule.format in run and rule not in met:
                yield f"the table of refusals names {rule.format}: {rule.what}, but no such file was refused"

    def refusal_lines(self):
        """How many files each row of the table was needed for."""
        for name, counts in self.refusals.items():
            yield f"\n{name}, refused as the table says:"
            yield from (f"- {count}: {rule.what}" for rule, count in counts.items())


def summary_of_failures(failures, equal):
    """Failures with the same words together: how many, what they share that no equal file has, and one of them."""
    groups = defaultdict(list)
    for name, traits, verdict in failures:
        words = re.sub(r"[-+]?\d[\d.e+-]*%?|inf", "N", verdict.detail)
        groups[(verdict.word, words[:SAME_WORDS])].append((name, traits, verdict))
    for (word, _), members in sorted(groups.items(), key=lambda item: -len(item[1])):
        first, _, verdict = members[0]
        yield f"{len(members)} {word}: {verdict.detail}"
        seen = Counter(trait for _, traits, _ in members for trait in traits.items())
        suspects = [f"{key} {value} ({count})" for (key, value), count in seen.most_common() if (key, value) not in equal]
        if suspects:
            yield f"    never equal with: {'; '.join(suspects[:SUSPECTS])}"
        shared = [f"{key} {value}" for (key, value), count in seen.items() if count == len(members) > 1]
        if shared:
            yield f"    all have: {'; '.join(shared)}"
        yield f"    one: {first}"
