"""Discs that points and open segments touch, in numbers of many digits.

The equations are solved by another way than the core's: planes and a cone in the space of (x, y, r).

How many digits are enough: let c = (x, y) / w be the center of a disc, r its radius, and d the distance of a site from
it. F = (d² - r²) w² L², L the site's length, is an algebraic integer. Its four conjugates at most are below 2^516, as
src/core/segment_voronoi/discs/exact_signs.cpp derives, and their product is an integer: F is 0 or at least 2^-1548.
As w² L² < 2^446, d² - r² is 0 or at least 2^-1994 > 10^-601. A disc's equations divide by a few numbers of that
kind, of which each may cost some 200 digits. So `SURE` digits settle what `FIRST` digits leave open, which is taken
to be anything below 10^-60: a tie, or the foot of a center at the end of a segment.
"""

import functools
import itertools
from contextlib import contextmanager
from dataclasses import dataclass
from decimal import Context, Decimal, getcontext, localcontext

import numpy as np

FIRST = (160, Decimal("1e-60"))
SURE = (1500, Decimal("1e-700"))
BEYOND = Decimal(2) ** 240
"""No disc is larger: a root beyond this is one at infinity."""
PARALLEL = Decimal("1e-100")
"""Determinants of three unit normals on the lattice, and sines of angles between planes, are 0 or above 2^-260."""


@contextmanager
def precision(digits):
    with localcontext(Context(prec=digits, Emin=-999999, Emax=999999)):
        yield


@dataclass(frozen=True)
class Site:
    """A point where a == b, else the open segment; integers."""

    a: tuple[int, int]
    b: tuple[int, int]

    @property
    def is_point(self):
        return self.a == self.b

    @property
    def along(self):
        return self.b[0] - self.a[0], self.b[1] - self.a[1]

    @property
    def ends(self):
        return {self.a, self.b}

    def height(self, p):
        """0 on the line, positive to its left."""
        return cross(self.along, (p[0] - self.a[0], p[1] - self.a[1]))

    def way_from(self, p):
        """From its end p into the segment."""
        u = self.along
        return u if p == self.a else (-u[0], -u[1])


@dataclass(frozen=True)
class Disc:
    x: Decimal
    y: Decimal
    r: Decimal


def cross(u, v):
    return u[0] * v[1] - u[1] * v[0]


def dot(u, v):
    return u[0] * v[0] + u[1] * v[1]


def sites_of(points, segments):
    """The sites by their numbers: the points, then the segments."""
    points = [tuple(map(int, p)) for p in np.asarray(points).reshape(-1, 2)]
    return [Site(p, p) for p in points] + [Site(points[i], points[j]) for i, j in np.asarray(segments).reshape(-1, 2)]


# ---- the circles tangent to three sites ----


def tangent_circles(sites):
    """Every circle through the points and tangent to the lines; some touch a line beyond its segment."""
    points = [s.a for s in sites if s.is_point]
    segments = [s for s in sites if not s.is_point]
    origin = points[0] if points else segments[0].a
    fixed = [bisector_plane(origin, q) for q in points[1:]]
    free = []
    for s in segments:
        shared = s.ends & set(points)
        if len(shared) == 2 or any(s.height(p) == 0 and p not in shared for p in points):
            return []  # a circle through a point of the line touches the line there, which is not on the segment
        if shared:
            fixed.append(plane_across(origin, s, *shared))
        else:
            free.append(line_planes(origin, s))
    found = []
    for planes in itertools.product(*free):
        rows = fixed + list(planes)
        found += three_planes(rows) if len(rows) == 3 else planes_and_cone(*rows)
    return [Disc(origin[0] + x, origin[1] + y, r) for x, y, r in found if 0 <= r < BEYOND]


def bisector_plane(origin, q):
    x, y = q[0] - origin[0], q[1] - origin[1]
    return Decimal(2 * x), Decimal(2 * y), Decimal(0), Decimal(x * x + y * y)


def plane_across(origin, segment, end):
    """A circle that touches the segment at its end has its center across it."""
    u = segment.along
    return Decimal(u[0]), Decimal(u[1]), Decimal(0), Decimal(dot(u, (end[0] - origin[0], end[1] - origin[1])))


def line_planes(origin, segment):
    """n c - r = n a for both unit normals."""
    length = root_of(dot(segment.along, segment.along))
    offset = segment.height(origin) / -length
    nx, ny = -segment.along[1] / length, segment.along[0] / length
    one = Decimal(1)
    return (nx, ny, -one, offset), (-nx, -ny, -one, -offset)


def root_of(value):
    return _root(value, getcontext().prec)


@functools.lru_cache(maxsize=1024)
def _root(value, _digits):
    return Decimal(value).sqrt()


