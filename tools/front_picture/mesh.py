"""The surfaces of the scene, as Wavefront OBJ files."""

import math


def sphere(centre, radius, repeats, floor=0.0):
    """A sphere as six bulged squares, on each of which the map repeats `repeats` times: no poles, where a map would be pinched. Everything
    below `floor` is flattened."""
    steps = 48
    return [bulged_square(side, sign, steps, centre, radius, repeats, floor) for side in range(3) for sign in (1, -1)]


def bulged_square(side, sign, steps, centre, radius, repeats, floor):
    """One face of a cube, pushed out to the sphere; equal steps are equal angles. Seen from outside, v is a quarter turn clockwise from u."""
    vertices = []
    for row in range(steps + 1):
        for column in range(steps + 1):
            u, v = column / steps, row / steps
            across, up = (math.tan(math.pi / 4 * (2 * t - 1)) for t in (u, v))
            direction = [0.0, 0.0, 0.0]
            direction[side] = sign
            direction[(side + 1) % 3], direction[(side + 2) % 3] = -across * sign, up
            length = math.hypot(*direction)
            normal = tuple(x / length for x in direction)
            x, y, z = (c + radius * n for c, n in zip(centre, normal))
            vertices.append(((x, max(y, floor), z), (u * repeats, v * repeats), normal))
    return vertices, steps, steps


def plane(half, repeats):
    """A square in the plane y = 0, with sides of 2 x `half`, on which the map repeats `repeats` times a unit."""
    corners = [(-half, -half), (half, -half), (-half, half), (half, half)]
    return [((x, 0.0, z), (x * repeats, z * repeats), (0.0, 1.0, 0.0)) for x, z in corners], 1, 1


def obj(surfaces):
    """The text of an OBJ file."""
    lines, base = [], 1
    for vertices, columns, rows in surfaces:
        for position, coordinates, normal in vertices:
            lines.append("v {:.6f} {:.6f} {:.6f}".format(*position))
            lines.append("vt {:.6f} {:.6f}".format(*coordinates))
            lines.append("vn {:.6f} {:.6f} {:.6f}".format(*normal))
        for row in range(rows):
            for column in range(columns):
                a = base + row * (columns + 1) + column
                b, c, d = a + 1, a + columns + 1, a + columns + 2
                lines += ["f " + " ".join(f"{k}/{k}/{k}" for k in corners) for corners in ((a, c, b), (b, c, d))]
        base += len(vertices)
    return "\n".join(lines) + "\n"
