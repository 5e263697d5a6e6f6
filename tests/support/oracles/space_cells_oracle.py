"""Voronoi cells in a box by brute force, in integers."""

from fractions import Fraction
from itertools import combinations
from math import lcm

from support.oracles.space_alpha_oracle import cross, dot

SIDES = 6


def det(a, b, c):
    return dot(a, cross(b, c))


def _meeting(planes):
    """Where three planes n v = d meet, or None: homogeneous, w > 0."""
    normals, d = [n for n, _ in planes], [d for _, d in planes]
    w = det(*normals)
    if w == 0:
        return None
    columns = list(zip(*normals, strict=True))
    v = []
    for axis in range(3):
        replaced = [d if k == axis else columns[k] for k in range(3)]
        v.append(det(*zip(*replaced, strict=True)))
    return (*(x if w > 0 else -x for x in v), abs(w))


def _spans(places, dimension):
    """Whether exact places span a line, a plane or space."""
    ways = [[x - y for x, y in zip(p, places[0], strict=True)] for p in places[1:]]
    if dimension == 3:
        return any(det(*three) for three in combinations(ways, 3))
    return any(any(u[i] * v[j] - u[j] * v[i] for i, j in ((0, 1), (1, 2), (0, 2))) for u, v in combinations(ways, 2))


def _cell(site, others, box):
    """The faces of a cell: exact places by label."""
    planes = {}
    for side in range(SIDES):
        axis, is_high = divmod(side, 2)
        unit = 1 if is_high else -1
        normal = tuple(unit if k == axis else 0 for k in range(3))
        planes[-1 - side] = (normal, unit * box[axis + 3 * is_high])
    for label, other in others:
        normal = tuple(2 * (x - y) for x, y in zip(other, site, strict=True))
        planes[label] = (normal, sum(x * x for x in other) - sum(y * y for y in site))
    places = set()
    for three in combinations(planes.values(), 3):
        met = _meeting(three)
        if met is None:
            continue
        *v, w = met
        if all(sum(n * x for n, x in zip(normal, v, strict=True)) <= d * w for normal, d in planes.values()):
            places.add(tuple(Fraction(x, w) for x in v))
    places = sorted(places)
    if len(places) < 4 or not _spans(places, 3):
        return {}
    faces = {}
    for label, (normal, d) in planes.items():
        on = [v for v in places if sum(n * x for n, x in zip(normal, v, strict=True)) == d]
        if len(on) >= 3 and _spans(on, 2) and frozenset(on) not in faces.values():
            faces[label] = frozenset(on)  # sides come first: a bisector in one has no face
    return faces


def cells_of(points, box):
    """For each point the exact places of each face: by the index of the point across, or -1 - side."""
    values = [[Fraction(x) for x in p] for p in (*points, box)]
    step = lcm(*(x.denominator for row in values for x in row))
    *sites, box = ([int(x * step) for x in row] for row in values)
    first = {}
    for index, site in enumerate(sites):
        first.setdefault(tuple(site), index)
    result = []
    for index, site in enumerate(sites):
        others = [(other, place) for place, other in first.items() if other != index]
        faces = _cell(site, others, box) if first[tuple(site)] == index else {}
        result.append({k: frozenset(tuple(x / step for x in v) for v in face) for k, face in faces.items()})
    return result
