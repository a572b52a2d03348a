"""BMP: headers, depths, palettes, runs, masks and row order, by a writer of its own; Pillow reads most of it, too."""

import io
import struct

import numpy as np
from PIL import Image

from case import Family, GeneratorFault, Reference, noise

# Kind of pixel: bits, masks of red, green, blue and alpha (None: palette or the default of the depth).
KINDS = {
    "1-bit palette": (1, None),
    "2-bit palette": (2, None),
    "4-bit palette": (4, None),
    "8-bit palette": (8, None),
    "RLE8": (8, None),
    "RLE4": (4, None),
    "RLE8 with jumps": (8, None),
    "RLE4 with jumps": (4, None),
    "16-bit": (16, None),
    "24-bit": (24, None),
    "32-bit": (32, None),
    "565": (16, (0xF800, 0x7E0, 0x1F, 0)),
    "555": (16, (0x7C00, 0x3E0, 0x1F, 0)),
    "444": (16, (0xF00, 0xF0, 0xF, 0)),
    "4444": (16, (0xF00, 0xF0, 0xF, 0xF000)),
    "1555": (16, (0x7C00, 0x3E0, 0x1F, 0x8000)),
    "888": (32, (0xFF0000, 0xFF00, 0xFF, 0)),
    "888, red first": (32, (0xFF, 0xFF00, 0xFF0000, 0)),
    "8888": (32, (0xFF0000, 0xFF00, 0xFF, 0xFF000000)),
    "8888, alpha first": (32, (0xFF000000, 0xFF0000, 0xFF00, 0xFF)),
    "10-bit": (32, (0x3FF00000, 0xFFC00, 0x3FF, 0)),
}
DEFAULT_MASKS = {16: (0x7C00, 0x3E0, 0x1F, 0), 32: (0xFF0000, 0xFF00, 0xFF, 0)}
HEADERS = {"core": 12, "info": 40, "info with masks": 52, "info with alpha": 56, "V4": 108, "V5": 124, "OS/2 2.0": 64, "OS/2 2.0, short": 16}


def field(words, mask):
    shift = (mask & -mask).bit_length() - 1
    return (words & mask) >> shift, mask >> shift


def packed_rows(rows, bits):
    """Rows padded to four bytes."""
    out = bytearray()
    for row in rows:
        if bits < 8:
            spread = ((row[:, None] >> np.arange(bits - 1, -1, -1)) & 1).astype(np.uint8)
            data = np.packbits(spread.reshape(-1)).tobytes()
        elif bits == 24:
            data = row.astype(np.uint8).tobytes()
        else:
            data = row.astype(f"<u{bits // 8}").tobytes()
        out += data + bytes(-len(data) % 4)
    return bytes(out)


def run_length(rng, rows, bits, jumps):
    """RLE8 or RLE4 of palette indices: runs, literals, and the marks of row and picture ends. With jumps it leaves out
    places whose index is 0, which nothing else is then written to."""
    out = bytearray()
    for row in rows:
        i = 0
        while i < len(row):
            zeros = len(row) - i - len(np.trim_zeros(row[i:], "f"))
            if jumps and zeros and i + zeros < len(row):
                out += bytes([0, 2, zeros, 0])
                i += zeros
                continue
            if jumps and zeros:
                break  # The end of the row may come early.
            # RLE4 repeats two indices in turn.
            pattern = row[i : i + (2 if bits == 4 else 1)]
            same = 1
            while i + same < len(row) and same < 255 and row[i + same] == pattern[same % len(pattern)]:
                same += 1
            count = min(len(row) - i, int(rng.integers(3, 40)))
            if same >= 3 or count < 3:
                value = int(pattern[0]) if bits == 8 else int(pattern[0]) << 4 | int(pattern[-1])
                out += bytes([same, value])
                i += same
            else:
                literal = row[i : i + count]
                if bits == 4:
                    literal = np.pad(literal, (0, count % 2))
                    literal = literal[::2] << 4 | literal[1::2]
                data = literal.astype(np.uint8).tobytes()
                out += bytes([0, count]) + data + bytes(len(data) % 2)
                i += count
        out += bytes([0, 0])
    out[-1] = 1  # The last end of a row is the end of the picture.
    return bytes(out)


