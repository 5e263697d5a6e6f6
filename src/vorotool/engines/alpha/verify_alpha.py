"""A check of alpha shapes that knows the definition only, not how they were made."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.alpha.verify_space import (
    at_most,
    check_inside,
    check_regions,
    cut_balls,
    is_in_diametral_ball,
    verify_space_shape,
)
from vorotool.engines.delaunay.delaunay import verify_triangulation
from vorotool.errors import VerificationError
from vorotool.numeric.arrays import Booleans, Floats, owners
from vorotool.numeric.parallel import Progress
from vorotool.types.alpha.complex import CLASSES, AlphaComplex
from vorotool.types.alpha.shape import AlphaShape
from vorotool.types.arguments import check_value

if TYPE_CHECKING:
    from vorotool.types.alpha.space import SpaceAlphaShape


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