def cross3(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot3(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def three_planes(rows):
    p, q, s = rows
    products = cross3(q, s), cross3(s, p), cross3(p, q)
    determinant = dot3(p, products[0])
    if abs(determinant) < PARALLEL:
        return []
    return [tuple(sum(row[3] * v[k] for row, v in zip(rows, products, strict=True)) / determinant for k in range(3))]


def planes_and_cone(p, q):
    """The line in which two planes meet, and x² + y² = r²."""
    way = cross3(p, q)
    size = dot3(way, way)
    if size <= dot3(p, p) * dot3(q, q) * PARALLEL:
        return []
    start = [(p[3] * a + q[3] * b) / size for a, b in zip(cross3(q, way), cross3(way, p), strict=True)]
    a = way[0] ** 2 + way[1] ** 2 - way[2] ** 2
    b = way[0] * start[0] + way[1] * start[1] - way[2] * start[2]
    c = start[0] ** 2 + start[1] ** 2 - start[2] ** 2
    return [tuple(s + t * w for s, w in zip(start, way, strict=True)) for t in quadratic_roots(a, b, c)]


def quadratic_roots(a, b, c):
    """a t² + 2 b t + c = 0, without cancellation."""
    discriminant = b * b - a * c
    if discriminant < 0:
        return []
    q = -b - discriminant.sqrt() if b > 0 else discriminant.sqrt() - b
    if q == 0:
        return [Decimal(0)]
    return [c / q, q / a] if a else [c / q]


# ---- signs, certain at the second attempt ----


class UndecidedError(Exception):
    """A number too near to 0 for the digits in use."""


def sign(value, tie, sure):
    if abs(value) > tie:
        return 1 if value > 0 else -1
    if not sure:
        raise UndecidedError
    return 0


def foot(disc, segment):
    """Where along the segment: 0 to its squared length."""
    return dot(segment.along, (disc.x - segment.a[0], disc.y - segment.a[1]))


def clearance(disc, site):
    """The squared distance of the closed site from the center, less that of the radius."""
    x, y = disc.x - site.a[0], disc.y - site.a[1]
    if not site.is_point:
        u = site.along
        t = foot(disc, site)
        if t >= dot(u, u):
            x, y = disc.x - site.b[0], disc.y - site.b[1]
        elif t > 0:
            return cross(u, (x, y)) ** 2 / dot(u, u) - disc.r * disc.r
    return x * x + y * y - disc.r * disc.r


def touches(disc, site, tie, sure):
    """At the point, or at a foot on the closed segment."""
    return (site.is_point or foot_within(disc, site, tie, sure)) and sign(clearance(disc, site), tie, sure) == 0


def foot_within(disc, segment, tie, sure):
    t = foot(disc, segment)
    return sign(t, tie, sure) >= 0 and sign(t - dot(segment.along, segment.along), tie, sure) <= 0


def certain(decide):
    """decide(tie, sure) with few digits, and with enough where that leaves a sign open."""
    for (digits, tie), sure in ((FIRST, False), (SURE, True)):
        with precision(digits):
            try:
                return decide(tie, sure)
            except UndecidedError:
                pass
    raise AssertionError("unreachable")


# ---- contacts around a disc ----


def contact_keys(disc, site, tie, sure):
    """Sorting keys of contacts, counter-clockwise: direction from the center, then the way the segment goes on."""
    if site.is_point:
        return (site.a[0] - disc.x, site.a[1] - disc.y), 0
    u = site.along
    s = dot(u, u)
    t = foot(disc, site)
    direction = site.a[0] + u[0] * t / s - disc.x, site.a[1] + u[1] * t / s - disc.y
    at_a, at_b = sign(t, tie, sure) == 0, sign(t - s, tie, sure) == 0
    if not at_a and not at_b:
        return direction, 0
    turn = sign(cross(direction, u), tie, sure)
    return direction, turn if at_a else -turn


def counter_clockwise(disc, touching, tie, sure):
    """The sites (number, site) sorted by their contacts with a disc of positive radius."""
    keys = {k: contact_keys(disc, s, tie, sure) for k, s in touching}

    def compare(i, j):
        (d, d_tie), (e, e_tie) = keys[i], keys[j]
        d_half, e_half = half_plane(d, tie, sure), half_plane(e, tie, sure)
        if d_half != e_half:
            return d_half - e_half
        return -sign(cross(d, e), tie, sure) or d_tie - e_tie

    return sorted(keys, key=functools.cmp_to_key(compare))


def half_plane(d, tie, sure):
    y = sign(d[1], tie, sure)
    return 0 if y > 0 or (y == 0 and d[0] > 0) else 1
