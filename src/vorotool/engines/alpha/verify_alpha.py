"""A check of alpha shapes that knows the definition only, not how they were made."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.delaunay.delaunay import verify_triangulation
from vorotool.errors import VerificationError
from vorotool.numeric.arrays import Booleans, Floats, connected_roots, dots, owners
from vorotool.numeric.numbers import distinct
from vorotool.numeric.parallel import Progress
from vorotool.types.alpha.complex import CLASSES, AlphaComplex
from vorotool.types.alpha.radii import Radius
from vorotool.types.alpha.shape import AlphaShape
from vorotool.types.alpha.space import SpaceAlphaComplex, SpaceAlphaShape, cross
from vorotool.types.arguments import check_value

_ROUNDING = 2.0**-46
"""Relative error of a sum or product of a few numbers, times the sum of the sizes of its terms."""
_SMALL, _LARGE = 2.0**-60, 2.0**60
"""Edges between them have products that are far from the smallest and largest doubles."""
_CORNERS = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
_PAIRS = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])


def verify_space_shape(shape: SpaceAlphaShape, *, threads: int = 0, progress: Progress = None) -> None:
    """Check an alpha shape exactly, from its triangulation."""
    family = shape.family
    verify_triangulation(family.mesh, threads=threads, progress=progress)
    triangles, of_tetrahedra = _triangles(family)
    edges, of_triangles = _edges(family, triangles)
    tetrahedra = at_most(family.points, family.tetrahedra, shape.r)
    check_inside("tetrahedron", shape.inside, tetrahedra)
    around = np.zeros((len(triangles), 2), dtype=np.int64)  # tetrahedra in the shape, and all
    np.add.at(around, of_tetrahedra, np.stack([np.repeat(tetrahedra, 4), np.ones(4 * len(tetrahedra), bool)], axis=1))
    held = (around[:, 0] > 0) | (
        ~cut_balls(
            family.points,
            triangles[of_tetrahedra],
            family.tetrahedra.reshape(-1),
            len(triangles),
            of_tetrahedra,
            _is_in_ball,
        )
        & at_most(family.points, triangles, shape.r)
    )
    bounds = np.where(around[:, 0] == 0, held, np.where(around.min(axis=1) < 2, 2, 3))
    _check_classes(shape.triangle_classes, family.triangles, triangles, bounds, "triangle")
    edge_held = np.zeros(len(edges), dtype=bool)
    edge_held[of_triangles[np.repeat(held, 3)]] = True
    edge_held |= ~cut_balls(
        family.points, edges[of_triangles], triangles.reshape(-1), len(edges), of_triangles, is_in_diametral_ball
    ) & at_most(family.points, edges, shape.r)
    _check_edges_in_space(shape, edges, edge_held, tetrahedra)
    t, k = np.nonzero(family.mesh.neighbors >= 0)
    neighbors = family.mesh.neighbors[t, k]
    check_regions(shape, t, neighbors, "tetrahedra", f"{shape.region_count} are numbered")
    check_surface(shape)


def check_inside(name: str, given: Booleans, expected: Booleans) -> None:
    """Compare which simplices are in a shape with those whose circumradius is at most r."""
    wrong = np.flatnonzero(given != expected)
    if wrong.size:
        words = "in the shape, but its circumradius is greater than r"
        if not given[wrong[0]]:
            words = "not in the shape, but its circumradius is at most r"
        raise VerificationError(f"{name} {wrong[0]} is {words}")


def _unique(rows: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.intp]]:
    """Distinct rows of corners in any order, each sorted, and which of them each row is."""
    found, place = np.unique(np.sort(rows, axis=1), axis=0, return_inverse=True)
    return found, place.reshape(-1)


def _triangles(family: SpaceAlphaComplex) -> tuple[NDArray[np.int32], NDArray[np.intp]]:
    """All triangles, sorted, and which of them the faces of the tetrahedra are."""
    if not len(family.tetrahedra):
        return _unique(family.mesh.planar)[0], np.empty(0, dtype=np.intp)
    return _unique(family.tetrahedra[:, _CORNERS].reshape(-1, 3))


def _edges(family: SpaceAlphaComplex, triangles: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.intp]]:
    """All edges, sorted, and which of them the sides of the triangles are."""
    if not len(triangles):
        return _unique(family.mesh.edges)[0], np.empty(0, dtype=np.intp)
    return _unique(triangles[:, [[1, 2], [0, 2], [0, 1]]].reshape(-1, 2))


# ---- exact comparisons ---------------------------------------------------------------------------
def at_most(points: Floats, corners: NDArray[np.int32], r: Radius) -> Booleans:
    """(k,) whether the radius of each edge, triangle or tetrahedron is at most r."""
    if r == inf:
        return np.ones(len(corners), dtype=bool)
    limit = Fraction(r) ** 2
    rounded = float(limit) if limit < Fraction(2) ** 1000 else inf
    result = np.zeros(len(corners), dtype=bool)
    for begin in range(0, len(corners), 1 << 16):
        rows = corners[begin : begin + (1 << 16)]
        square, doubt = _squares(points[rows])
        with np.errstate(all="ignore"):
            clear = (doubt < 1) & (np.abs(square - rounded) > (doubt + _ROUNDING) * (square + rounded))
        part = square < rounded
        for k in np.flatnonzero(~clear).tolist():
            part[k] = _squared_radius(points[rows[k]].tolist()) <= limit
        result[begin : begin + len(rows)] = part
    return result


def _squares(places: Floats) -> tuple[Floats, Floats]:
    """Squares of radii, and bounds of their relative errors, from the lengths of edges and a volume or an area.

    16 times the square of the determinant of a tetrahedron, times that of the radius, is 2 PQ + 2 QR + 2 RP - P² - Q² -
    R², where P, Q and R are the products of the squares of opposite edges (A. Crelle 1821).
    """
    a, *others = np.moveaxis(places, 0, 2)
    ways = [other - a for other in others]
    with np.errstate(all="ignore"):
        sizes = np.stack([_dot(way, way) for way in ways])
        known = (sizes.min(axis=0) > _SMALL**2) & (sizes.max(axis=0) < _LARGE**2)
        if len(ways) == 1:
            return sizes[0] / 4, np.where(known, _ROUNDING, inf)
        b, c = ways[:2]
        third = _dot(c - b, c - b)
        if len(ways) == 2:
            square, terms = _square_of_cross(b, c)
            return sizes[0] * sizes[1] * third / (4 * square), np.where(known, _ROUNDING * (4 + terms / square), inf)
        d = ways[2]
        p, q, r = sizes * np.stack([_dot(d - c, d - c), _dot(d - b, d - b), third])
        value, squares = 2 * (p * q + q * r + r * p), p * p + q * q + r * r
        determinant = _dot(b, cross(c, d))
        terms = _dot(np.abs(b), np.stack([np.abs(c[i - 2] * d[i - 1]) + np.abs(c[i - 1] * d[i - 2]) for i in range(3)]))
        spread = (value + squares) / (value - squares) + terms / np.abs(determinant)
        is_doubted = ~(known & (terms > _SMALL**3) & (value > squares))
        return (value - squares) / (16 * determinant * determinant), np.where(is_doubted, inf, _ROUNDING * (4 + spread))


def _dot(p: Floats, q: Floats) -> Floats:
    """Scalar products of (3, n) vectors."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def _square_of_cross(b: Floats, c: Floats) -> tuple[Floats, Floats]:
    """The square of the cross product of (3, n) vectors, and that of what its terms are, all with the same sign."""
    normal = cross(b, c)
    terms = np.stack([np.abs(b[i - 2] * c[i - 1]) + np.abs(b[i - 1] * c[i - 2]) for i in range(3)])
    return _dot(normal, normal), _dot(terms, terms)


