"""KTX2: formats, levels, layers, supercompression, swizzles and orientations, by a writer of its own."""

import struct
import zlib

import imagecodecs
import numpy as np

from case import Family, Reference
from formats.texels import blocks, level_side, packed, plain

SRGB = 2  # The transfer function in the data format descriptor.
FORMATS = {}
for _first, _encodings in [
    (9, {0: "unorm8", 1: "snorm8", 6: "sRGB"}),
    (16, {0: "unorm8", 1: "snorm8", 6: "sRGB"}),
    (23, {0: "unorm8", 1: "snorm8", 6: "sRGB"}),
    (37, {0: "unorm8", 1: "snorm8", 6: "sRGB"}),
    (70, {0: "unorm16", 1: "snorm16", 6: "half"}),
    (77, {0: "unorm16", 1: "snorm16", 6: "half"}),
    (84, {0: "unorm16", 1: "snorm16", 6: "half"}),
    (91, {0: "unorm16", 1: "snorm16", 6: "half"}),
]:
    _channels = {9: 1, 16: 2, 23: 3, 37: 4, 70: 1, 77: 2, 84: 3, 91: 4}[_first]
    for _offset, _encoding in _encodings.items():
        FORMATS[f"{_channels} of {_encoding}"] = (_first + _offset, _encoding.replace("sRGB", "unorm8"), _channels, "RGBA")
for _number, _channels in [(100, 1), (103, 2), (106, 3), (109, 4)]:
    FORMATS[f"{_channels} of float"] = (_number, "float", _channels, "RGBA")
for _number, _name, _encoding, _channels in [
    (30, "BGR of unorm8", "unorm8", 3), (31, "BGR of snorm8", "snorm8", 3), (36, "BGR of sRGB", "unorm8", 3),
    (44, "BGRA of unorm8", "unorm8", 4), (45, "BGRA of snorm8", "snorm8", 4), (50, "BGRA of sRGB", "unorm8", 4),
]:  # fmt: skip
    FORMATS[_name] = (_number, _encoding, _channels, "BGRA")
BLOCKS = {
    "BC1 RGB": 131, "BC1 RGB sRGB": 132, "BC1": 133, "BC1 sRGB": 134, "BC2": 135, "BC2 sRGB": 136, "BC3": 137, "BC3 sRGB": 138,
    "BC4": 139, "BC4 signed": 140, "BC5": 141, "BC5 signed": 142, "BC7": 145, "BC7 sRGB": 146,
}  # fmt: skip
# Number and, for each channel in the order in which it is read, its mask. (Vulkan names fields from the highest bit down.)
PACKED = {
    "B4G4R4A4": (3, 16, (0xF0, 0xF00, 0xF000, 0xF)),
    "B5G5R5A1": (7, 16, (0x3E, 0x7C0, 0xF800, 1)),
    "A8B8G8R8 signed": (52, 32, (0xFF, 0xFF00, 0xFF0000, 0xFF000000)),
    "A8B8G8R8 sRGB": (57, 32, (0xFF, 0xFF00, 0xFF0000, 0xFF000000)),
    "A2R10G10B10 signed": (59, 32, (0x3FF00000, 0xFFC00, 0x3FF, 0xC0000000)),
    "A2B10G10R10 signed": (65, 32, (0x3FF, 0xFFC00, 0x3FF00000, 0xC0000000)),
    "A4R4G4B4": (1000340000, 16, (0xF00, 0xF0, 0xF, 0xF000)),
    "A4B4G4R4": (1000340001, 16, (0xF, 0xF0, 0xF00, 0xF000)),
    "R4G4": (1, 8, (0xF0, 0x0F)),
    "R4G4B4A4": (2, 16, (0xF000, 0xF00, 0xF0, 0xF)),
    "R5G6B5": (4, 16, (0xF800, 0x7E0, 0x1F)),
    "B5G6R5": (5, 16, (0x1F, 0x7E0, 0xF800)),
    "R5G5B5A1": (6, 16, (0xF800, 0x7C0, 0x3E, 1)),
    "A1R5G5B5": (8, 16, (0x7C00, 0x3E0, 0x1F, 0x8000)),
    "A8B8G8R8": (51, 32, (0xFF, 0xFF00, 0xFF0000, 0xFF000000)),
    "A2R10G10B10": (58, 32, (0x3FF00000, 0xFFC00, 0x3FF, 0xC0000000)),
    "A2B10G10R10": (64, 32, (0x3FF, 0xFFC00, 0x3FF00000, 0xC0000000)),
}
# Formats that readers of maps do not need: number, bytes of a texel (or of a block).
OTHERS = {
    "8-bit integers": (13, 1), "8-bit signed integers": (14, 1), "16-bit integers": (74, 2), "32-bit integers": (98, 4),
    "doubles": (112, 8), "shared exponent": (123, 4), "11-bit floats": (122, 4), "8-bit integers, packed": (55, 4), "10-bit integers": (62, 4), "scaled 10 bits": (60, 4), "depth": (124, 2), "BC6H": (143, 16),
    "ETC2": (147, 8), "EAC": (153, 8), "ASTC HDR": (1000066000, 16), "PVRTC": (1000054000, 8), "8-bit scaled": (11, 1),
}  # fmt: skip
SWIZZLES = ["none", "rgba", "rrrg", "gggr", "bgra", "rg01", "r001", "0r1g", "argb", "000r", "aaaa"]
ORIENTATIONS = ["none", "rd", "ru", "ld", "lu"]


