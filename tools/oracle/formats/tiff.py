"""TIFF: compressions, predictors, planes, strips and tiles, sample types and byte orders by a writer of its own, read by
tifffile, too; CCITT and JPEG by libtiff in Pillow."""

import io
import warnings

import numpy as np
import tifffile
from PIL import Image

from case import Family, GeneratorFault, Reference, noise, smooth
from formats import tiff_writer as tiff

COMPRESSIONS = {
    "none": tiff.NONE,
    "LZW": tiff.LZW,
    "deflate": tiff.ADOBE_DEFLATE,
    "old deflate": tiff.DEFLATE,
    "PackBits": tiff.PACKBITS,
    "ZSTD": tiff.ZSTD,
    "WebP": tiff.WEBP,
    "LERC": tiff.LERC,
    "LZMA": tiff.LZMA,
    "JPEG 2000": tiff.JPEG2000,
}
# Name: sample format, bits.
TYPES = {
    "1": (tiff.UINT, 1), "2": (tiff.UINT, 2), "4": (tiff.UINT, 4), "6": (tiff.UINT, 6), "8": (tiff.UINT, 8),
    "10": (tiff.UINT, 10), "12": (tiff.UINT, 12), "14": (tiff.UINT, 14), "16": (tiff.UINT, 16), "24": (tiff.UINT, 24),
    "32": (tiff.UINT, 32), "64": (tiff.UINT, 64), "signed 8": (tiff.INT, 8), "signed 16": (tiff.INT, 16),
    "signed 32": (tiff.INT, 32), "signed 64": (tiff.INT, 64), "half": (tiff.FLOAT, 16), "float 24": (tiff.FLOAT, 24),
    "float": (tiff.FLOAT, 32), "double": (tiff.FLOAT, 64),
}  # fmt: skip
# Name: photometric interpretation, samples, ExtraSamples (0 unspecified, 1 associated alpha, 2 unassociated alpha).
LAYOUTS = {
    "grey": (1, 1, None),
    "grey, 0 is white": (0, 1, None),
    "grey and alpha": (1, 2, [2]),
    "grey and associated alpha": (1, 2, [1]),
    "grey and a sample": (1, 2, [0]),
    "two samples": (1, 2, None),
    "three samples": (1, 3, None),
    "RGB": (2, 3, None),
    "RGBA": (2, 4, [2]),
    "RGB and associated alpha": (2, 4, [1]),
    "RGB and a sample": (2, 4, [0]),
    "RGBA and a sample": (2, 5, [2, 0]),
    "palette": (3, 1, None),
    "CMYK": (5, 4, None),
    "L*a*b*": (8, 3, None),
}
# Samples whose meaning the file does not state: a reader may leave them out, with a warning.
OPTIONAL = {"RGBA and a sample": 1, "RGB and a sample": 1, "grey and a sample": 0}


def numbers(rng, shape, sample_format, bits):
    """Random samples of a type, in an array whose type has room for them."""
    if sample_format == tiff.UINT:
        room = next(size for size in (8, 16, 32, 64) if size >= bits)
        # numpy draws at most 63 bits at once.
        return (noise(rng, shape, (1 << min(bits, 62)) - 1) << max(0, bits - 62)).astype(f"u{room // 8}")
    if sample_format == tiff.INT:
        low, high = -(1 << bits - 1), (1 << bits - 1) - 1
        return rng.integers(low, high, shape, f"i{bits // 8}", endpoint=True)
    values = rng.normal(0, 1, shape) * 2.0 ** rng.integers(-10, 12, shape)
    if bits == 24:
        return values.astype(np.float32).view(np.uint32) >> 8
    return values.astype(f"f{bits // 8}")


