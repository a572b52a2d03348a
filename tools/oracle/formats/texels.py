"""Texels of KTX2 and DDS: random bytes of a format and the values that they stand for, computed in float64.

Blocks after the Khronos Data Format Specification, chapters on S3TC and RGTC; BC7 by Pillow, whose decoder is its own."""

import io
import struct
from dataclasses import dataclass

import numpy as np
from PIL import Image

from case import Reference

# Direct3D lets a decoder of BC1 to BC3 be off by one step of 8 bits; what it rounds comes on top.
BLOCK_TOLERANCE = 1.01 / 255
# Signed BC4 and BC5 are floats in our reader, with a few roundings of single floats.
SIGNED_BLOCK_TOLERANCE = 1e-6


@dataclass
class Texels:
    """The bytes of a level of one layer, and their meaning."""

    data: bytes
    values: np.ndarray
    full: int | None = 255
    tolerance: float = 0.0
    range: str = "Unorm"

    def reference(self, values, optional=0):
        """The expected image of these texels, given its values after any rearrangement."""
        return Reference(
            values, full=self.full, tolerance=self.tolerance, range=self.range, optional=optional, float_ulps=1
        )


def plain(rng, height, width, encoding, channels, order="RGBA", least=None):
    """Channels of one type, one after the other. `order` names them as they lie in the file."""
    shape = (height, width, channels)
    if encoding in ("unorm8", "unorm16"):
        bits = int(encoding[5:])
        stored = rng.integers(0, 1 << bits, shape).astype(f"<u{bits // 8}")
        values, full = stored / ((1 << bits) - 1), (1 << bits) - 1
    elif encoding in ("snorm8", "snorm16"):
        bits = int(encoding[5:])
        stored = rng.integers(-(1 << bits - 1), 1 << bits - 1, shape).astype(f"<i{bits // 8}")
        stored[0, 0, 0] = -(1 << bits - 1)
        values, full = np.maximum(stored / ((1 << bits - 1) - 1), -1), None
    else:
        stored = (rng.normal(0, 1, shape) * 2.0 ** rng.integers(-12, 12, shape)).astype({"half": "<f2", "float": "<f4"}[encoding])
        values, full = stored.astype(float), None
    places = [order[:channels].index(name) for name in "RGBA" if name in order[:channels]]
    kind = {"u": "Unorm", "s": "Snorm"}.get(encoding[0], "Float")
    return Texels(stored.tobytes(), values[:, :, places], full, range=kind)


