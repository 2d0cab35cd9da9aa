"""Curved bodies as mappings of boxes: quarter discs, arcs, rings."""
import math

from curved import stations  # noqa: F401  (graded stations, shared with the cases of the tests)


def coons(bottom, top, left, right):
    """The transfinite mapping of the unit square whose sides are the four curves."""
    corner = {(i, j): (bottom if j == 0 else top)(float(i)) for i in (0, 1) for j in (0, 1)}

    def at(u, v):
        out = []
        for d in (0, 1):
            ruled = (1 - v) * bottom(u)[d] + v * top(u)[d] + (1 - u) * left(v)[d] + u * right(v)[d]
            both = sum(corner[i, j][d] * (u if i else 1 - u) * (v if j else 1 - v) for i in (0, 1) for j in (0, 1))
            out.append(ruled - both)
        return tuple(out)
    return at


def quarter_disc(radius, turn=math.pi / 4):
    """The lower right quarter of a disc that touches y = 0 at the origin; u = 0 is its axis, v = 0 the arc up to `turn`."""
    arc = lambda angle: (radius * math.sin(angle), radius * (1 - math.cos(angle)))
    return coons(lambda u: arc(turn * u), lambda u: (radius * u, radius), lambda v: (0.0, radius * v),
                 lambda v: arc(turn + (math.pi / 2 - turn) * v))


def polar(x, y):
    """Radius and angle to a point."""
    return (x * math.cos(y), x * math.sin(y))


def scaled(stops):
    """Stations from 0 to 1."""
    return [s / stops[-1] for s in stops]


def edge_of_contact(points):
    """Half-width a of p = p0 sqrt(1 - x²/a²), by least squares of p² over x² where p exceeds a third of the largest; and p0."""
    top = max(p for _, p in points)
    rows = [(x * x, p * p) for x, p in points if p > top / 3]
    n, sx, sy = len(rows), sum(r[0] for r in rows), sum(r[1] for r in rows)
    sxx, sxy = sum(r[0] ** 2 for r in rows), sum(r[0] * r[1] for r in rows)
    slope = (n * sxy - sx * sy) / (n * sxx - sx * sx)
    level = (sy - slope * sx) / n
    return math.sqrt(-level / slope), math.sqrt(level)


def bulge(radius, arc, depth, sign):
    """Maps (x, s) with s from 0 to 1 to a block on one side of y = 0 whose surface is an arc around x = 0, flat beyond `arc`."""
    profile = lambda x: radius - math.sqrt(radius ** 2 - min(abs(x), arc) ** 2)
    if sign > 0:
        return lambda x, s: (x, profile(x) + s * (depth - profile(x)))
    return lambda x, s: (x, -(depth - s * (depth - profile(x))))


def mirrored(stops):
    return [-s for s in reversed(stops[1:])] + list(stops)
