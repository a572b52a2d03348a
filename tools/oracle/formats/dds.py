"""DDS: the formats of Direct3D 9 by masks and codes, those of DXGI, levels, layers and odd headers, by a writer of its
own."""

import struct

import numpy as np

from case import Family, Reference
from formats.texels import blocks, level_side, packed, plain

ALPHA, FOURCC, PALETTE, RGB, YUV, LUMINANCE, BUMP_LUMINANCE, BUMP = 0x1, 0x4, 0x20, 0x40, 0x200, 0x20000, 0x40000, 0x80000
# Name: flags, bits, stored masks of red, green, blue and alpha, and which of them are signed; read in this order.
MASKS = {
    "L8": (LUMINANCE, 8, (0xFF, 0, 0, 0), ""),
    "L16": (LUMINANCE, 16, (0xFFFF, 0, 0, 0), ""),
    "A8L8": (LUMINANCE | ALPHA, 16, (0xFF, 0, 0, 0xFF00), ""),
    "A8L8, RGB flag": (RGB | ALPHA, 16, (0xFF, 0, 0, 0xFF00), ""),
    "A8": (0x2, 8, (0, 0, 0, 0xFF), ""),
    "A4L4": (LUMINANCE | ALPHA, 8, (0xF, 0, 0, 0xF0), ""),
    "R8": (RGB, 8, (0xFF, 0, 0, 0), ""),
    "R16": (RGB, 16, (0xFFFF, 0, 0, 0), ""),
    "G8R8": (RGB, 16, (0xFF, 0xFF00, 0, 0), ""),
    "G16R16": (RGB, 32, (0xFFFF, 0xFFFF0000, 0, 0), ""),
    "R5G6B5": (RGB, 16, (0xF800, 0x7E0, 0x1F, 0), ""),
    "X1R5G5B5": (RGB, 16, (0x7C00, 0x3E0, 0x1F, 0), ""),
    "A1R5G5B5": (RGB | ALPHA, 16, (0x7C00, 0x3E0, 0x1F, 0x8000), ""),
    "A4R4G4B4": (RGB | ALPHA, 16, (0xF00, 0xF0, 0xF, 0xF000), ""),
    "X4R4G4B4": (RGB, 16, (0xF00, 0xF0, 0xF, 0), ""),
    "R3G3B2": (RGB, 8, (0xE0, 0x1C, 0x3, 0), ""),
    "A8R3G3B2": (RGB | ALPHA, 16, (0xE0, 0x1C, 0x3, 0xFF00), ""),
    "R8G8B8": (RGB, 24, (0xFF0000, 0xFF00, 0xFF, 0), ""),
    "B8G8R8": (RGB, 24, (0xFF, 0xFF00, 0xFF0000, 0), ""),
    "A8R8G8B8": (RGB | ALPHA, 32, (0xFF0000, 0xFF00, 0xFF, 0xFF000000), ""),
    "X8R8G8B8": (RGB, 32, (0xFF0000, 0xFF00, 0xFF, 0), ""),
    "A8B8G8R8": (RGB | ALPHA, 32, (0xFF, 0xFF00, 0xFF0000, 0xFF000000), ""),
    "X8B8G8R8": (RGB, 32, (0xFF, 0xFF00, 0xFF0000, 0), ""),
    "A2B10G10R10": (RGB | ALPHA, 32, (0x3FF, 0xFFC00, 0x3FF00000, 0xC0000000), ""),
    "A2R10G10B10": (RGB | ALPHA, 32, (0x3FF00000, 0xFFC00, 0x3FF, 0xC0000000), ""),
    "V8U8": (BUMP, 16, (0xFF, 0xFF00, 0, 0), "RG"),
    "V16U16": (BUMP, 32, (0xFFFF, 0xFFFF0000, 0, 0), "RG"),
    "Q8W8V8U8": (BUMP, 32, (0xFF, 0xFF00, 0xFF0000, 0xFF000000), "RGBA"),
    "L6V5U5": (BUMP_LUMINANCE, 16, (0x1F, 0x3E0, 0xFC00, 0), "RG"),
    "X8L8V8U8": (BUMP_LUMINANCE, 32, (0xFF, 0xFF00, 0xFF0000, 0), "RG"),
    "A2W10V10U10": (BUMP | ALPHA, 32, (0x3FF, 0xFFC00, 0x3FF00000, 0xC0000000), "RGB"),
}
# Numbers of Direct3D 9 in place of a FourCC.
NUMBERS = {
    "A16B16G16R16": (36, "unorm16", 4), "Q16W16V16U16": (110, "snorm16", 4), "R16F": (111, "half", 1), "G16R16F": (112, "half", 2),
    "A16B16G16R16F": (113, "half", 4), "R32F": (114, "float", 1), "G32R32F": (115, "float", 2), "A32B32G32R32F": (116, "float", 4),
    "CxV8U8": (117, "snorm8", 2), "V8U8 by number": (60, "snorm8", 2), "Q8W8V8U8 by number": (63, "snorm8", 4),
    "V16U16 by number": (64, "snorm16", 2),
}  # fmt: skip
FOURCCS = {
    "DXT1": "BC1", "DXT2": "BC2", "DXT3": "BC2", "DXT4": "BC3", "DXT5": "BC3", "ATI1": "BC4", "BC4U": "BC4", "BC4S": "BC4 signed",
    "BC5U": "BC5", "BC5S": "BC5 signed", "ATI2": "BC5", "ATI2, A2XY": "BC5", "A2XY": "BC5", "RXGB": "BC3", "DXT5, A2D5": "BC3",
    "xGBR": "BC3", "RxBG": "BC3", "RBxG": "BC3", "xRBG": "BC3", "RGxB": "BC3", "xGxR": "BC3",
}  # fmt: skip
DXGI = {
    "R8_UNORM": (61, "unorm8", 1, "RGBA"), "R8_SNORM": (63, "snorm8", 1, "RGBA"), "R8G8_UNORM": (49, "unorm8", 2, "RGBA"),
    "R8G8_SNORM": (51, "snorm8", 2, "RGBA"), "R8G8B8A8_UNORM": (28, "unorm8", 4, "RGBA"), "R8G8B8A8_SRGB": (29, "unorm8", 4, "RGBA"),
    "R8G8B8A8_SNORM": (31, "snorm8", 4, "RGBA"), "B8G8R8A8_UNORM": (87, "unorm8", 4, "BGRA"), "B8G8R8A8_SRGB": (91, "unorm8", 4, "BGRA"),
    "R16_UNORM": (56, "unorm16", 1, "RGBA"), "R16_SNORM": (58, "snorm16", 1, "RGBA"), "R16G16_UNORM": (35, "unorm16", 2, "RGBA"),
    "R16G16_SNORM": (37, "snorm16", 2, "RGBA"), "R16G16B16A16_UNORM": (11, "unorm16", 4, "RGBA"),
    "R16G16B16A16_SNORM": (13, "snorm16", 4, "RGBA"), "R16_FLOAT": (54, "half", 1, "RGBA"), "R16G16_FLOAT": (34, "half", 2, "RGBA"),
    "R16G16B16A16_FLOAT": (10, "half", 4, "RGBA"), "R32_FLOAT": (41, "float", 1, "RGBA"), "R32G32_FLOAT": (16, "float", 2, "RGBA"),
    "R32G32B32_FLOAT": (6, "float", 3, "RGBA"), "R32G32B32A32_FLOAT": (2, "float", 4, "RGBA"),
}  # fmt: skip
DXGI_PACKED = {
    "R10G10B10A2_UNORM": (24, 32, (0x3FF, 0xFFC00, 0x3FF00000, 0xC0000000)), "B5G6R5_UNORM": (85, 16, (0xF800, 0x7E0, 0x1F)),
    "B5G5R5A1_UNORM": (86, 16, (0x7C00, 0x3E0, 0x1F, 0x8000)), "B4G4R4A4_UNORM": (115, 16, (0xF00, 0xF0, 0xF, 0xF000)),
    "B8G8R8X8_UNORM": (88, 32, (0xFF0000, 0xFF00, 0xFF)), "B8G8R8X8_SRGB": (93, 32, (0xFF0000, 0xFF00, 0xFF)),
    "A8_UNORM": (65, 8, (0xFF,)),
}  # fmt: skip
DXGI_BLOCKS = {
    "BC1_UNORM": (71, "BC1"), "BC1_SRGB": (72, "BC1"), "BC2_UNORM": (74, "BC2"), "BC2_SRGB": (75, "BC2"), "BC3_UNORM": (77, "BC3"),
    "BC3_SRGB": (78, "BC3"), "BC4_UNORM": (80, "BC4"), "BC4_SNORM": (81, "BC4 signed"), "BC5_UNORM": (83, "BC5"),
    "BC5_SNORM": (84, "BC5 signed"), "BC7_UNORM": (98, "BC7"), "BC7_SRGB": (99, "BC7"),
}  # fmt: skip
# Formats that are not maps: the words of its pixel format or its DXGI number, and the bytes of a texel.
OTHERS = {
    "palette": (PALETTE | RGB, 0, 8, (0, 0, 0, 0)), "YUV": (YUV, 0, 16, (0xFF, 0xFF00, 0, 0)),
    "UYVY": (FOURCC, b"UYVY", 0, (0, 0, 0, 0)), "unknown FourCC": (FOURCC, b"ABCD", 0, (0, 0, 0, 0)),
    "scattered mask": (RGB, 0, 16, (0xF00F, 0xF0, 0, 0)),
}  # fmt: skip
OTHER_DXGI = {"R32_UINT": 42, "R16G16_UINT": 36, "R8_SINT": 64, "D32_FLOAT": 40, "R9G9B9E5": 67, "R11G11B10_FLOAT": 26, "BC6H_UF16": 95, "NV12": 103}


