"""Reads the tiled, ZIP-compressed float EXR files that `roughcast render` writes, and no others."""

import array
import struct
import sys
import zlib

MAGIC = b"\x76\x2f\x31\x01"
FLOAT_BYTES = 4


def cut(data, at):
    """The text that ends with a zero byte, and the place after it."""
    end = data.index(0, at)
    return data[at:end].decode(), end + 1


def header(data):
    """The attributes by name, and the place of the table of tile offsets."""
    if data[:4] != MAGIC:
        raise ValueError("not an EXR file")
    attributes, at = {}, 8
    while data[at]:
        name, at = cut(data, at)
        _, at = cut(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channel_names(chlist):
    """The names of the channels, in the order in which tiles store them."""
    names, at = [], 0
    while chlist[at]:
        name, at = cut(chlist, at)
        names.append(name)
        at += 16
    return names


def unzipped(data, size):
    """A tile's bytes: deflate, then a predictor, then the two halves interleaved. A tile that does not shrink is stored as it is."""
    if len(data) == size:
        return data
    coded = bytearray(zlib.decompress(data))
    for at in range(1, size):
        coded[at] = (coded[at - 1] + coded[at] - 128) & 255
    half = (size + 1) // 2
    out = bytearray(size)
    out[0::2], out[1::2] = coded[:half], coded[half:]
    return bytes(out)


def floats(data):
    """Little-endian floats."""
    values = array.array("f", data)
    if sys.byteorder == "big":
        values.byteswap()
    return values


def read(data):
    """Width, height and the channels by name, each an array of floats from the top row down."""
    attributes, offsets = header(data)
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    tile_width, tile_height = struct.unpack_from("<2I", attributes["tiles"])
    names = channel_names(attributes["channels"])
    channels = {name: floats(bytes(FLOAT_BYTES * width * height)) for name in names}
    count = -(-width // tile_width) * -(-height // tile_height)
    for offset in struct.unpack_from(f"<{count}Q", data, offsets):
        column, row, _, _, packed = struct.unpack_from("<5i", data, offset)
        x, y = column * tile_width, row * tile_height
        columns, rows = min(tile_width, width - x), min(tile_height, height - y)
        size = FLOAT_BYTES * columns * rows * len(names)
        values = floats(unzipped(data[offset + 20 : offset + 20 + packed], size))
        for line in range(rows):
            for index, name in enumerate(names):
                begin = (line * len(names) + index) * columns
                to = (y + line) * width + x
                channels[name][to : to + columns] = values[begin : begin + columns]
    return width, height, channels