def pair(key, value):
    data = key.encode() + b"\0" + value + b"\0"
    return struct.pack("<I", len(data)) + data + bytes(-len(data) % 4)


def descriptor(channels, texel_bytes):
    samples = b"".join(struct.pack("<HBBIII", 8 * i, 7, i, 0, 0, 255) for i in range(channels))
    head = struct.pack("<IHH", 0, 2, 24 + len(samples)) + bytes([1, 1, 1, 0]) + bytes([0, 0, 0, 0])
    return struct.pack("<I", 28 + len(samples)) + head + bytes([texel_bytes]) + bytes(7) + samples


def write(number, levels, *, type_size, texel_bytes, channels, width, height, layers, stated_levels, scheme, pairs, faces=1, depth=0,
          table=None):  # fmt: skip
    """The bytes of a file; `levels` are those of each level, the largest first."""
    raw = levels
    packed_levels = {
        "none": lambda data: data,
        "zstd": lambda data: imagecodecs.zstd_encode(data, level=3),
        "zlib": lambda data: zlib.compress(data),
    }[scheme]
    stored = [packed_levels(data) for data in raw]
    table = table or descriptor(channels, texel_bytes)
    start = 80 + 24 * len(levels)
    pairs_start = start + len(table)
    file = bytearray(b"\xabKTX 20\xbb\r\n\x1a\n")
    file += struct.pack(
        "<9I", number, type_size, width, height, depth, layers, faces, stated_levels, {"none": 0, "zstd": 2, "zlib": 3}[scheme]
    )
    file += struct.pack("<4I", start, len(table), pairs_start if pairs else 0, len(pairs)) + struct.pack("<QQ", 0, 0)
    place, body, index = pairs_start + len(pairs), bytearray(), [None] * len(levels)
    for level in reversed(range(len(levels))):
        body += bytes(-(place + len(body)) % 16)
        index[level] = struct.pack("<QQQ", place + len(body), len(stored[level]), len(raw[level]))
        body += stored[level]
    return bytes(file + b"".join(index) + table + pairs + body)


def texels_of(rng, format, height, width):
    if format in FORMATS:
        _, encoding, channels, order = FORMATS[format]
        return plain(rng, height, width, encoding, channels, order[:channels])
    if format in PACKED:
        _, bits, masks = PACKED[format]
        return packed(rng, height, width, bits, [(mask, format.endswith("signed")) for mask in masks])
    return blocks(rng, height, width, format.removesuffix(" sRGB"))


