"""Radii of alpha shapes in space by their definition: by empty balls through the corners of a simplex, in fractions."""

from fractions import Fraction
from itertools import combinations
from math import inf


def exact(points):
    """Points as fractions."""
    return [tuple(Fraction(x) for x in p) for p in points]


def minus(p, q):
    return tuple(x - y for x, y in zip(p, q, strict=True))


def dot(p, q):
    return sum((x * y for x, y in zip(p, q, strict=True)), Fraction(0))


def cross(p, q):
    return tuple(p[i - 2] * q[i - 1] - p[i - 1] * q[i - 2] for i in range(3))


def solved(rows, right):
    """The solution of linear equations, by Cramer's rule; None where there is not one."""
    a, b, c = rows
    determinant = dot(a, cross(b, c))
    if not determinant:
        return None
    parts = [cross(b, c), cross(c, a), cross(a, b)]
    return tuple(sum(r * part[i] for r, part in zip(right, parts, strict=True)) / determinant for i in range(3))


def radii_of_tetrahedron(points, corners):
    """The squared radius three times, or None where the sphere is not empty."""
    a, *others = (points[k] for k in corners)
    ways = [minus(p, a) for p in others]
    center = solved(ways, [dot(w, w) / 2 for w in ways])
    square = dot(center, center)
    is_empty = all(dot(w := minus(minus(p, a), center), w) >= square for p in points)
    return (square,) * 3 if is_empty else None


def radii_of_triangle(points, corners):
    """Least squared radius of empty balls through the corners, and those of the outermost, in order; None without any.

    Their centers lie on a line: at the center of the triangle plus s times its normal.
    """
    a, b, c = (points[k] for k in corners)
    u, v = minus(b, a), minus(c, a)
    normal = cross(u, v)
    center = solved([u, v, normal], [dot(u, u) / 2, dot(v, v) / 2, Fraction(0)])
    square, step = dot(center, center), dot(normal, normal)
    low, high = -inf, inf
    for p in points:
        way = minus(p, a)
        power, slope = dot(way, way) - 2 * dot(way, center), 2 * dot(way, normal)  # the power is at least s times slope
        if slope > 0:
            high = min(high, power / slope)
        elif slope < 0:
            low = max(low, power / slope)
        elif power < 0:
            return None
    if low > high:
        return None
    ends = sorted(inf if abs(s) == inf else square + s * s * step for s in (low, high))
    return (square if low <= 0 <= high else ends[0], *ends)


def radii_of_edge(points, corners):
    """The same of an edge: centers lie in a polygon halfway between its ends, perhaps without end."""
    a, b = (points[k] for k in corners)
    d = minus(b, a)
    quarter, middle = dot(d, d) / 4, tuple(x / 2 for x in d)
    axis = next(e for e in ((1, 0, 0), (0, 1, 0)) if any(cross(d, e)))
    u = cross(d, axis)
    v = cross(d, u)
    # a center is middle + s u + t v; each point p keeps it to p.x s + p.y t <= p.w
    planes = []
    for p in points:
        way = minus(p, a)
        planes.append((2 * dot(way, u), 2 * dot(way, v), dot(way, way) - 2 * dot(way, middle)))

    def holds(s, t):
        return all(x * s + y * t <= w for x, y, w in planes)

    def square(s, t):
        return quarter + s * s * dot(u, u) + t * t * dot(v, v)

    corners_of_polygon = []
    for (x, y, w), (x2, y2, w2) in combinations(planes, 2):
        determinant = x * y2 - y * x2
        if determinant:
            place = (w * y2 - y * w2) / determinant, (x * w2 - w * x2) / determinant
            if holds(*place):
                corners_of_polygon.append(square(*place))
    nearest = list(corners_of_polygon)
    if holds(0, 0):
        nearest.append(quarter)
    for x, y, w in planes:  # the place of a side that is nearest to the middle of the edge
        size = x * x / dot(u, u) + y * y / dot(v, v)
        if size and holds(*(place := (x / dot(u, u) * w / size, y / dot(v, v) * w / size))):
            nearest.append(square(*place))
    if not nearest:
        return None
    is_open = not corners_of_polygon or _has_ray(planes, holds)
    return min(nearest), min(corners_of_polygon, default=inf), inf if is_open else max(corners_of_polygon)


def _has_ray(planes, holds):
    """Whether a polygon with corners goes on without end: along one of its sides, then."""
    for x, y, _ in planes:
        for s, t in ((-y, x), (y, -x)):
            if (s or t) and all(p * s + q * t <= 0 for p, q, _ in planes):
                return True
    return False


RADII = {2: radii_of_edge, 3: radii_of_triangle, 4: radii_of_tetrahedron}


def radii(points, simplices):
    """Least, middle and greatest squared radii of rows of corners."""
    places = exact(points)
    return [RADII[len(row)](places, row) for row in simplices]
