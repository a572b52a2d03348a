"""PNG: every colour type, depth, filter and chunk that matters, by a writer of its own; libpng reads it, too."""

import struct
import zlib

import imagecodecs
import numpy as np

from case import Family, GeneratorFault, Reference, noise
from quiet import quiet

GREY, RGB, PALETTE, GREY_ALPHA, RGBA = 0, 2, 3, 4, 6
DEPTHS = {GREY: (1, 2, 4, 8, 16), RGB: (8, 16), PALETTE: (1, 2, 4, 8), GREY_ALPHA: (8, 16), RGBA: (8, 16)}
CHANNELS = {GREY: 1, RGB: 3, PALETTE: 1, GREY_ALPHA: 2, RGBA: 4}
COLOURS = {"grey": GREY, "RGB": RGB, "palette": PALETTE, "grey and alpha": GREY_ALPHA, "RGBA": RGBA}
NAMES = {1: ("Y",), 2: ("Y", "A"), 3: ("R", "G", "B"), 4: ("R", "G", "B", "A")}
# Column and row of the first pixel of each pass of Adam7, and the steps between them.
ADAM7 = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def packed_row(row, depth):
    """One row of samples as bytes: 16 bits big-endian, fewer than 8 from the highest bit down."""
    row = row.reshape(-1)
    if depth == 16:
        return row.astype(">u2").tobytes()
    if depth == 8:
        return row.astype(np.uint8).tobytes()
    bits = ((row[:, None] >> np.arange(depth - 1, -1, -1)) & 1).astype(np.uint8)
    return np.packbits(bits.reshape(-1)).tobytes()


def paeth(a, b, c):
    p = a + b - c
    distances = abs(p - a), abs(p - b), abs(p - c)
    return (a, b, c)[distances.index(min(distances))]


