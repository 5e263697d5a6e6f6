"""Delaunay triangulations from the definition, in rational numbers. It shares no code with the package."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations, pairwise


def cross(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def circle(a, b, c):
    """Centre and squared radius."""
    bx, by, cx, cy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    d, b2, c2 = 2 * (bx * cy - by * cx), bx * bx + by * by, cx * cx + cy * cy
    x, y = (cy * b2 - by * c2) / d, (bx * c2 - cx * b2) / d
    return (a[0] + x, a[1] + y), x * x + y * y


def hull_of_cocircular(points):
    """The points of one circle, counter-clockwise from the lexicographically smallest."""
    start, *others = sorted(points)
    # From a point of the circle the others are seen within a half-turn: insertion by exact orientation.
    order = []
    for p in others:
        place = sum(cross(start, q, p) > 0 for q in order)
        order.insert(place, p)
    return [start, *order]


def delaunay_triangles(points):
    """Triangles as sets of coordinates: empty circles, each cocircular polygon a fan from its smallest vertex."""
    sites = sorted({(Fraction(x), Fraction(y)) for x, y in points})
    polygons = {}
    for a, b, c in combinations(sites, 3):
        if cross(a, b, c) == 0:
            continue
        centre, square = circle(a, b, c)
        distances = [(p[0] - centre[0]) ** 2 + (p[1] - centre[1]) ** 2 for p in sites]
        if min(distances) >= square:
            polygons[centre, square] = [p for p, d in zip(sites, distances, strict=True) if d == square]
    triangles = set()
    for polygon in polygons.values():
        start, *others = hull_of_cocircular(polygon)
        triangles |= {frozenset((start, p, q)) for p, q in pairwise(others)}
    return triangles