def _squared_radius(places: list[list[float]]) -> Fraction:
    """The same exactly."""
    a, *others = ([Fraction(x) for x in place] for place in places)
    ways = [_minus(other, a) for other in others]
    sizes = [_product(way, way) for way in ways]
    if len(ways) == 1:
        return sizes[0] / 4
    b, c = ways[:2]
    third = _minus(c, b)
    if len(ways) == 2:
        return sizes[0] * sizes[1] * _product(third, third) / (4 * (sizes[0] * sizes[1] - _product(b, c) ** 2))
    d = ways[2]
    opposite = [_minus(d, c), _minus(d, b), third]
    p, q, r = (size * _product(way, way) for size, way in zip(sizes, opposite, strict=True))
    normal = [c[i - 2] * d[i - 1] - c[i - 1] * d[i - 2] for i in range(3)]
    return (2 * (p * q + q * r + r * p) - p * p - q * q - r * r) / (16 * _product(b, normal) ** 2)


def _minus(p: list[Fraction], q: list[Fraction]) -> list[Fraction]:
    return [x - y for x, y in zip(p, q, strict=True)]


def cut_balls(
    points: Floats,
    corners: NDArray[np.int32],
    apexes: NDArray[np.int32],
    count: int,
    owner: NDArray[np.intp],
    is_inside: Callable[[list[list[float]]], bool],
) -> Booleans:
    """(count,) whether any apex is strictly inside the smallest ball through the corners that it is opposite to."""
    cut = np.zeros(count, dtype=bool)
    for begin in range(0, len(corners), 1 << 16):
        rows, tops = corners[begin : begin + (1 << 16)], apexes[begin : begin + (1 << 16)]
        places = np.concatenate([points[rows], points[tops][:, None]], axis=1)
        power, doubt = _powers(places)
        inside = power < 0
        for k in np.flatnonzero(~(np.abs(power) > doubt)).tolist():
            inside[k] = is_inside(places[k].tolist())
        cut[owner[begin : begin + len(rows)][inside]] = True
    return cut