def make(rng, kind, size, header, top_down, palette_entries, gap):
    bits, masks = KINDS[kind]
    height, width = size
    header_bytes = HEADERS[header]
    runs = kind.startswith("RLE")
    if header.startswith("OS/2") and (masks or top_down or bits in (2, 16, 32) or header_bytes == 16 and runs):
        return None
    if header == "core" and (masks or runs or top_down or bits in (2, 16, 32)):
        return None
    if runs and top_down or (masks and masks[3] and header in ("info", "info with masks")):
        return None
    if (palette_entries != "all") and bits > 8:
        return None
    palette = b""
    if bits <= 8:
        entries = (1 << bits) if palette_entries == "all" or header == "core" else max(2, (1 << bits) - 3)
        colours = noise(rng, (entries, 3), 255)
        indices = noise(rng, (height, width), entries - 1)
        if runs:
            indices = np.repeat(indices, 6, axis=1)[:, 3 : 3 + width]
            if "jumps" in kind:
                indices[:, 4:9] = 0
                indices[:, 12:] = 0
            indices[::2] = np.where(np.arange(width) % 14 < 7, indices[::2, :1], indices[::2])
        values = colours[indices] / 255
        order = colours[:, ::-1].astype(np.uint8)
        padding = np.zeros((entries, 0 if header == "core" else 1), np.uint8)
        palette = np.concatenate([order, padding], axis=1).tobytes()
        rows = indices
    elif bits == 24:
        rows = noise(rng, (height, width, 3), 255)
        values = rows[:, :, ::-1] / 255
    else:
        rows = rng.integers(0, 1 << bits, (height, width), dtype=np.int64)
        fields = [field(rows, mask) for mask in masks or DEFAULT_MASKS[bits] if mask]
        values = np.stack([value / top for value, top in fields], axis=-1)
    stored = rows if top_down else rows[::-1]
    body = run_length(rng, stored, bits, "jumps" in kind) if runs else packed_rows(stored, bits)
    compression = {"RLE8": 1, "RLE4": 2}.get(kind[:4], 3 if masks else 0)
    extra = struct.pack("<3I", *masks[:3]) if masks and header == "info" else b""
    offset = 14 + header_bytes + len(extra) + len(palette) + gap
    if header == "core":
        info = struct.pack("<IHHHH", 12, width, height, 1, bits)
    else:
        used = len(palette) // 4 if palette_entries != "all" else 0
        stated = -height if top_down else height
        info = struct.pack("<IiiHHIIiiII", header_bytes, width, stated, 1, bits, compression, len(body), 2835, 2835, used, 0)
        info += struct.pack("<4I", *(masks or (0, 0, 0, 0)))[: max(0, header_bytes - 40)]
        info += (b"BGRs" if header_bytes > 56 else b"") + bytes(200)
        info = info[:header_bytes]
    file = b"BM" + struct.pack("<IHHI", offset + len(body), 0, 0, offset) + info + extra + palette + bytes(gap) + body
    check_with_pillow(file, kind, values)
    return "bmp", file, Reference(values, full=255)


PILLOW = {"1-bit palette", "4-bit palette", "8-bit palette", "RLE8", "RLE4", "24-bit", "32-bit", "888", "8888"}


def check_with_pillow(file, kind, values):
    """Pillow must agree where it reads the kind and applies the same palette."""
    if kind not in PILLOW:
        return
    try:
        image = Image.open(io.BytesIO(file))
        decoded = np.asarray(image.convert("RGBA" if values.shape[2] == 4 else "RGB"))
    except (OSError, ValueError):
        return
    if not np.array_equal(decoded, np.rint(values * 255)):
        raise GeneratorFault(f"Pillow reads other pixels from a BMP of {kind}")


def families():
    axes = {
        "kind": list(KINDS),
        "header": list(HEADERS),
        "size": [(1, 1), (3, 2), (5, 33), (16, 16), (9, 61)],
        "top_down": [False, True],
        "palette_entries": ["all", "fewer"],
        "gap": [0, 6],
    }
    return [Family("BMP", axes, make)]