def pixel_format(name):
    """The eight words of a pixel format."""
    if name in MASKS:
        flags, bits, masks, _ = MASKS[name]
        return [32, flags, 0, bits, *masks]
    if name in NUMBERS:
        return [32, FOURCC, NUMBERS[name][0], 0, 0, 0, 0, 0]
    if name in FOURCCS:
        code, marker = (name + ",").split(",")[:2]
        return [32, FOURCC, code_of(code), code_of(marker.strip()), 0, 0, 0, 0]
    return [32, FOURCC, code_of("DX10"), 0, 0, 0, 0, 0]


def code_of(text):
    return int.from_bytes(text.encode().ljust(4, b"\0"), "little")


def texels_of(rng, name, height, width):
    if name in MASKS:
        _, bits, masks, signed = MASKS[name]
        return packed(rng, height, width, bits, [(mask, letter in signed) for mask, letter in zip(masks, "RGBA") if mask])
    if name in NUMBERS:
        _, encoding, channels = NUMBERS[name]
        return plain(rng, height, width, encoding, channels)
    if name in FOURCCS:
        return blocks(rng, height, width, FOURCCS[name])
    if name in DXGI:
        _, encoding, channels, order = DXGI[name]
        return plain(rng, height, width, encoding, channels, order[:channels])
    if name in DXGI_PACKED:
        _, bits, masks = DXGI_PACKED[name]
        return packed(rng, height, width, bits, [(mask, False) for mask in masks])
    return blocks(rng, height, width, DXGI_BLOCKS[name][1])


