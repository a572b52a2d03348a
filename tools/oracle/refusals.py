"""What our readers refuse, and why: the comparison allows these refusals and no other, and the manual prints them."""

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Refusal:
    """Files of a format whose traits have these values (any of several) are refused, with an error in these words."""

    format: str
    what: str
    why: str
    when: tuple
    words: str

    def covers(self, case):
        """Whether it speaks of such a file."""
        return case.format == self.format and all(
            key in case.traits and case.traits[key] in values for key, values in self.when
        )

    def matches(self, error):
        """Whether the error is the one that is expected."""
        return re.search(self.words, error) is not None


def refusal(format, what, why, words, **when):
    listed = tuple((key, tuple(value) if isinstance(value, (list, tuple)) else (value,)) for key, value in when.items())
    return Refusal(format, what, why, listed, words)


REFUSALS = []