def _powers(places: Floats) -> tuple[Floats, Floats]:
    """Of the last place its power with respect to the smallest sphere through the others, and a bound of the error.

    It is (p - a) (p - a) less 2 (p - a) (c - a), for a center c as in `_squares`.
    """
    ways = places[:, 1:-1] - places[:, :1]
    top = places[:, -1] - places[:, 0]
    with np.errstate(all="ignore"):
        sizes = dots(ways, ways)
        if ways.shape[1] == 1:
            center, spread = ways[:, 0] / 2, 1.0
        else:
            u, v = ways[:, 0], ways[:, 1]
            uu, vv, uv = sizes[:, 0], sizes[:, 1], dots(u, v)
            gram = uu * vv - uv * uv
            x, y = vv * (uu - uv) / (2 * gram), uu * (vv - uv) / (2 * gram)
            center = x[:, None] * u + y[:, None] * v
            spread = (uu * vv / gram) ** 2
        power = dots(top, top - 2 * center)
        reach = np.maximum(sizes.max(axis=1), dots(top, top))
        doubt = 2.0**-44 * spread * reach
        known = (np.abs(ways).max(axis=2).min(axis=1) > _SMALL) & (reach < _LARGE**2) & np.isfinite(doubt)
    return power, np.where(known, doubt, inf)


def is_in_diametral_ball(places: list[list[float]]) -> bool:
    """Tell exactly whether the third place is strictly inside the ball on the first two as diameter."""
    a, b, p = ([Fraction(x) for x in place] for place in places)
    return sum((x - z) * (y - z) for x, y, z in zip(a, b, p, strict=True)) < 0


def _is_in_ball(places: list[list[float]]) -> bool:
    a, *others = ([Fraction(x) for x in place] for place in places)
    u, v, w = ([x - y for x, y in zip(other, a, strict=True)] for other in others)
    uu, vv, uv, ww = _product(u, u), _product(v, v), _product(u, v), _product(w, w)
    twice = 2 * (uu * vv - uv * uv)
    x, y = vv * (uu - uv) / twice, uu * (vv - uv) / twice
    return ww < 2 * (x * _product(u, w) + y * _product(v, w))


def _product(p: list[Fraction], q: list[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(p, q, strict=True)), Fraction(0))


# ---- what the shape says -------------------------------------------------------------------------
def _check_classes(
    given: NDArray[np.uint8], own: NDArray[np.int32], rows: NDArray[np.int32], expected: NDArray[np.intp], name: str
) -> None:
    """Compare classes of simplices in one order with those that are expected in another."""
    ordered = np.lexsort(np.sort(own, axis=1).T[::-1])
    if not np.array_equal(np.sort(own, axis=1)[ordered], rows):
        raise VerificationError(f"the {name}s are not those of the triangulation")
    wrong = np.flatnonzero(given[ordered] != expected)
    if wrong.size:
        k = int(wrong[0])
        is_, should = CLASSES[given[ordered[k]]], CLASSES[int(expected[k])]
        raise VerificationError(f"{name} {int(ordered[k])} is {is_}, but should be {should}")