def packed(rng, height, width, bits, fields):
    """Fields cut out of an integer: (mask, signed) of each channel in the order in which they are read."""
    words = rng.integers(0, 1 << bits, (height, width), dtype=np.int64)
    raw = words.astype("<u4").view(np.uint8).reshape(height, width, 4)[:, :, : bits // 8]
    channels, widest, any_signed = [], 0, False
    for mask, signed in fields:
        shift = (mask & -mask).bit_length() - 1
        count = (mask >> shift).bit_length()
        value = (words & mask) >> shift
        if signed:
            value = np.where(value >> (count - 1), value - (1 << count), value)
            channels.append(np.maximum(value / ((1 << count - 1) - 1), -1))
        else:
            channels.append(value / ((1 << count) - 1))
        widest, any_signed = max(widest, count), any_signed or signed
    full = None if any_signed else 255 if widest <= 8 else 65535
    return Texels(np.ascontiguousarray(raw).tobytes(), np.stack(channels, axis=-1), full, range="Snorm" if any_signed else "Unorm")


def colours_565(word):
    return np.stack([(word >> 11 & 31) / 31, (word >> 5 & 63) / 63, (word & 31) / 31], axis=-1)


def colour_blocks(blocks, always_four):
    """BC1 blocks[n, 8] to values[n, 16, 4]; BC2 and BC3 always have four colours."""
    ends = blocks[:, :4].copy().view("<u2").astype(np.int64)
    first, second = colours_565(ends[:, 0]), colours_565(ends[:, 1])
    four = np.stack([first, second, (2 * first + second) / 3, (first + 2 * second) / 3], axis=1)
    three = np.stack([first, second, (first + second) / 2, np.zeros_like(first)], axis=1)
    is_four = (ends[:, 0] > ends[:, 1]) | always_four
    table = np.where(is_four[:, None, None], four, three)
    indices = (blocks[:, 4:].copy().view("<u4") >> (2 * np.arange(16))) & 3
    rgb = np.take_along_axis(table, indices[:, :, None].astype(np.int64), axis=1)
    alpha = np.where(~is_four[:, None] & (indices == 3), 0.0, 1.0)
    return np.concatenate([rgb, alpha[:, :, None]], axis=2)


def single_blocks(blocks, signed):
    """BC4 blocks[n, 8] to values[n, 16]."""
    ends = blocks[:, :2].copy().view(np.int8 if signed else np.uint8).astype(np.int64)
    # The stored numbers decide which of the two tables applies; -128 means -127.
    long = ends[:, 0] > ends[:, 1]
    a, b = (np.maximum(ends[:, i], -127) / 127 if signed else ends[:, i] / 255 for i in (0, 1))
    eight = np.stack([a, b] + [((7 - k) * a + k * b) / 7 for k in range(1, 7)], axis=1)
    six = np.stack([a, b] + [((5 - k) * a + k * b) / 5 for k in range(1, 5)], axis=1)
    low = np.full(len(a), -1.0 if signed else 0.0)
    six = np.concatenate([six, low[:, None], np.ones((len(a), 1))], axis=1)
    table = np.where(long[:, None], eight, six)
    wide = np.zeros((len(blocks), 8), np.uint8)
    wide[:, :6] = blocks[:, 2:]
    indices = (wide.view("<u8") >> (3 * np.arange(16, dtype=np.uint64))) & np.uint64(7)
    return np.take_along_axis(table, indices.astype(np.int64), axis=1)


BLOCK_BYTES = {"BC1": 8, "BC1 RGB": 8, "BC2": 16, "BC3": 16, "BC4": 8, "BC4 signed": 8, "BC5": 16, "BC5 signed": 16, "BC6H": 16, "BC7": 16}


def block_values(code, blocks):
    """values[n, 16, channels] of blocks[n, bytes]."""
    if code == "BC1":
        return colour_blocks(blocks, False)
    if code == "BC1 RGB":
        return colour_blocks(blocks, False)[:, :, :3]
    if code in ("BC2", "BC3"):
        values = colour_blocks(np.ascontiguousarray(blocks[:, 8:]), True)
        if code == "BC2":
            nibbles = np.stack([blocks[:, :8] & 15, blocks[:, :8] >> 4], axis=-1).reshape(len(blocks), 16)
            values[:, :, 3] = nibbles / 15
        else:
            values[:, :, 3] = single_blocks(blocks[:, :8], False)
        return values
    signed = code.endswith("signed")
    if code.startswith("BC4"):
        return single_blocks(blocks, signed)[:, :, None]
    return np.stack([single_blocks(np.ascontiguousarray(blocks[:, i : i + 8]), signed) for i in (0, 8)], axis=-1)


def blocks(rng, height, width, code):
    """Random blocks of a code."""
    rows, columns = -(-height // 4), -(-width // 4)
    stored = rng.integers(0, 256, (rows * columns, BLOCK_BYTES[code]), dtype=np.uint8)
    if code == "BC7":
        # The lowest set bit selects one of eight modes.
        mode = rng.integers(0, 8, len(stored)).astype(np.uint8)
        stored[:, 0] = (stored[:, 0] & ~((2 << mode) - 1) | 1 << mode).astype(np.uint8)
        return Texels(stored.tobytes(), bc7_by_pillow(stored.tobytes(), height, width))
    if code == "BC6H":
        return Texels(stored.tobytes(), np.zeros((height, width, 3)))
    values = block_values(code, stored)
    grid = values.reshape(rows, columns, 4, 4, -1).transpose(0, 2, 1, 3, 4).reshape(4 * rows, 4 * columns, -1)
    signed = code.endswith("signed")
    exact = code in ("BC4", "BC5")
    tolerance = 0.0 if exact else SIGNED_BLOCK_TOLERANCE if signed else BLOCK_TOLERANCE
    return Texels(stored.tobytes(), grid[:height, :width], 65535 if exact else 255, tolerance, "Snorm" if signed else "Unorm")


def bc7_by_pillow(data, height, width):
    words = [124, 0x1007, height, width, 0, 0, 0] + [0] * 11 + [32, 4, int.from_bytes(b"DX10", "little")] + [0] * 5
    header = b"DDS " + struct.pack("<26I", *words) + struct.pack("<I4x4x4x4x", 0x1000)
    file = header[:128] + struct.pack("<5I", 98, 3, 0, 1, 0) + data
    return np.asarray(Image.open(io.BytesIO(file)).convert("RGBA")) / 255


def level_side(side, level):
    return max(1, side >> level)