def swizzled(values, swizzle):
    """Four channels, and how many of the last are what a texture without them has anyway: 0, and 1 for alpha."""
    channels = values.shape[2]
    absent = [0, 0, 0, 1]
    complete = [values[:, :, i] if i < channels else np.full(values.shape[:2], absent[i]) for i in range(4)]
    sources = {**dict(zip("rgba", complete)), "0": np.zeros(values.shape[:2]), "1": np.ones(values.shape[:2])}
    is_absent = [letter == str(absent[i]) or letter in "rgba"[channels:] and absent["rgba".index(letter)] == absent[i]
                 for i, letter in enumerate(swizzle)]  # fmt: skip
    optional = 0
    while optional < 3 and is_absent[3 - optional]:
        optional += 1
    return np.stack([sources[letter] for letter in swizzle], axis=-1), optional


def make(rng, format, size, levels, layers, scheme, swizzle, orientation, writer):
    height, width = size
    number = FORMATS[format][0] if format in FORMATS else PACKED[format][0] if format in PACKED else BLOCKS[format]
    count = {"one": 1, "made by the loader": 1, "two": 2, "all": max(size).bit_length()}[levels]
    if count > max(size).bit_length():
        return None
    first, data = None, []
    for level in range(count):
        parts = [texels_of(rng, format, level_side(height, level), level_side(width, level)) for _ in range(max(1, layers))]
        first = first or parts[0]
        data.append(b"".join(part.data for part in parts))
    pairs = []
    if orientation != "none":
        pairs.append(("KTXorientation", orientation.encode()))
    if swizzle != "none":
        pairs.append(("KTXswizzle", swizzle.encode()))
    if writer:
        pairs.append(("KTXwriter", b"a program 1.0"))
    values, optional = first.values, 0
    values = values[::-1] if orientation.endswith("u") else values
    values = values[:, ::-1] if orientation.startswith("l") else values
    if swizzle != "none":
        values, optional = swizzled(values, swizzle)
    texel_bytes = len(first.data) // (height * width) if format in FORMATS or format in PACKED else 16
    file = write(
        number, data, type_size=1, texel_bytes=texel_bytes, channels=1, width=width, height=height, layers=layers,
        stated_levels=0 if levels == "made by the loader" else count, scheme=scheme,
        pairs=b"".join(pair(*each) for each in sorted(pairs)),
    )  # fmt: skip
    return "ktx2", file, first.reference(values, optional)


def refused(rng, format, shape):
    """Formats and shapes that are not maps: a reader must not return pixels for them."""
    number, unit = OTHERS.get(format, (37, 4))
    layers, faces, depth, height = {"2-D": (0, 1, 0, 8), "cube": (0, 6, 0, 8), "3-D": (0, 1, 2, 8), "1-D": (0, 1, 0, 0)}[shape]
    if (format == "RGBA") == (shape == "2-D") or (format != "RGBA" and shape != "2-D"):
        return None
    data = rng.integers(0, 256, 8 * 8 * unit * faces * max(1, depth), dtype=np.uint8)
    rows = max(1, height)
    texels = data[: 8 * rows * unit * faces * max(1, depth)].tobytes()
    file = write(number, [texels], type_size=1, texel_bytes=unit, channels=1, width=8, height=height, layers=layers,
                 stated_levels=1, scheme="none", pairs=b"", faces=faces, depth=depth)  # fmt: skip
    # Only the texture of one dimension is read: one row.
    values = np.frombuffer(texels, np.uint8).reshape(1, 8, 4) / 255 if shape == "1-D" else np.zeros((1, 1, 1))
    return "ktx2", file, Reference(values)


def families():
    axes = {
        "format": [*FORMATS, *BLOCKS, *PACKED],
        "scheme": ["none", "zstd", "zlib"],
        "levels": ["one", "made by the loader", "two", "all"],
        "layers": [0, 1, 3],
        "swizzle": SWIZZLES,
        "orientation": ORIENTATIONS,
        "size": [(1, 1), (4, 4), (3, 5), (7, 12), (17, 33)],
        "writer": [False, True],
    }
    others = {"format": [*OTHERS, "RGBA"], "shape": ["2-D", "cube", "3-D", "1-D"]}
    return [Family("KTX2", axes, make), Family("KTX2", others, refused, name="others")]