def _check_edges_in_space(
    shape: SpaceAlphaShape, edges: NDArray[np.int32], held: Booleans, tetrahedra: Booleans
) -> None:
    """Edges by the tetrahedra around them: all of them in the shape, some, or none; the hull is never inside."""
    family = shape.family
    sides = np.sort(family.tetrahedra[:, _PAIRS].reshape(-1, 2), axis=1)
    place = _find(edges, sides)
    inside = np.bincount(place, np.repeat(tetrahedra, 6), len(edges))
    all_ = np.bincount(place, minlength=len(edges))
    on_hull = np.zeros(len(edges), dtype=bool)
    t, k = np.nonzero(family.mesh.neighbors < 0)
    faces = np.sort(family.tetrahedra[t[:, None], _CORNERS[k]], axis=1)
    for pair in ([0, 1], [0, 2], [1, 2]):
        on_hull[_find(edges, faces[:, pair])] = True
    expected = np.where(inside == 0, held.astype(np.intp), np.where((inside < all_) | on_hull, 2, 3))
    _check_classes(shape.edge_classes, family.edges, edges, expected, "edge")


def _find(edges: NDArray[np.int32], pairs: NDArray[np.int32]) -> NDArray[np.intp]:
    keys, wanted = ((rows[:, 0].astype(np.int64) << 32) | rows[:, 1] for rows in (edges, pairs))
    return np.searchsorted(keys, wanted)


def check_regions(shape: Any, t: NDArray[np.integer], u: NDArray[np.integer], kind: str, told: str) -> None:
    """Regions of a shape are joined as its simplices t and u are, and joined to nothing else."""
    inside, region = shape.inside, shape.region
    both = inside[t] & inside[u]
    pairs = np.stack([t[both], u[both]], axis=1)
    if (region[pairs[:, 0]] != region[pairs[:, 1]]).any():
        raise VerificationError(f"neighboring {kind} in the shape have different regions")
    connected = len(distinct(connected_roots(pairs, len(region))[inside]))
    if connected != shape.region_count or len(distinct(region[inside])) != connected:
        raise VerificationError(f"the {kind} form {connected} regions, but {told}")


def check_surface(shape: SpaceAlphaShape) -> None:
    """A closed surface: along each edge as many triangles go one way as the other; around the volume, outwards."""
    surface = shape.surface
    ends = np.concatenate([surface[:, [0, 1]], surface[:, [1, 2]], surface[:, [2, 0]]]).astype(np.int64)
    forward, backward = np.sort(ends[:, 0] << 32 | ends[:, 1]), np.sort(ends[:, 1] << 32 | ends[:, 0])
    if not np.array_equal(forward, backward):
        raise VerificationError("the surface is not closed")
    inside = np.concatenate([_faces_outwards(shape), np.empty((0, 3), np.int32)])
    if sorted(map(_turned, inside.tolist())) != sorted(map(_turned, surface.tolist())):
        raise VerificationError("the surface is not that of the tetrahedra, seen from outside")


def _faces_outwards(shape: SpaceAlphaShape) -> NDArray[np.int32]:
    """The faces of tetrahedra of the shape that have none of it beyond, counter-clockwise as seen from outside."""
    corners, neighbors = shape.family.tetrahedra, shape.family.mesh.neighbors
    t, k = np.nonzero(shape.inside[:, None] & ~np.append(shape.inside, False)[neighbors])
    faces = corners[t[:, None], _CORNERS[k]]
    turned = np.isin(k, (1, 3))  # positive tetrahedra: 123, 032, 013 and 021 are counter-clockwise
    return np.where(turned[:, None], faces[:, [0, 2, 1]], faces)


def _turned(corners: list[int]) -> tuple[int, ...]:
    """The same triangle from its smallest corner on."""
    first = corners.index(min(corners))
    return (*corners[first:], *corners[:first])


def verify_alpha_shape(shape: AlphaShape | SpaceAlphaShape, *, threads: int = 0, progress: Progress = None) -> None:
    """Check an alpha shape exactly from its triangulation.

    The checks: the triangulation; each circumradius against r, unless small holes or regions were changed; for each
    edge the Gabriel property, half its length against r, and so its class; regions and polygon rings. In space the
    same of tetrahedra, triangles and edges, and that the surface is closed.

    Parameters
    ----------
    shape : AlphaShape or SpaceAlphaShape
        A shape by the corrected rule.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from vorotool import alpha_shape
    >>> shape = alpha_shape([[0, 0], [4, 0], [0, 3]], r=2.5)
    >>> verify_alpha_shape(shape)
    >>> verify_alpha_shape(replace(shape, r=2.4))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: triangle 0 is in the shape, but its circumradius is greater than r
    """
    check_value(shape, "shape", "AlphaShape", "SpaceAlphaShape")
    if not isinstance(shape, AlphaShape):
        verify_space_shape(shape, threads=threads, progress=progress)
        return
    family = shape.family
    verify_triangulation(family.mesh, threads=threads, progress=progress)
    _check_sides(family)
    points = np.pad(family.points, ((0, 0), (0, 1)))  # in space, as radii are measured there
    reached = at_most(points, family.mesh.triangles, shape.r)
    if not shape.has_thresholds:
        check_inside("triangle", shape.inside, reached)
    _check_edges(shape, _expected_classes(shape, points, reached))
    t, u = family.sides[(family.sides >= 0).all(axis=1)].T
    check_regions(shape, t, u, "triangles", f"{shape.region_count} polygons")
    _check_rings(shape)


