"""TIFF of other writers, and further contents of TIFF: texels without data, several images, more samples."""

import io
import tempfile
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import tifffile

from case import Family, Reference, noise
from formats import tiff_writer as tiff

DTYPES = {"uint8": np.uint8, "uint16": np.uint16, "half": np.float16, "float": np.float32, "double": np.float64}
OIIO_TYPES = {"uint8": oiio.UINT8, "uint16": oiio.UINT16, "half": oiio.HALF, "float": oiio.FLOAT, "double": oiio.DOUBLE}


def pixels_of(rng, shape, dtype):
    kind = np.dtype(DTYPES[dtype])
    if kind.kind == "f":
        return rng.normal(0, 10, shape).astype(kind)
    return noise(rng, shape, np.iinfo(kind).max).astype(kind)


def reference_of(pixels, **more):
    if pixels.dtype.kind == "f":
        return Reference(pixels, full=None, range="Float", **more)
    full = int(np.iinfo(pixels.dtype).max)
    return Reference(pixels / full, full=full, **more)


def by_tifffile(pixels, compression, tiles, predictor):
    out = io.BytesIO()
    tifffile.imwrite(
        # A third axis of one would be read as pages.
        out, pixels[:, :, 0] if pixels.shape[2] == 1 else pixels, photometric="rgb" if pixels.shape[2] == 3 else "minisblack", compression=compression,
        predictor=predictor and compression in ("lzw", "zlib", "zstd"), tile=(16, 32) if tiles else None, metadata=None,
    )  # fmt: skip
    return out.getvalue()


def by_openimageio(pixels, dtype, compression, tiles, predictor):
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, OIIO_TYPES[dtype])
    spec.attribute("compression", {"zlib": "zip", None: "none"}.get(compression, compression))
    if predictor:
        spec.attribute("tiff:predictor", 3 if pixels.dtype.kind == "f" else 2)
    if tiles:
        spec.tile_width, spec.tile_height = 32, 16
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.tif"
        out = oiio.ImageOutput.create(str(path))
        if not (out.open(str(path), spec) and out.write_image(pixels) and out.close()):
            return None
        return path.read_bytes()


def of_writer(rng, writer, dtype, compression, tiles, predictor, channels, size):
    pixels = pixels_of(rng, (*size, channels), dtype)
    if writer == "tifffile":
        file = by_tifffile(pixels, compression, tiles, predictor)
    elif dtype == "half":
        return None  # OpenImageIO writes floats instead, unless it is asked twice.
    else:
        file = by_openimageio(pixels, dtype, compression, tiles, predictor)
    if file is None:
        return None
    again = tifffile.imread(io.BytesIO(file)).reshape(pixels.shape)
    if again.dtype != pixels.dtype:
        return None  # The writer has chosen another type.
    return "tif", file, reference_of(again, float_ulps=1)


def without_data(rng, dtype, block, size, extra):
    """GDAL's tag: texels of this value are NaN."""
    pixels = pixels_of(rng, (*size, 1), dtype)
    nothing = pixels[size[0] // 2, size[1] // 2, 0]
    pixels[rng.random(pixels.shape) < 0.2] = nothing
    is_float = pixels.dtype.kind == "f"
    blocks = {"strips": {"rows_per_strip": 3}, "tiles": {"tile": (16, 16)}}[block]
    # The text has all digits, or is rounded as %g does it for floats.
    text = repr(float(nothing)) if is_float else str(int(nothing))
    if extra == "padded":
        text = f" {text} "
    file = tiff.write(
        pixels, bits=8 * pixels.dtype.itemsize, photometric=1, compression=tiff.ADOBE_DEFLATE,
        sample_format=tiff.FLOAT if is_float else tiff.UINT, tags=[(42113, 2, list(text.encode() + b"\0"))], **blocks,
    )  # fmt: skip
    values = pixels.astype(float) if is_float else pixels / np.iinfo(pixels.dtype).max
    # Rounded to single floats, neighbours of the value may become it; what is compared are the others.
    values = np.where(pixels == nothing, np.nan, values)
    reference = Reference(values, full=None if is_float else 1 << 23, range="Float" if is_float else "Unorm")
    return "tif", file, reference


def of_several(rng, layer, size):
    """Two images in a file; the first is read unless a number chooses."""
    pictures = [pixels_of(rng, (*size, 3), "uint8"), pixels_of(rng, (size[0] + 1, size[1], 3), "uint8")]
    out = io.BytesIO()
    with tifffile.TiffWriter(out) as writer:
        for picture in pictures:
            writer.write(picture, photometric="rgb", metadata=None)
    chosen = pictures[1 if layer == "2" else 0]
    return "tif", out.getvalue(), reference_of(chosen), {"layer": layer}


CHOICES = {
    "six samples": (1, 6, ("R", "channel4"), [0, 4]),
    "RGB, turned": (2, 3, ("B", "R"), [2, 0]),
    "alpha alone": (2, 4, ("A",), [3]),
}


def of_choice(rng, choice, planar, size):
    """Channels by name."""
    photometric, samples, names, places = CHOICES[choice]
    pixels = pixels_of(rng, (*size, samples), "uint8")
    extra = [2] if samples == 4 else [0] * (samples - 1) if photometric == 1 else None
    file = tiff.write(pixels, bits=8, photometric=photometric, planar=planar, compression=tiff.LZW, extra_samples=extra)
    return "tif", file, reference_of(pixels[:, :, places]), {"channels": names}


def refused(rng, odd):
    """Files that are not maps."""
    photometric, samples, bits, sample_format = {
        "complex": (1, 1, 64, 6), "complex integers": (1, 1, 32, 5), "YCbCr": (6, 3, 8, 1), "filter array": (32803, 1, 8, 1),
        "six samples": (1, 6, 8, 1),
    }[odd]  # fmt: skip
    pixels = rng.integers(0, 200, (8, 9, samples)).astype(f"u{bits // 8}")
    file = tiff.write(pixels, bits=bits, photometric=photometric, sample_format=sample_format)
    return "tif", file, Reference(np.zeros((1, 1, 1)))


def families():
    writers = {
        "writer": ["tifffile", "OpenImageIO"],
        "dtype": list(DTYPES),
        "compression": [None, "lzw", "zlib", "zstd", "packbits"],
        "tiles": [False, True],
        "predictor": [False, True],
        "channels": [1, 3],
        "size": [(5, 7), (33, 40)],
    }
    empty = {
        "dtype": ["uint8", "uint16", "float", "double"],
        "block": ["strips", "tiles"],
        "size": [(5, 7), (20, 33)],
        "extra": ["plain", "padded"],
    }
    return [
        Family("TIFF", writers, of_writer, name="writers"),
        Family("TIFF", empty, without_data, name="no data"),
        Family("TIFF", {"layer": ["", "1", "2"], "size": [(5, 7), (16, 16)]}, of_several, name="several"),
        Family("TIFF", {"choice": list(CHOICES), "planar": [False, True], "size": [(5, 7)]}, of_choice, name="choice"),
        Family("TIFF", {"odd": ["complex", "complex integers", "YCbCr", "filter array", "six samples"]}, refused, name="odd"),
    ]
