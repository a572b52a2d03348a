#!/usr/bin/env python3
"""Writes the numbers of crates/roughcast-scene/src/metrics/hdr_flip_reference.rs with NVIDIA's own HDR-FLIP.

    python3 -m venv .venv/flip && .venv/flip/bin/pip install flip-evaluator==1.7
    .venv/flip/bin/python tools/hdr_flip.py

The pictures are those of the test: every value is a fraction of two powers of two, so that single floats represent it
equally in both places.
"""

import flip_evaluator
import numpy

WIDTH, HEIGHT = 48, 40
# Pixels whose expected error is in the test.
PIXELS = [(0, 0), (47, 39), (12, 8), (23, 20), (24, 20), (31, 7), (40, 30), (5, 33)]


def stops(name, x, y):
    """The stops above one of a block of pixels."""
    if name == "steps":
        return (x // 8 + 2 * (y // 8)) % 10 - 3
    if name == "dark":
        return -6 if (x // 4 + y // 4) % 5 else 3
    return 0


def reference(name):
    def value(x, y, c):
        return (1 + (7 * x + 13 * y + 5 * c) % 32) / 32 * 2.0 ** stops(name, x, y)

    return picture(value)


def test(name):
    """The reference with a darker stripe, a redder one, and every ninth pixel twice as bright."""
    of = reference(name)
    of[:, 8:16] *= numpy.float32(0.75)
    of[:, 24:32, 0] *= numpy.float32(1.5)
    of.reshape(-1, 3)[::9] *= numpy.float32(2)
    return of


def picture(value):
    pixels = [[[value(x, y, c) for c in range(3)] for x in range(WIDTH)] for y in range(HEIGHT)]
    return numpy.array(pixels, dtype=numpy.float32)


def main():
    for name in ("steps", "dark", "plain"):
        errors, _, used = flip_evaluator.evaluate(reference(name), test(name), "HDR", applyMagma=False)
        errors = errors.reshape(HEIGHT, WIDTH)
        print(f'    Expected {{ name: "{name}",')
        print(f"        exposures: ({used['startExposure']!r}, {used['stopExposure']!r}, {used['numExposures']}),")
        print(f"        mean: {errors.astype(numpy.float64).mean():.7f},")
        print("        errors: [" + ", ".join(f"{errors[y, x]:.6f}" for x, y in PIXELS) + "] },")


if __name__ == "__main__":
    main()
