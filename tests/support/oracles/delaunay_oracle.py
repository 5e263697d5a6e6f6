"""Delaunay triangulations from the definition, in rational numbers. It shares no code with the package."""

from fractions import Fraction
from itertools import combinations, pairwise

from support.oracles.whole_numbers import in_units


def cross(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def circle(a, b, c):
    """Center and squared radius."""
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


def on_empty_circle(a, b, c, sites):
    """The sites on the circle through three of them, whose coordinates are integers; None if one is inside."""
    bx, by, cx, cy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    d, b2, c2 = 2 * (bx * cy - by * cx), bx * bx + by * by, cx * cx + cy * cy
    x, y = cy * b2 - by * c2, bx * c2 - cx * b2  # the center is (x / d, y / d) from a
    square, on_circle = x * x + y * y, []
    for p in sites:
        distance = ((p[0] - a[0]) * d - x) ** 2 + ((p[1] - a[1]) * d - y) ** 2
        if distance < square:
            return None
        if distance == square:
            on_circle.append(p)
    return tuple(on_circle)


def delaunay_triangles(points):
    """Triangles as sets of coordinates: empty circles, each cocircular polygon a fan from its smallest vertex."""
    places, scale = in_units(points)
    sites = sorted(set(places))
    polygons = {on_empty_circle(a, b, c, sites) for a, b, c in combinations(sites, 3) if cross(a, b, c) != 0} - {None}
    triangles = set()
    for polygon in polygons:
        start, *others = hull_of_cocircular(polygon)
        triangles |= {frozenset((start, p, q)) for p, q in pairwise(others)}
    exact = {site: (Fraction(site[0], scale), Fraction(site[1], scale)) for site in sites}
    return {frozenset(exact[site] for site in triangle) for triangle in triangles}
