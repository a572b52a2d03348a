"""Radiance HDR: the three ways of storing rows, eight orientations, headers, by a writer of its own; OpenImageIO reads
those of the standard orientation, too."""

import tempfile

import numpy as np
import OpenImageIO as oiio

from case import Family, GeneratorFault, Reference

ORIENTATIONS = ["-Y +X", "+Y +X", "-Y -X", "+Y -X", "-X +Y", "+X +Y", "-X -Y", "+X -Y"]


def new_runs(rng, row):
    """A row channel by channel, in runs and literals."""
    out = bytearray([2, 2, len(row) >> 8, len(row) & 255])
    for channel in range(4):
        values, i = row[:, channel], 0
        while i < len(values):
            same = 1
            while i + same < len(values) and same < 127 and values[i + same] == values[i]:
                same += 1
            if same > 2:
                out += bytes([128 + same, values[i]])
                i += same
            else:
                count = min(len(values) - i, int(rng.integers(1, 129)))
                out += bytes([count]) + values[i : i + count].tobytes()
                i += count
    return bytes(out)


def old_runs(row):
    """A row of whole pixels, where (1, 1, 1, n) repeats the pixel before it; counts of 256 and more follow in steps."""
    out, i = bytearray(), 0
    while i < len(row):
        out += row[i].tobytes()
        same = 1
        while i + same < len(row) and np.array_equal(row[i + same], row[i]):
            same += 1
        repeats, i = same - 1, i + same
        while repeats:
            out += bytes([1, 1, 1, repeats & 255])
            repeats >>= 8
    return bytes(out)


def make(rng, size, storage, orientation, signature, header, content):
    height, width = size
    pixels = rng.integers(0, 256, (height, width, 4), dtype=np.uint8)
    pixels[:, :, :3][(pixels[:, :, :3] == 1).all(axis=2)] = 9  # (1, 1, 1, n) would be a run.
    pixels[0, 0, :3] = [200, 100, 50]
    if content == "usual exponents":
        pixels[:, :, 3] = rng.integers(120, 136, (height, width))
    elif content == "runs":
        held = np.arange(width) // 7 * 7
        pixels = pixels[:, held]
    elif content == "dark":
        pixels[:, :, 3] = rng.integers(0, 3, (height, width))
    scale = np.where(pixels[:, :, 3:] == 0, 0.0, np.ldexp(1.0, pixels[:, :, 3:].astype(int) - 136))
    values = pixels[:, :, :3] * scale
    # Rows of the file: along x where Y comes first, else along y.
    stored = pixels if orientation[1] == "Y" else pixels.transpose(1, 0, 2)
    first, second = orientation.split()
    # Y grows upwards, x to the right: -Y and +X are the order of our rows.
    stored = stored[::-1] if first in ("+Y", "-X") else stored
    stored = stored[:, ::-1] if second in ("+Y", "-X") else stored
    rows_are_short = not 8 <= stored.shape[1] < 0x8000
    if storage == "new runs" and rows_are_short:
        return None
    # A flat row must not begin like one with new runs.
    if storage != "new runs" and not rows_are_short and (stored[:, 0, :2] == 2).all(axis=1).any():
        return None
    encode = {"flat": lambda row: row.tobytes(), "old runs": old_runs, "new runs": lambda row: new_runs(rng, row)}[storage]
    extra = {
        "plain": "",
        "exposure": "EXPOSURE=2.0\nEXPOSURE=0.5\n",
        "comments": "# made for a test\nSOFTWARE=some words\nPRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.33 0.33\nGAMMA=1\n",
        "XYZE": "",
        "no format": "",
    }[header]
    format_line = {"XYZE": "FORMAT=32-bit_rle_xyze\n", "no format": ""}.get(header, "FORMAT=32-bit_rle_rgbe\n")
    file = f"#?{signature}\n{extra}{format_line}\n{first} {stored.shape[0]} {second} {stored.shape[1]}\n".encode()
    file += b"".join(encode(np.ascontiguousarray(row)) for row in stored)
    if header in ("plain", "comments") and orientation == "-Y +X" and content == "usual exponents":
        check_with_openimageio(file, values)
    return "hdr", file, Reference(values, full=None, range="Float")


def check_with_openimageio(file, values):
    with tempfile.NamedTemporaryFile(suffix=".hdr") as out:
        out.write(file)
        out.flush()
        image = oiio.ImageBuf(out.name)
        decoded = image.get_pixels(oiio.FLOAT)
    if image.has_error or not np.array_equal(decoded, values.astype(np.float32)):
        raise GeneratorFault(f"OpenImageIO reads other pixels from an HDR: {image.geterror()}")


def families():
    axes = {
        "storage": ["flat", "old runs", "new runs"],
        "orientation": ORIENTATIONS,
        "size": [(1, 1), (2, 8), (9, 7), (33, 17), (2, 700)],
        "signature": ["RADIANCE", "RGBE"],
        "header": ["plain", "exposure", "comments", "XYZE", "no format"],
        "content": ["any exponents", "usual exponents", "runs", "dark"],
    }
    return [Family("HDR", axes, make)]
