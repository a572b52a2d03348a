"""Draws words with a round pen. The letters are those of the picture's labels."""

import math


def arc(x, y, across, up, begin, end):
    """Points of a part of an ellipse around (x, y); angles in degrees, 0 to the right, 90 up."""
    steps = 16
    angles = [math.radians(begin + (end - begin) * step / steps) for step in range(steps + 1)]
    return [(x + across * math.cos(angle), y + up * math.sin(angle)) for angle in angles]


BOWL = arc(2, 2.5, 2, 2.5, 0, 360)
SHOULDER = [*arc(2, 3, 2, 2, 180, 0), (4, 0)]
# The width and the strokes of each letter. The baseline is at 0, small letters are 5 high, tall ones 8.
LETTERS = {
    " ": (2, []),
    "-": (2.6, [[(0.2, 2.6), (2.4, 2.6)]]),
    "a": (4, [BOWL, [(4, 5), (4, 0)]]),
    "c": (3.6, [arc(2, 2.5, 2, 2.5, 45, 315)]),
    "d": (4, [BOWL, [(4, 8), (4, 0)]]),
    "e": (4, [[(0.1, 2.7), *arc(2, 2.5, 2, 2.5, 5, 310)]]),
    "g": (4, [BOWL, [(4, 5), *arc(2, -0.6, 2, 2, 0, -150)]]),
    "h": (4, [[(0, 8), (0, 0)], SHOULDER]),
    "i": (0, [[(0, 5), (0, 0)], [(0, 7.2), (0, 7.3)]]),
    "l": (0, [[(0, 8), (0, 0)]]),
    "m": (6, [[(0, 5), (0, 0)], [*arc(1.5, 3.5, 1.5, 1.5, 180, 0), (3, 0)], [*arc(4.5, 3.5, 1.5, 1.5, 180, 0), (6, 0)]]),
    "n": (4, [[(0, 5), (0, 0)], SHOULDER]),
    "o": (4, [BOWL]),
    "p": (4, [BOWL, [(0, 5), (0, -2.8)]]),
    "r": (2.2, [[(0, 5), (0, 0)], arc(2, 3, 2, 2, 180, 75)]),
    "s": (3, [[*arc(1.6, 3.75, 1.4, 1.25, 40, 250), *arc(1.5, 1.27, 1.5, 1.27, 80, -145)]]),
    "t": (2.2, [[(0.8, 7), (0.8, 1.4), *arc(2, 1.4, 1.2, 1.4, 180, 275)], [(-0.3, 5), (2.2, 5)]]),
    "u": (4, [[(0, 5), *arc(2, 2, 2, 2, 180, 360)], [(4, 5), (4, 0)]]),
}
# The gap between two letters, and half the width of the pen.
GAP, PEN = 1.7, 0.48


def segments(words):
    """The straight pieces of all strokes, in units of the letters, and the width of the whole."""
    pieces, x = [], 0.0
    for letter in words:
        width, strokes = LETTERS[letter]
        for stroke in strokes:
            pieces += [((x + a[0], a[1]), (x + b[0], b[1])) for a, b in zip(stroke, stroke[1:])]
        x += width + GAP
    return pieces, x - GAP


def distance(x, y, piece):
    """From a point to a straight piece."""
    (ax, ay), (bx, by) = piece
    dx, dy = bx - ax, by - ay
    squared = dx * dx + dy * dy
    along = max(0.0, min(1.0, ((x - ax) * dx + (y - ay) * dy) / squared)) if squared else 0.0
    return math.hypot(x - ax - along * dx, y - ay - along * dy)


def coverage(words, unit, centre, baseline, grow=0.0):
    """The fraction of each pixel that the pen covers, by (column, row); `unit` in pixels, the pen wider by `grow` pixels."""
    pieces, width = segments(words)
    left = centre - 0.5 * width * unit
    reach = PEN * unit + grow
    covered = {}
    for piece in pieces:
        (ax, ay), (bx, by) = [(left + x * unit, baseline - y * unit) for x, y in piece]
        for row in range(int(min(ay, by) - reach - 1), int(max(ay, by) + reach + 2)):
            for column in range(int(min(ax, bx) - reach - 1), int(max(ax, bx) + reach + 2)):
                part = reach + 0.5 - distance(column + 0.5, row + 0.5, ((ax, ay), (bx, by)))
                if part > 0:
                    covered[column, row] = max(covered.get((column, row), 0.0), min(part, 1.0))
    return covered
