"""Makes docs/front.png, the picture on the first page: mip-mapped normals, roughcast and ground truth, side by side.

    cargo build --release && python3 tools/front_picture

ROUGHCAST names another program, `--rays 16` makes a quick draft, `-o FILE` writes elsewhere. A floor that extends to
the horizon and four spheres are rendered with each method at twice the size. The spheres are then composited over the
floor and both over a sky, by coverage, and 2 x 2 samples make a pixel. The tool prints the root mean square difference
from the ground truth, in codes of 0 to 255.
"""

import argparse
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import exr
import lettering
import mesh
import png

REPOSITORY = Path(__file__).resolve().parent.parent.parent
ROUGHCAST = os.environ.get("ROUGHCAST", REPOSITORY / "target/release/roughcast")

# Size of a panel, in pixels; rendered at twice the size.
WIDTH, HEIGHT, GAP = 528, 400, 8
VIEW = "--camera 0,1.7,4.2 --look-at 0,0.42,-1 --fov 36 --repeat 1"
# A low sun behind the scene, another from the right behind the camera, and the sky from the left.
LIGHT = "--light 0.10,0.45,-1,2.6,1.5,0.7 --light 1,1.2,0.9,3.0,2.1,1.3 --light -1,0.5,0.25,0.35,0.75,1.8 --ambient 0.10,0.18,0.36"
RADIUS, SUNK = 0.56, 0.84
PLACES = [(-0.72, 0.75), (0.66, -0.9), (-1.0, -4.2), (2.1, -6.5)]

# What is drawn, from back to front: the mesh, the map and its options.
LAYERS = [
    (
        [mesh.plane(80.0, 1.2)],
        "testdata/materials/pmndrs_normals/0024.webp",
        "--albedo 0.04,0.065,0.10 --specular-power 300",
    ),
    (
        [face for x, z in PLACES for face in mesh.sphere((x, RADIUS * SUNK, z), RADIUS, 2)],
        "examples/rock_normal.png",
        "--albedo 0.14,0.05,0.025 --specular 0.95,0.64,0.54 --specular-power 120",
    ),
]
EXPOSURE = 0.85
# Radiance of the sky at the top of the picture and at the horizon, and the height of the horizon as a fraction of the picture.
ZENITH, DUSK, HORIZON = (0.06, 0.13, 0.36), (0.75, 0.32, 0.10), 0.16
# Size of the letters, in pixels.
UNIT, BASELINE = 2.5, 38
# Codes are rounded to multiples of this, which is invisible. Without the rounding, the file is larger than 900 kB.
STEP = 2


def methods(rays):
    """The label and the options of each panel."""
    return [
        ("mip-mapped normals", "--shading blinn-phong"),
        ("roughcast", "--shading lean"),
        ("ground truth", f"--filter truth:{rays}"),
    ]


def rendered(folder, index, options):
    """A layer by one method, as the channels of its EXR."""
    surfaces, source, material = LAYERS[index]
    shape, picture = folder / f"{index}.obj", folder / "picture.exr"
    shape.write_text(mesh.obj(surfaces))
    command = [ROUGHCAST, "render", REPOSITORY / source, "-o", picture, "--scene", shape, "--size", f"{2 * WIDTH}x{2 * HEIGHT}"]
    subprocess.run([*command, *f"{VIEW} {LIGHT} {material} {options}".split()], check=True, stdout=subprocess.DEVNULL)
    return exr.read(picture.read_bytes())[2]


def sky(row, channel):
    """Radiance behind everything."""
    t = min(1.0, row / (2 * HEIGHT * HORIZON))
    return ZENITH[channel] + DUSK[channel] * t ** (4 - channel)


def srgb(linear):
    """A code of IEC 61966-2-1."""
    return round(255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055))


def plane_of(layers, channel):
    """One colour of a panel in sRGB. Each sample is clamped to the range of a screen before averaging, so that edges of highlights are smooth."""
    width = 2 * WIDTH
    values = [sky(row, channel) for row in range(2 * HEIGHT) for _ in range(width)]
    for layer in layers:
        values = [under * (1 - part) + over for under, part, over in zip(values, layer["A"], layer["RGB"[channel]])]
    shown = [1 - math.exp(-EXPOSURE * value) for value in values]
    codes = bytearray()
    for row in range(HEIGHT):
        upper = shown[2 * row * width : (2 * row + 1) * width]
        lower = shown[(2 * row + 1) * width : (2 * row + 2) * width]
        codes += bytes(srgb(0.25 * sum(four)) for four in zip(upper[::2], upper[1::2], lower[::2], lower[1::2]))
    return codes


def panel(folder, options):
    """The RGB bytes of one method."""
    layers = [rendered(folder, index, options) for index in range(len(LAYERS))]
    codes = bytearray(3 * WIDTH * HEIGHT)
    for channel in range(3):
        codes[channel::3] = plane_of(layers, channel)
    return codes


def label(codes, words):
    """Writes words at the top of a panel, white with a dark edge."""
    for grow, colour in ((1.2, 30), (0.0, 255)):
        for (column, row), part in lettering.coverage(words, UNIT, WIDTH / 2, BASELINE, grow).items():
            at = 3 * (row * WIDTH + column)
            part *= 1.0 if colour == 255 else 0.5
            codes[at : at + 3] = bytes(round(code + part * (colour - code)) for code in codes[at : at + 3])


def difference(a, b):
    """Root mean square, in codes."""
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)) / len(a))


def main():
    parser = argparse.ArgumentParser(description="Makes the picture of the first page.")
    parser.add_argument("--rays", type=int, default=400, help="rays per sample of the ground truth, a square number (default 400)")
    parser.add_argument("-o", "--output", type=Path, default=REPOSITORY / "docs/front.png")
    arguments = parser.parse_args()
    chosen = methods(arguments.rays)
    with tempfile.TemporaryDirectory() as folder:
        panels = [panel(Path(folder), options) for _, options in chosen]
    for (words, _), codes in zip(chosen, panels):
        print(f"{words}: {difference(codes, panels[-1]):.1f}")
    for (words, _), codes in zip(chosen, panels):
        label(codes, words)
    panels = [bytes(min(255, STEP * round(code / STEP)) for code in codes) for codes in panels]
    line = 3 * WIDTH
    rows = [(b"\xff" * 3 * GAP).join(codes[line * row : line * (row + 1)] for codes in panels) for row in range(HEIGHT)]
    arguments.output.write_bytes(png.encoded(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