def filtered(rows, unit, kind):
    """Rows with their filter bytes; kind 5 takes each filter in turn."""
    out, previous = bytearray(), bytes(len(rows[0])) if rows else b""
    for y, row in enumerate(rows):
        method = y % 5 if kind == 5 else kind
        out.append(method)
        for i, value in enumerate(row):
            left, up = row[i - unit] if i >= unit else 0, previous[i]
            corner = previous[i - unit] if i >= unit else 0
            guess = (0, left, up, (left + up) // 2, paeth(left, up, corner))[method]
            out.append((value - guess) & 255)
        previous = row
    return bytes(out)


def image_data(pixels, depth, interlaced, kind):
    """The uncompressed content of the IDAT chunks."""
    unit = max(1, pixels.shape[2] * depth // 8)
    passes = [pixels[y::dy, x::dx] for x, y, dx, dy in ADAM7] if interlaced else [pixels]
    return b"".join(
        filtered([packed_row(row, depth) for row in part], unit, kind) for part in passes if part.size
    )


def profile_chunk():
    """An iCCP chunk with a profile that no reader of data must apply: the shortest legal header."""
    profile = bytearray(132)
    profile[:4] = struct.pack(">I", 132)
    profile[12:24] = b"mntrRGB XYZ "
    profile[36:40] = b"acsp"
    return chunk(b"iCCP", b"profile\0\0" + zlib.compress(bytes(profile)))


EXIF_ROTATED = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0"
BEFORE_PALETTE = {
    "none": b"",
    "gAMA 1.0": chunk(b"gAMA", struct.pack(">I", 100_000)),
    "gAMA 0.45": chunk(b"gAMA", struct.pack(">I", 45_455)) + chunk(b"cHRM", struct.pack(">8I", *[31270] * 8)),
    "sRGB": chunk(b"sRGB", b"\0"),
    "iCCP": profile_chunk(),
    "cICP": chunk(b"cICP", bytes([9, 16, 0, 1])),
}
BEFORE_DATA = {
    "none": b"",
    "text": chunk(b"tEXt", b"Title\0one") + chunk(b"zTXt", b"Comment\0\0" + zlib.compress(b"two" * 50)),
    "iTXt": chunk(b"iTXt", b"Author\0\x01\0de\0Autor\0" + zlib.compress("drei ü".encode())),
    "pHYs and tIME": chunk(b"pHYs", struct.pack(">IIB", 2835, 1417, 1)) + chunk(b"tIME", bytes([7, 0xE4, 1, 1, 0, 0, 0])),
    "eXIf, rotated": chunk(b"eXIf", EXIF_ROTATED),
    "suggested palette": chunk(b"PLTE", bytes(range(30))) + chunk(b"hIST", bytes(20)),
    "unknown chunk": chunk(b"roUg", b"any bytes"),
}


def data_chunks(data, split):
    """IDAT chunks: one, many short ones, or with empty ones between."""
    if split == "one":
        return chunk(b"IDAT", data)
    step = 7 if split == "many" else max(1, len(data) // 2)
    empty = chunk(b"IDAT", b"") if split == "empty" else b""
    return b"".join(empty + chunk(b"IDAT", data[i : i + step]) for i in range(0, len(data), step)) + empty


def make(rng, size, colour, depth, interlaced, filters, transparency, colours, extra, split, deflate, significant):
    kind, (height, width) = COLOURS[colour], size
    if extra == "suggested palette" and (kind not in (RGB, RGBA) or transparency):
        return None
    if depth not in DEPTHS[kind] or (transparency and kind in (GREY_ALPHA, RGBA)):
        return None
    top = (1 << depth) - 1
    pixels = noise(rng, (height, width, CHANNELS[kind]), top)
    palette = alphas = key = None
    if kind == PALETTE:
        entries = {"full": top + 1, "short": max(1, (top + 1) * 2 // 3)}[transparency_entries(transparency)]
        palette = noise(rng, (entries, 3), 255)
        pixels = pixels % entries
        alphas = noise(rng, (max(1, entries // 2),), 255) if transparency else None
    elif transparency:
        # The colour of one pixel becomes transparent; a second pixel differs from it in the lowest bit of one sample.
        key = pixels[height // 2, width // 2].copy()
        pixels[0, 0] = key ^ np.eye(CHANNELS[kind], dtype=np.int64)[-1]
    header = struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, int(interlaced))
    file = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + BEFORE_PALETTE[colours]
    if significant and depth == 8 and kind != PALETTE:
        file += chunk(b"sBIT", bytes([5] * CHANNELS[kind]))
    if palette is not None:
        file += chunk(b"PLTE", palette.astype(np.uint8).tobytes())
    if alphas is not None:
        file += chunk(b"tRNS", alphas.astype(np.uint8).tobytes())
    if key is not None:
        file += chunk(b"tRNS", key.astype(">u2").tobytes())
    compressed = zlib.compress(image_data(pixels, depth, interlaced, filters), deflate)
    file += BEFORE_DATA[extra] + data_chunks(compressed, split) + chunk(b"IEND", b"")
    values = meaning(pixels, top, palette, alphas, key)
    check_with_libpng(file, values, depth)
    full = 65535 if depth == 16 else 255
    return "png", file, Reference(values, full=full, channels=NAMES[values.shape[2]])


def transparency_entries(transparency):
    return "short" if transparency else "full"


def meaning(pixels, top, palette, alphas, key):
    """The values 0 ..= 1 that the samples stand for."""
    if palette is None:
        values = pixels / top
        if key is None:
            return values
        opaque = (pixels != key).any(axis=2, keepdims=True)
        return np.concatenate([values, opaque.astype(float)], axis=2)
    values = palette[pixels[:, :, 0]] / 255
    if alphas is None:
        return values
    padded = np.concatenate([alphas, np.full(256, 255)])
    return np.concatenate([values, padded[pixels] / 255], axis=2)


def check_with_libpng(file, values, depth):
    """libpng must agree where its wrapper keeps alpha."""
    with quiet():
        decoded = imagecodecs.png_decode(file)
    decoded = decoded[:, :, None] if decoded.ndim == 2 else decoded
    full = 65535 if decoded.dtype == np.uint16 else 255
    if decoded.shape != values.shape:
        # The wrapper ignores the transparency of some colour types.
        values = values[:, :, : decoded.shape[2]]
    if decoded.shape != values.shape or not np.array_equal(decoded, np.rint(values * full)):
        raise GeneratorFault(f"libpng reads other pixels from a PNG of depth {depth}")


def families():
    axes = {
        "colour": list(COLOURS),
        "depth": [1, 2, 4, 8, 16],
        "interlaced": [False, True],
        "transparency": [False, True],
        "size": [(1, 1), (3, 2), (5, 7), (8, 8), (17, 33), (20, 3)],
        "filters": [0, 1, 2, 3, 4, 5],
        "colours": list(BEFORE_PALETTE),
        "extra": list(BEFORE_DATA),
        "split": ["one", "many", "empty"],
        "deflate": [0, 1, 9],
        "significant": [False, True],
    }
    return [Family("PNG", axes, make), Family("PNG", {"animation": ["first frame"], "size": [(5, 7), (8, 3)]}, animated)]


def animated(rng, animation, size):
    """An animated PNG whose default image is its first frame: the reader returns it."""
    height, width = size
    frames = [noise(rng, (height, width, 3), 255) for _ in range(2)]
    header = struct.pack(">IIBBBBB", width, height, 8, RGB, 0, 0, 0)
    control = [struct.pack(">IIIIIHHBB", n, width, height, 0, 0, 1, 10, 0, 0) for n in (0, 1)]
    data = [zlib.compress(image_data(frame, 8, False, 0)) for frame in frames]
    file = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"acTL", struct.pack(">II", 2, 0))
    file += chunk(b"fcTL", control[0]) + chunk(b"IDAT", data[0])
    file += chunk(b"fcTL", control[1]) + chunk(b"fdAT", struct.pack(">I", 2) + data[1]) + chunk(b"IEND", b"")
    return "png", file, Reference(frames[0] / 255)