def header(height, width, depth, levels, words, oddity, caps2=0):
    sizes = {"header size 0": (0, 0)}.get(oddity, (124, 32))
    flags = 0x1007 | (0x20000 if levels > 1 else 0) | (0x800000 if depth else 0)
    flags = 0x1007 if oddity == "flags incomplete" else flags
    reserved = [0] * 11
    if oddity == "writer's words":
        reserved[9] = int.from_bytes(b"NVTT", "little")
        reserved[10] = 0x20006
    caps = 0x1000 if oddity == "flags incomplete" or levels == 1 else 0x401008
    stated = 0 if levels == 1 and oddity == "flags incomplete" else levels
    words = [sizes[1], *words[1:]]
    return b"DDS " + struct.pack("<7I11I8I5I", sizes[0], flags, height, width, 0, depth, stated, *reserved, *words, caps, caps2, 0, 0, 0)


def make(rng, format, size, levels, layers, oddity):
    height, width = size
    dxgi = {**DXGI, **DXGI_PACKED, **DXGI_BLOCKS}.get(format)
    if layers > 1 and not dxgi:
        return None
    count = {"one": 1, "two": 2, "all": max(size).bit_length()}[levels]
    if count > max(size).bit_length():
        return None
    first, body = None, b""
    for _ in range(layers):
        for level in range(count):
            part = texels_of(rng, format, level_side(height, level), level_side(width, level))
            first = first or part
            body += part.data
    file = header(height, width, 0, count, pixel_format(format), oddity)
    if dxgi:
        file += struct.pack("<5I", dxgi[0], 0 if oddity == "flags incomplete" else 3, 0, layers, 0)
    values = first.values
    optional = 0
    if format == "RXGB":
        # Doom 3's: x in alpha; red, which is left over, comes last if at all.
        values, optional = values[:, :, [3, 1, 2, 0]], 1
    elif FOURCCS.get(format) == "BC3" and "x" in format:
        # Four letters say which colour each stored channel contains.
        values = values[:, :, [format.index(letter) for letter in "RGB" if letter in format]]
    if format == "CxV8U8" or format in ("L6V5U5", "X8L8V8U8", "A2W10V10U10"):
        optional = values.shape[2] - (3 if format == "A2W10V10U10" else 2)
    reference = first.reference(values, optional)
    # Writers disagree about which block of an ATI2 is x; pixels and options decide, not the reader.
    reference.either_order = format == "ATI2"
    return "dds", file + body, reference