def float24(words):
    """1 sign bit, 7 bits of exponent over 63, 16 bits of mantissa."""
    words = words.astype(np.int64)
    sign, exponent, mantissa = words >> 23, (words >> 16) & 127, words & 0xFFFF
    normal = np.ldexp(1 + mantissa / 65536, exponent - 63)
    value = np.where(exponent == 0, np.ldexp(mantissa / 65536, -62), normal)
    value = np.where(exponent == 127, np.where(mantissa == 0, np.inf, np.nan), value)
    return np.where(sign == 1, -value, value)


def meaning(pixels, sample_format, bits, layout, palette):
    """The values, and the steps from 0 to 1 that a reader must keep."""
    if layout == "palette":
        return palette[pixels[:, :, 0]] / 65535, 65535
    colours = 3 if LAYOUTS[layout][0] == 2 or layout == "three samples" else 2 if "sample" in layout else 1
    if sample_format == tiff.UINT:
        values = pixels / ((1 << bits) - 1)
        if LAYOUTS[layout][0] == 0 and bits <= 16:
            # For more bits our reader warns that it ignores this, as OpenImageIO does.
            values = 1 - values
        return values, 255 if bits <= 8 else 65535 if bits <= 16 else 1 << 23
    if sample_format == tiff.INT:
        # One channel is heights in a unit; several are vectors of -1 ..= 1.
        return (pixels, None) if colours == 1 else (np.maximum(pixels / ((1 << bits - 1) - 1), -1), None)
    return (float24(pixels) if bits == 24 else pixels), None


def range_of(values, sample_format, full):
    """Unsigned integers are normalised; signed ones of several channels are, too."""
    if full is not None:
        return "Unorm"
    return "Snorm" if sample_format == tiff.INT and np.abs(values).max() <= 1 else "Float"


def make(rng, compression, type, layout, predictor, planar, block, order, big, size, filling, extra):
    photometric, samples, extra_samples = LAYOUTS[layout]
    sample_format, bits = TYPES[type]
    height, width = size
    code = COMPRESSIONS[compression]
    is_float = sample_format == tiff.FLOAT
    if predictor == "horizontal" and (bits not in (8, 16, 32, 64) or is_float and bits == 24):
        return None
    if predictor == "floating point" and not is_float:
        return None
    if predictor != "none" and compression not in ("LZW", "deflate", "old deflate", "ZSTD", "LZMA"):
        return None
    if compression == "WebP" and (type != "8" or samples not in (3, 4) or planar):
        return None
    if compression == "LERC" and (bits not in (8, 16, 32, 64) or type in ("64", "signed 64", "half")):
        return None
    if compression == "JPEG 2000" and type not in ("8", "16"):
        return None
    if planar and samples == 1 or filling == "reversed bits" and (bits > 8 or compression not in ("none", "PackBits")):
        return None
    if layout in ("palette", "CMYK", "L*a*b*") and (is_float or sample_format == tiff.INT or bits > 8 or predictor != "none"):
        return None
    if layout == "grey, 0 is white" and is_float:
        return None  # No reader agrees with another on what that would be.
    pixels = numbers(rng, (height, width, samples), sample_format, bits)
    tags, palette = [], None
    if layout == "palette":
        palette = noise(rng, (1 << bits, 3), 65535)
        tags = [(320, tiff.SHORT, [int(entry) for entry in palette.T.reshape(-1)])]
    tags += {
        "none": [],
        "orientation": [(274, tiff.SHORT, [3])],
        "resolution and text": [(296, tiff.SHORT, [2]), (305, 2, list(b"a program\0"))],
    }[extra]
    blocks = {
        "one strip": {}, "strips of 5": {"rows_per_strip": 5}, "strips of 1": {"rows_per_strip": 1},
        "tiles of 16": {"tile": (16, 16)}, "tiles of 48x32": {"tile": (48, 32)},
    }  # fmt: skip
    file = tiff.write(
        pixels, bits=bits, photometric=photometric, order={"little": "<", "big": ">"}[order], big=big, compression=code,
        predictor={"none": 1, "horizontal": 2, "floating point": 3}[predictor], planar=planar, **blocks[block],
        sample_format=None if sample_format == tiff.UINT and filling == "no sample format" else sample_format,
        extra_samples=extra_samples, reversed_bits=filling == "reversed bits", tags=tags,
    )  # fmt: skip
    check_with_tifffile(file, pixels, bits, compression, layout)
    values, full = meaning(pixels, sample_format, bits, layout, palette)
    reference = Reference(values, full=full, float_ulps=1, range=range_of(values, sample_format, full), optional=OPTIONAL.get(layout, 0))
    return "tif", file, reference


