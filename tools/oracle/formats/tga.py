"""TGA after Truevision's specification 2.0: types, depths, palettes, runs, origins, by a writer of its own; Pillow reads
most of it, too."""

import io
import struct

import numpy as np
from PIL import Image

from case import Family, GeneratorFault, Reference, noise

FOOTER = struct.pack("<II", 0, 0) + b"TRUEVISION-XFILE.\0"
# Kind of pixel: image type without runs, bits of a pixel or palette entry, attribute bits.
KINDS = {
    "grey": (3, 8, 0),
    "grey and alpha": (3, 16, 8),
    "grey 16-bit": (3, 16, 0),
    "15-bit": (2, 15, 0),
    "16-bit": (2, 16, 0),
    "16-bit, attribute": (2, 16, 1),
    "RGB": (2, 24, 0),
    "RGBA": (2, 32, 8),
    "32-bit, no attribute bits": (2, 32, 0),
    "palette of 15 bits": (1, 15, 0),
    "palette of 16 bits": (1, 16, 0),
    "palette of 16 bits, attribute": (1, 16, 1),
    "palette of 24 bits": (1, 24, 0),
    "palette of 32 bits": (1, 32, 8),
}


def pixel_bytes(rng, kind, count):
    """Random pixels of a kind: their bytes and their values 0 ..= 1."""
    image_type, bits, _ = KINDS[kind]
    if image_type == 3:
        samples = noise(rng, (count, bits // 8), 255).astype(np.uint8)
        return samples, samples / 255
    if bits <= 16:
        fives = noise(rng, (count, 3), 31)
        words = fives[:, 0] << 10 | fives[:, 1] << 5 | fives[:, 2]
        if bits == 16:
            words |= rng.integers(0, 2, count) << 15
        return words.astype("<u2").view(np.uint8).reshape(count, 2), fives / 31
    samples = noise(rng, (count, bits // 8), 255).astype(np.uint8)
    order = [2, 1, 0, 3][: bits // 8]
    return samples, samples[:, order] / 255


def runs(rng, units):
    """Packets of whole pixels over all rows: runs where pixels repeat, literals between."""
    out, i = bytearray(), 0
    while i < len(units):
        length = int(rng.integers(1, 129))
        same = 1
        while i + same < len(units) and same < length and np.array_equal(units[i + same], units[i]):
            same += 1
        if same > 1 or rng.random() < 0.2:
            out += bytes([0x80 | same - 1]) + units[i].tobytes()
            i += same
        else:
            length = min(length, len(units) - i)
            out += bytes([length - 1]) + units[i : i + length].tobytes()
            i += length
    return bytes(out)


def make(rng, kind, size, compressed, origin, id_field, footer, index_bits, map_start, interleaving, unused_palette):
    image_type, bits, attributes = KINDS[kind]
    height, width = size
    mapped = image_type == 1
    if mapped and unused_palette:
        return None
    if not mapped and (index_bits, map_start) != (8, 0):
        return None
    count = height * width
    if mapped:
        entries = 40
        palette, colours = pixel_bytes(rng, kind, entries)
        chosen = rng.integers(0, entries, count)
        units = (chosen + map_start).astype("u1" if index_bits == 8 else "<u2")
        units = units.view(np.uint8).reshape(count, index_bits // 8)
        values = colours[chosen]
    else:
        units, values = pixel_bytes(rng, kind, count)
    if compressed:
        # Noise has no runs: every other stretch repeats one pixel.
        held = np.repeat(np.arange(0, count, 5), 5)[:count]
        held = np.where((np.arange(count) // 10) % 2 == 0, held, np.arange(count))
        units, values = units[held], values[held]
    descriptor = attributes | interleaving << 6 | {"bottom left": 0, "bottom right": 16, "top left": 32, "top right": 48}[origin]
    header = struct.pack(
        "<BBBHHBHHHHBB",
        len(id_field), int(mapped or unused_palette), image_type + 8 * compressed, map_start if mapped else 0,
        40 if mapped else 7 * unused_palette, bits if mapped else 24 * unused_palette, 0, 0, width, height, index_bits if mapped else bits, descriptor,
    )  # fmt: skip
    body = runs(rng, units) if compressed else units.tobytes()
    table = palette.tobytes() if mapped else bytes(7 * 3 * unused_palette)
    file = header + id_field + table + body
    values = values.reshape(height, width, -1)
    values = values[::-1] if origin.startswith("bottom") else values
    values = values[:, ::-1] if origin.endswith("right") else values
    check_with_pillow(file, kind, values, origin)
    return "tga", file + (FOOTER if footer else b""), Reference(values)


# What Pillow reads as this program does: it treats the fifth bit as alpha, and does not support pixels from the right.
PILLOW = {"grey", "grey and alpha", "RGB", "RGBA", "palette of 24 bits"}


def check_with_pillow(file, kind, values, origin):
    if kind not in PILLOW or file[17] >> 6 or origin.endswith("right"):
        return
    image = Image.open(io.BytesIO(file))
    try:
        image.load()
    except (OSError, ValueError):
        # Pillow's runs end with the row, and it fails on unused palettes.
        return
    image = image.convert("RGB") if image.mode == "P" else image
    decoded = np.asarray(image).reshape(values.shape)
    if not np.array_equal(decoded, np.rint(values * 255)):
        raise GeneratorFault(f"Pillow reads other pixels from a TGA of {kind}")


def families():
    axes = {
        "kind": list(KINDS),
        "compressed": [False, True],
        "origin": ["bottom left", "bottom right", "top left", "top right"],
        "size": [(1, 1), (3, 2), (7, 33), (16, 16), (2, 300)],
        "id_field": [b"", b"a name of 17 byte"],
        "footer": [False, True],
        "index_bits": [8, 16],
        "map_start": [0, 3],
        "interleaving": [0],
        "unused_palette": [False, True],
    }
    first = {name: values[:1] for name, values in axes.items()}
    interleaved = {**first, "kind": list(KINDS), "size": [(3, 2)], "interleaving": [1, 2]}
    return [Family("TGA", axes, make), Family("TGA", interleaved, make, name="interleaved")]
