"""Voronoi cells by cutting the frame along every bisector, in rational numbers. It shares no code with the package."""

from fractions import Fraction
from itertools import pairwise


def cut(ring, a, b):
    """The part of a convex ring that is at least as near to a as to b."""

    def farther(p):  # than a is nearer: 0 on the bisector
        return (p[0] - a[0]) ** 2 + (p[1] - a[1]) ** 2 - (p[0] - b[0]) ** 2 - (p[1] - b[1]) ** 2

    kept = []
    for p, q in pairwise([*ring, *ring[:1]]):
        at_p, at_q = farther(p), farther(q)
        if at_p <= 0:
            kept.append(p)
        if at_p * at_q < 0:
            t = at_p / (at_p - at_q)
            kept.append((p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])))
    return kept


def twice_area(ring):
    return sum((p[0] * q[1] - q[0] * p[1] for p, q in pairwise([*ring, *ring[:1]])), Fraction(0))


def exact_cells(points, frame):
    """Corners of the cell of each point, counter-clockwise from the smallest; of duplicates, and without area, []."""
    sites = [(Fraction(x), Fraction(y)) for x, y in points]
    left, bottom, right, top = map(Fraction, frame)
    cells = []
    for i, site in enumerate(sites):
        ring = [(left, bottom), (right, bottom), (right, top), (left, top)] if site not in sites[:i] else []
        for other in set(sites) - {site}:
            ring = cut(ring, site, other)
        cells.append(corners(ring) if twice_area(ring) > 0 else [])
    return cells


def corners(ring):
    """Leave out what lies at or between others; begin with the smallest."""
    ring = [p for p, q in pairwise([*ring, *ring[:1]]) if p != q]
    count = len(ring)
    turning = [
        ring[i]
        for i in range(count)
        if (ring[i][0] - ring[i - 1][0]) * (ring[(i + 1) % count][1] - ring[i][1])
        != (ring[i][1] - ring[i - 1][1]) * (ring[(i + 1) % count][0] - ring[i][0])
    ]
    start = turning.index(min(turning))
    return turning[start:] + turning[:start]


def nearest_double(value):
    """The double nearest to a rational: Python divides integers that way."""
    return value.numerator / value.denominator