def _fail(found: NDArray[np.bool_], words: str) -> None:
    if found.any():
        raise VerificationError(words.format(int(np.argmax(found))))


def _check_sides(family: AlphaComplex) -> None:
    """Every edge of the triangulation once, with the triangles that have it."""
    mesh = family.mesh
    if len(family.edges) != len(mesh.edges) or set(map(tuple, family.edges.tolist())) != set(
        map(tuple, mesh.edges.tolist())
    ):
        raise VerificationError("the edges are not those of the triangulation")
    around = np.append(mesh.triangles, [[-1, -1, -1]], axis=0)[family.sides]  # (e, 2, 3)
    ends = (around[:, :, :, None] == family.edges[:, None, None, :]).any(axis=2).all(axis=2)
    _fail((~ends & (family.sides >= 0)).any(axis=1), "edge {} is not a side of a triangle that it names")
    count = np.bincount(family.sides[family.sides >= 0], minlength=len(mesh.triangles))
    _fail(count != 3, "triangle {} does not have three edges")


def _expected_classes(shape: AlphaShape, points: Floats, reached: Booleans) -> NDArray[np.intp]:
    """(e,) by the triangles of the shape; without any, an edge is singular from half its length on."""
    family = shape.family
    count = np.append(shape.inside, False)[family.sides].sum(axis=1)
    at_first = np.append(reached, False)[family.sides].sum(axis=1)  # a dropped region leaves no edges
    edge, side = np.nonzero(family.sides >= 0)
    corners, ends = family.mesh.triangles[family.sides[edge, side]], family.edges[edge]
    apexes = corners[(corners != ends[:, :1]) & (corners != ends[:, 1:])]
    alone = ~cut_balls(points, ends, apexes, len(family), edge, is_in_diametral_ball)
    alone &= at_most(points, family.edges, shape.r) & (at_first == 0)
    return np.where(count == 0, alone.astype(np.intp), count + 1)


def _check_edges(shape: AlphaShape, expected: NDArray[np.intp]) -> None:
    classes = shape.edge_classes
    wrong = np.flatnonzero(classes != expected)
    if wrong.size:
        edge = int(wrong[0])
        raise VerificationError(f"edge {edge} is {CLASSES[classes[edge]]}, but should be {CLASSES[expected[edge]]}")
    listed = np.flatnonzero((classes == 1) | (classes == 2))
    if not np.array_equal(listed, shape.edge_index):
        raise VerificationError("the edges listed are not the singular and boundary ones, in order")


def _check_rings(shape: AlphaShape) -> None:
    """Each boundary edge once in the rings, with its region on the left; one shell a region; areas that go together."""
    polygons, family = shape.polygons, shape.family
    ring = owners(np.diff(polygons.ring_starts))
    ends = polygons.xy[polygons.following]
    sides = np.concatenate([polygons.xy, ends, polygons.ring_polygon[ring][:, None]], axis=1)
    across = np.append(shape.region, np.int32(-1))[family.mesh.neighbors]
    t, k = np.nonzero(shape.inside[:, None] & (across < 0))
    corners = family.mesh.triangles
    a, b = family.points[corners[t, (k + 1) % 3]], family.points[corners[t, (k + 2) % 3]]
    expected = np.concatenate([a, b, shape.region[t][:, None]], axis=1)
    if len(sides) != len(expected) or not np.array_equal(_sorted_rows(sides), _sorted_rows(expected)):
        raise VerificationError("the rings of the polygons are not the boundary of the regions")
    places = np.concatenate([polygons.xy, ring[:, None]], axis=1)
    if len(np.unique(places, axis=0)) != len(places):
        raise VerificationError("a ring visits a point twice")
    shells = np.bincount(polygons.ring_polygon[polygons.ring_kind == 0], minlength=len(polygons))
    _fail(shells != 1, "polygon {} does not have exactly one shell")


def _sorted_rows(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    return rows[np.lexsort(rows.T)]