def check_with_tifffile(file, pixels, bits, compression, layout):
    """tifffile must read the same samples wherever it reads them."""
    if bits == 24 and file.startswith(b"MM"):
        return  # tifffile reads such integers and floats in an order of its own.
    if compression == "LERC" and file.startswith(b"MM"):
        return  # tifffile swaps the bytes that the decoder has put into the machine's order.
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            page = tifffile.TiffFile(io.BytesIO(file)).pages[0]
            decoded = page.asarray()
    except (ValueError, NotImplementedError, tifffile.TiffFileError, RuntimeError) as error:
        if bits in (8, 16, 32):
            raise GeneratorFault(f"tifffile does not read {compression}, {bits} bits, {layout}: {error}") from error
        return
    if page.planarconfig == 2 and decoded.ndim == 3:
        decoded = np.moveaxis(decoded, 0, -1)
    decoded = decoded.reshape(pixels.shape)
    expected = float24(pixels) if bits == 24 and decoded.dtype.kind == "f" else pixels
    with np.errstate(invalid="ignore"):
        same = np.array_equal(decoded.astype(float), expected.astype(float), equal_nan=True)
    if not same:
        raise GeneratorFault(f"tifffile reads other samples: {compression}, {bits} bits, {layout}")


def by_libtiff(rng, compression, size, content):
    """Files encoded by libtiff: fax codes of one bit, and JPEG."""
    height, width = size
    if compression.startswith("CCITT"):
        grey = smooth(rng, height, width, 1)[:, :, 0]
        bits = grey > 128 if content == "smooth" else rng.random((height, width)) > 0.5
        image, values = Image.fromarray(bits), bits.astype(float)
        codec = {"CCITT modified Huffman": "tiff_ccitt", "CCITT group 3": "group3", "CCITT group 4": "group4"}[compression]
    else:
        picture = smooth(rng, height, width, 3)
        image = Image.fromarray(picture if content == "smooth" else picture[:, :, 0])
        codec = "jpeg"
    out = io.BytesIO()
    try:
        image.save(out, "TIFF", compression=codec)
    except (OSError, ValueError):
        return None
    if codec == "jpeg":
        values = np.asarray(Image.open(out).convert(image.mode)) / 255
    reference = Reference(values, full=255, tolerance=4 / 255 if codec == "jpeg" else 0.0)
    return "tif", out.getvalue(), reference


def families():
    axes = {
        "compression": list(COMPRESSIONS),
        "type": list(TYPES),
        "layout": list(LAYOUTS),
        "predictor": ["none", "horizontal", "floating point"],
        "planar": [False, True],
        "block": ["one strip", "strips of 5", "strips of 1", "tiles of 16", "tiles of 48x32"],
        "order": ["little", "big"],
        "big": [False, True],
        "size": [(1, 1), (7, 5), (16, 32), (33, 17), (20, 70)],
        "filling": ["usual", "no sample format", "reversed bits"],
        "extra": ["none", "orientation", "resolution and text"],
    }
    fax = {
        "compression": ["CCITT modified Huffman", "CCITT group 3", "CCITT group 4", "JPEG"],
        "size": [(1, 1), (9, 13), (33, 70), (40, 300)],
        "content": ["smooth", "noise"],
    }
    return [Family("TIFF", axes, make), Family("TIFF", fax, by_libtiff, name="libtiff")]
