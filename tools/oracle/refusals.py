"""What our readers refuse, and why: the comparison allows these refusals and no other, and the manual prints them."""

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Refusal:
    """Files of a format whose traits have these values are refused, with an error in these words."""

    format: str
    what: str
    why: str
    words: str
    when: tuple

    def covers(self, case):
        """Whether it speaks of such a file."""
        return case.format == self.format and all(
            key in case.traits and case.traits[key] in values for key, values in self.when
        )

    def matches(self, error):
        """Whether the error is the one that is expected."""
        return re.search(self.words, error) is not None


def refusal(format, what, why, words, **when):
    """A row of the table. A trait may have one of several values."""
    listed = tuple((key, tuple(value) if isinstance(value, list) else (value,)) for key, value in when.items())
    return Refusal(format, what, why, words, listed)


INTEGERS = "integers name things, and are not values of 0 to 1"
RARE = "rare; other programs convert it"
NOT_2D = "a map is one picture"

REFUSALS = [
    refusal("JPEG", "arithmetic coding", RARE, "arithmetic coding is not supported", coding="arithmetic"),
    refusal("JPEG", "CMYK", "a map has no inks", "colour type CMYK", kind="CMYK"),
    refusal("JPEG", "12 bits a sample", RARE, "sample of 12 bits", kind="12 bits"),
    refusal(
        "JPEG",
        "a component with a sampling factor between one and the largest, in a scan of its own, at some sizes",
        "the decoder would take the wrong number of its blocks",
        "a component of an unusual size in a scan of its own",
        sampling=["4x1,2x1,1x1", "1x4,1x2,1x1", "4x2,2x1,1x1", "4x2,2x2,1x1"],
    ),
    refusal("TGA", "interleaved rows", RARE, "interleaved rows", interleaving=[1, 2]),
    refusal(
        "TGA",
        "grey of 16 bits without attribute bits",
        "some programs mean grey and alpha, others grey of 16 bits",
        "does not say whether half of them are alpha",
        kind="grey 16-bit",
    ),
    refusal(
        "TGA",
        "palettes of 15 bits with indices of 16",
        RARE,
        "Indices larger than pixel values",
        kind="palette of 15 bits",
        index_bits=16,
    ),
    refusal("BMP", "channels of more than 8 bits", "the decoder would cut them to 8", "a channel of 10 bits", kind="10-bit"),
    refusal("BMP", "headers of OS/2 2.0", RARE, "Unknown bitmap header type", header=["OS/2 2.0", "OS/2 2.0, short"]),
    refusal("WebP", "animations", "a map is one picture", "an animation is not supported", frames=[2, 3]),
    refusal("HDR", "XYZE", "its numbers are another colour space's", "32-bit_rle_xyze is not supported", header="XYZE"),
]