def refused(rng, format, shape):
    """Formats and shapes that are not maps."""
    if (format == "RGBA") == (shape == "2-D") or (format != "RGBA" and shape != "2-D"):
        return None
    body = rng.integers(0, 256, 8 * 8 * 16 * 6, dtype=np.uint8).tobytes()
    caps2 = {"cube": 0xFE00, "3-D": 0x200000}.get(shape, 0)
    depth = 2 if shape == "3-D" else 0
    if format in OTHER_DXGI:
        file = header(8, 8, 0, 1, pixel_format("DX10"), "") + struct.pack("<5I", OTHER_DXGI[format], 3, 0, 1, 0)
    elif format in OTHERS:
        flags, code, bits, masks = OTHERS[format]
        words = [32, flags, int.from_bytes(code, "little") if code else 0, bits, *masks]
        file = header(8, 8, 0, 1, words, "")
    elif shape.startswith("DX10"):
        flags, dimension = {"DX10 cube": (4, 3), "DX10 3-D": (0, 4)}[shape]
        file = header(8, 8, 0, 1, pixel_format("DX10"), "") + struct.pack("<5I", 28, dimension, flags, 1, 0)
    else:
        file = header(8, 8, depth, 1, pixel_format("A8R8G8B8"), "", caps2)
    return "dds", file + body, Reference(np.zeros((1, 1, 1)))


def families():
    axes = {
        "format": [*MASKS, *NUMBERS, *FOURCCS, *DXGI, *DXGI_PACKED, *DXGI_BLOCKS],
        "size": [(1, 1), (4, 4), (3, 5), (7, 12), (17, 33)],
        "levels": ["one", "two", "all"],
        "layers": [1, 3],
        "oddity": ["none", "header size 0", "flags incomplete", "writer's words"],
    }
    others = {"format": [*OTHERS, *OTHER_DXGI, "RGBA"], "shape": ["2-D", "cube", "3-D", "DX10 cube", "DX10 3-D"]}
    return [Family("DDS", axes, make), Family("DDS", others, refused, name="others")]
