"""A check of alpha shapes that knows the definition only, not how they were made."""

from __future__ import annotations

from fractions import Fraction
from math import inf
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.delaunay.delaunay import verify_triangulation
from vorotool.errors import VerificationError
from vorotool.numeric.arrays import dots, owners
from vorotool.numeric.numbers import distinct
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.types.alpha.complex import CLASSES, AlphaComplex
from vorotool.types.alpha.radii import Radius
from vorotool.types.alpha.shape import AlphaShape
from vorotool.types.arguments import check_value
from vorotool.types.mesh.triangulation import Triangulation

if TYPE_CHECKING:
    from vorotool.types.alpha.space import SpaceAlphaShape

# Relative error of a squared radius in floating point: a few roundings, and those of the cross product many times as
# much where it cancels. What is closer to r than this is decided in rational numbers.
_ROUNDING = 2.0**-48

_SMALL = 2.0**-900
"""Far above what loses digits because it is near the smallest number."""


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
        resolved("engines.alpha.verify_space:verify_space_shape")(shape, threads=threads, progress=progress)
        return
    family = shape.family
    verify_triangulation(family.mesh, threads=threads, progress=progress)
    _check_sides(family)
    reached = _triangles_reached(family.mesh, shape.r)
    if not shape.has_thresholds:
        _check_triangles(shape, reached)
    _check_edges(shape, _expected_classes(shape, reached))
    _check_regions(shape)
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


def _triangles_reached(mesh: Triangulation, r: Radius) -> NDArray[np.bool_]:
    """(t,) whether each circumradius is at most r."""
    corners = mesh.points[mesh.triangles]
    with np.errstate(all="ignore"):
        sides = [corners[:, (k + 2) % 3] - corners[:, (k + 1) % 3] for k in range(3)]
        lengths = np.stack([dots(side, side) for side in sides])
        squares = lengths.prod(axis=0)
        left, right = sides[0][:, 0] * sides[1][:, 1], sides[0][:, 1] * sides[1][:, 0]
        cross = left - right
        radius2 = squares / (4 * cross * cross)
        doubt = _ROUNDING * (4 + (np.abs(left) + np.abs(right)) / np.abs(cross))
        # a relative error is known of what is far from the smallest numbers all the way
        least = np.min([*lengths, squares, np.abs(left) + np.abs(right), cross * cross], axis=0)
        doubt[~(least > _SMALL)] = inf
    return _at_most(radius2, doubt, r, lambda t: _squared_circumradius(mesh.points[mesh.triangles[t]]))


def _edges_reached(family: AlphaComplex, r: Radius) -> NDArray[np.bool_]:
    """(e,) whether half of each length is at most r."""
    ends = family.points[family.edges]
    with np.errstate(all="ignore"):
        across = ends[:, 1] - ends[:, 0]
        quarter = dots(across, across) / 4
    return _at_most(quarter, np.full(len(quarter), 4 * _ROUNDING), r, lambda e: _squared_length(ends[e]) / 4)


def _at_most(squares: NDArray[np.float64], doubt: NDArray[np.float64], r: Radius, exact: object) -> NDArray[np.bool_]:
    """Compare squares, known with a relative error, with that of r; exactly where they are too close or no numbers."""
    if r == inf:
        return np.ones(len(squares), dtype=bool)
    limit = Fraction(r) ** 2
    rounded = float(limit) if limit < Fraction(2) ** 1000 else inf
    with np.errstate(all="ignore"):
        clear = (np.abs(squares - rounded) > (doubt + _ROUNDING) * (squares + rounded)) & (squares > _SMALL)
    result = squares < rounded
    for k in np.flatnonzero(~clear | ~np.isfinite(squares)).tolist():
        result[k] = exact(k) <= limit  # type: ignore[operator]
    return result


def _exact(places: NDArray[np.float64]) -> list[tuple[Fraction, Fraction]]:
    return [(Fraction(x), Fraction(y)) for x, y in places.tolist()]


def _squared_length(places: NDArray[np.float64]) -> Fraction:
    (ax, ay), (bx, by) = _exact(places)
    return (bx - ax) ** 2 + (by - ay) ** 2


def _squared_circumradius(places: NDArray[np.float64]) -> Fraction:
    (ax, ay), (bx, by), (cx, cy) = _exact(places)
    product = ((bx - ax) ** 2 + (by - ay) ** 2) * ((cx - ax) ** 2 + (cy - ay) ** 2) * ((cx - bx) ** 2 + (cy - by) ** 2)
    return product / (4 * ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) ** 2)


def _gabriel(family: AlphaComplex) -> NDArray[np.bool_]:
    """(e,) whether no opposite corner is strictly inside the disc on an edge as diameter."""
    result = np.ones(len(family), dtype=bool)
    for k in range(2):
        edge = np.flatnonzero(family.sides[:, k] >= 0)
        corners = family.mesh.triangles[family.sides[edge, k]]
        ends = family.edges[edge]
        apex = corners[(corners != ends[:, :1]) & (corners != ends[:, 1:])]
        p, a, b = family.points[apex], family.points[ends[:, 0]], family.points[ends[:, 1]]
        with np.errstate(all="ignore"):
            terms = (a - p) * (b - p)
            dot = terms.sum(axis=1)
            clear = np.abs(dot) > _ROUNDING * np.abs(terms).sum(axis=1)
            clear &= (np.abs(terms).sum(axis=1) > _SMALL) & np.isfinite(dot)
        inside = dot < 0
        for i in np.flatnonzero(~clear).tolist():
            (px, py), (ax, ay), (bx, by) = _exact(np.stack([p[i], a[i], b[i]]))
            inside[i] = (ax - px) * (bx - px) + (ay - py) * (by - py) < 0
        result[edge[inside]] = False
    return result


def _check_triangles(shape: AlphaShape, reached: NDArray[np.bool_]) -> None:
    inside = shape.inside
    _fail(inside & ~reached, "triangle {} is in the shape, but its circumradius is greater than r")
    _fail(~inside & reached, "triangle {} is not in the shape, but its circumradius is at most r")


def _expected_classes(shape: AlphaShape, reached: NDArray[np.bool_]) -> NDArray[np.intp]:
    """(e,) by the triangles of the shape; without any, an edge is singular from half its length on."""
    family = shape.family
    count = np.append(shape.inside, False)[family.sides].sum(axis=1)
    at_first = np.append(reached, False)[family.sides].sum(axis=1)  # a dropped region leaves no edges
    alone = _gabriel(family) & _edges_reached(family, shape.r) & (at_first == 0)
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


def _check_regions(shape: AlphaShape) -> None:
    """Regions are joined through edges, and joined to nothing else."""
    inside, region = shape.inside, shape.region
    t, u = shape.family.sides.T
    both = (t >= 0) & (u >= 0)
    t, u = t[both], u[both]
    t, u = t[inside[t] & inside[u]], u[inside[t] & inside[u]]
    _fail(region[t] != region[u], "neighboring triangles in the shape have different regions")
    leader = np.arange(len(region))  # by spreading the smallest number of neighbors, doubling the reach each time
    while True:
        before = leader.copy()
        np.minimum.at(leader, t, before[u])
        np.minimum.at(leader, u, before[t])
        leader = leader[leader]
        if np.array_equal(leader, before):
            break
    connected = len(distinct(leader[inside]))
    if connected != shape.region_count or len(distinct(region[inside])) != connected:
        raise VerificationError(f"the shape has {connected} regions, but {shape.region_count} polygons")


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
