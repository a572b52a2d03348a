"""The files that our readers refuse, and why: the comparison allows only these refusals, and the manual prints them."""

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Refusal:
    """Files of a format whose traits have these values are refused, with an error that matches `words`."""

    format: str
    what: str
    why: str
    words: str
    when: tuple

    def covers(self, case):
        """Whether it applies to this file."""
        return case.format == self.format and all(
            key in case.traits and case.traits[key] in values for key, values in self.when
        )

    def matches(self, error):
        """Whether the error is the one that is expected."""
        return re.search(self.words, error) is not None


def refusal(format, what, why, words, /, **when):
    """A row of the table. A trait may have one of several values."""
    listed = tuple((key, tuple(value) if isinstance(value, list) else (value,)) for key, value in when.items())
    return Refusal(format, what, why, words, listed)


INTEGERS = "integers are identifiers, not values from 0 to 1"
RARE = "rare; other programs can convert it"
NOT_2D = "a map is one flat picture"

REFUSALS = [
    refusal("JPEG", "arithmetic coding", RARE, "arithmetic coding is not supported", coding="arithmetic"),
    refusal("JPEG", "CMYK", "maps do not use inks", "colour type CMYK", kind="CMYK"),
    refusal("JPEG", "12 bits per sample", RARE, "sample of 12 bits", kind="12 bits"),
    refusal(
        "JPEG",
        "a component with a sampling factor between one and the largest, in a scan of its own, at some sizes",
        "the decoder would read the wrong number of its blocks",
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
    refusal(
        "BMP",
        "runs that leave out pixels",
        "some programs make them black, others the first colour of the palette",
        "leaves out pixels",
        kind=["RLE8 with jumps", "RLE4 with jumps"],
    ),
    refusal("WebP", "animations", NOT_2D, "an animation is not supported", frames=[2, 3]),
    refusal("HDR", "XYZE", "values are in another colour space", "32-bit_rle_xyze is not supported", header="XYZE"),
    refusal("TIFF", "JPEG compression", "lossy, and rare for maps", "JPEG compression is not supported", compression="JPEG"),
    refusal("TIFF", "JPEG 2000 compression", RARE, "JPEG 2000 compression", compression="JPEG 2000"),
    refusal("TIFF", "LERC compression", RARE, "LERC compression", compression="LERC"),
    refusal("TIFF", "LZMA compression", RARE, "LZMA compression", compression="LZMA"),
    refusal(
        "TIFF",
        "CCITT run-length and group 3 compression",
        "fax codes for black and white",
        "CCITT (run-length|Group 3) compression",
        compression=["CCITT modified Huffman", "CCITT group 3"],
    ),
    refusal("TIFF", "integers of 64 bits", INTEGERS, "integers of 64 bits", type=["64", "signed 64"]),
    refusal("TIFF", "CMYK", "maps do not use inks", "CMYK colour", layout="CMYK"),
    refusal("TIFF", "L*a*b*", "values are in another colour space", r"L\*a\*b\* colour", layout="L*a*b*"),
    refusal("TIFF", "complex numbers", "not a picture", "complex numbers", odd=["complex", "complex integers"]),
    refusal("TIFF", "YCbCr", "values are in another colour space", "YCbCr colour", odd="YCbCr"),
    refusal("TIFF", "colour filter arrays", "raw sensor data", "filter array", odd="filter array"),
    refusal(
        "TIFF",
        "more than four samples that the file does not name, unless options choose",
        "ambiguous: a guess could be wrong",
        "its channel names are ambiguous",
        odd="six samples",
    ),
    refusal("EXR", "unsigned integers", INTEGERS, "integer channel", types="uint"),
    refusal(
        "EXR",
        "a data window outside of the display window",
        "nothing of it is visible",
        "outside of the display window",
        window=["partly outside", "overscan"],
        size=(1, 1),
    ),
    refusal(
        "EXR",
        "channels whose names do not identify the map, unless options choose",
        "ambiguous: a guess could be wrong",
        "its channel names are ambiguous",
        names=["two heights", "unknown names", "mask alone", "two layers"],
    ),
    refusal("EXR", "deep data", NOT_2D, "deep data is not supported", storage=["deep scan lines", "deep tiles"]),
    refusal("EXR", "HTJ2K compression", "new, and no Rust decoder supports it", "HTJ2K compression", compression="htj2k256"),
    refusal(
        "KTX2",
        "integers that are not normalised, 64-bit and double formats",
        INTEGERS,
        "integer (or double )?format",
        format=["8-bit integers", "8-bit signed integers", "16-bit integers", "32-bit integers", "doubles", "8-bit scaled",
                "8-bit integers, packed", "10-bit integers", "scaled 10 bits"],
    ),
    refusal(
        "KTX2",
        "shared exponents and floats of 10 and 11 bits",
        "HDR colour formats without a sign",
        "shared-exponent or 10/11-bit float",
        format=["shared exponent", "11-bit floats"],
    ),
    refusal("KTX2", "depth and stencil", "not a picture", "depth or stencil format", format="depth"),
    refusal("KTX2", "BC6H", "an HDR colour format", "BC6H compression", format="BC6H"),
    refusal("KTX2", "ETC2 and EAC", "formats for mobile GPUs", "ETC2 or EAC", format=["ETC2", "EAC"]),
    refusal("KTX2", "ASTC of high dynamic range", "an HDR colour format", "ASTC compression", format="ASTC HDR"),
    refusal("KTX2", "PVRTC", "a format for mobile GPUs", "PVRTC compression", format="PVRTC"),
    refusal("KTX2", "cube maps", NOT_2D, "a cube map", shape="cube"),
    refusal("KTX2", "3-D textures", NOT_2D, "a 3-D texture", shape="3-D"),
    refusal("DDS", "cube maps", NOT_2D, "a cube map", shape=["cube", "DX10 cube"]),
    refusal("DDS", "3-D textures", NOT_2D, "a 3-D texture", shape=["3-D", "DX10 3-D"]),
    refusal("DDS", "integers that are not normalised", INTEGERS, "an integer format", format=["R32_UINT", "R16G16_UINT", "R8_SINT"]),
    refusal(
        "DDS",
        "shared exponents and floats of 10 and 11 bits",
        "HDR colour formats without a sign",
        "shared-exponent or 10/11-bit float",
        format=["R9G9B9E5", "R11G11B10_FLOAT"],
    ),
    refusal("DDS", "depth and stencil", "not a picture", "depth or stencil format", format="D32_FLOAT"),
    refusal("DDS", "BC6H", "an HDR colour format", "BC6H compression", format="BC6H_UF16"),
    refusal("DDS", "YUV", "a video format", "YUV|'UYVY'", format=["YUV", "UYVY", "NV12"]),
    refusal("DDS", "palettes", RARE, "a palette", format="palette"),
    refusal("DDS", "unknown FourCCs", "unknown meaning", "FourCC 'ABCD'", format="unknown FourCC"),
    refusal("DDS", "masks whose bits are not contiguous", "no known format uses them", "are not a pixel format", format="scattered mask"),
    refusal("DDS", "premultiplied alpha (DXT2, DXT4)", "the colours are no longer those of the map", "premultiplied alpha", format=["DXT2", "DXT4"]),
]
