"""Tests of the parts of tools/front_picture."""

import math
import struct
import sys
import unittest
import zlib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "front_picture"))

import exr
import lettering
import mesh
import png


def zipped(data):
    """EXR's ZIP compression: the even bytes, then the odd ones, as differences, deflated."""
    halves = data[0::2] + data[1::2]
    coded = bytes([halves[0]]) + bytes((b - a + 128) & 255 for a, b in zip(halves, halves[1:]))
    return zlib.compress(coded)


def attribute(name, kind, data):
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data


def file_of(columns, channels, packed):
    """An EXR of one row and one tile a pixel wide for each of `packed`."""
    chlist = b"".join(name + b"\0" + struct.pack("<4i", 2, 0, 1, 1) for name in channels) + b"\0"
    head = b"\x76\x2f\x31\x01" + struct.pack("<I", 0x202)
    head += attribute(b"channels", b"chlist", chlist)
    head += attribute(b"dataWindow", b"box2i", struct.pack("<4i", 0, 0, columns - 1, 0))
    head += attribute(b"tiles", b"tiledesc", struct.pack("<2IB", 1, 1, 0)) + b"\0"
    offsets, tiles = [], b""
    for column, data in enumerate(packed):
        offsets.append(len(head) + 8 * len(packed) + len(tiles))
        tiles += struct.pack("<5i", column, 0, 0, 0, len(data)) + data
    return head + struct.pack(f"<{len(offsets)}Q", *offsets) + tiles


class Exr(unittest.TestCase):
    def test_reads_stored_and_zipped_tiles(self):
        # Equal values, which compress to less than 80 bytes.
        values = [1.5] * 20
        names = [bytes([65 + index]) for index in range(len(values))]
        stored = struct.pack("<20f", *range(20))
        alike = struct.pack("<20f", *values)
        self.assertLess(len(zipped(alike)), len(alike))
        width, height, channels = exr.read(file_of(2, names, [stored, zipped(alike)]))
        self.assertEqual((width, height), (2, 1))
        self.assertEqual([list(channels[name.decode()]) for name in names], [[index, 1.5] for index in range(20)])

    def test_refuses_other_files(self):
        with self.assertRaises(ValueError):
            exr.read(b"\x89PNG\r\n\x1a\n")


class Png(unittest.TestCase):
    def test_holds_the_rows(self):
        data = png.encoded([bytes(range(6)), bytes(range(6, 12))])
        begin = data.index(b"IDAT")
        (size,) = struct.unpack(">I", data[begin - 4 : begin])
        self.assertEqual(zlib.decompress(data[begin + 4 : begin + 4 + size]), b"\0" + bytes(range(6)) + b"\0" + bytes(range(6, 12)))
        self.assertEqual(struct.unpack(">2I", data[16:24]), (2, 2))


class Mesh(unittest.TestCase):
    def test_sphere_stands_on_its_floor(self):
        for vertices, columns, rows in mesh.sphere((1.0, 0.4, -2.0), 0.5, 3):
            self.assertEqual(len(vertices), (columns + 1) * (rows + 1))
            for (x, y, z), (u, v), normal in vertices:
                self.assertGreaterEqual(y, 0.0)
                self.assertAlmostEqual(math.hypot(*normal), 1.0)
                if y > 0.0:
                    self.assertAlmostEqual(math.dist((x, y, z), (1.0, 0.4, -2.0)), 0.5)
                self.assertTrue(0 <= u <= 3 and 0 <= v <= 3)

    def test_faces_look_outwards(self):
        for vertices, columns, _ in mesh.sphere((0.0, 0.0, 0.0), 1.0, 1, floor=-2.0):
            a, b, c = (vertices[index][0] for index in (0, columns + 1, 1))
            across, up = [[q - p for p, q in zip(a, other)] for other in (b, c)]
            cross = [across[i - 2] * up[i - 1] - across[i - 1] * up[i - 2] for i in range(3)]
            self.assertGreater(sum(p * q for p, q in zip(cross, a)), 0.0)


class Lettering(unittest.TestCase):
    def test_words_are_centred(self):
        covered = lettering.coverage("roughcast", 2.5, 100.0, 30)
        columns = [column for column, _ in covered]
        self.assertLess(abs(min(columns) + max(columns) + 1 - 200), 3)
        self.assertTrue(all(0 < part <= 1 for part in covered.values()))


if __name__ == "__main__":
    unittest.main()
