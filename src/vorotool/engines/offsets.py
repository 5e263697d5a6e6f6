"""Offset curves of polygons and lines, from the clearance along the edges of their Voronoi diagram."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.label_arrays import Progress
from vorotool.engines.skeleton_exact import ShapeDiagram, diagram_arrays, kept_edges, shape_diagram
from vorotool.errors import UsageError
from vorotool.geometry.magnitude import check_lengths
from vorotool.geometry.offsets import Offsets
from vorotool.geometry.skeleton import Skeleton


def offset(
    shapes: Any,
    distances: float | Sequence[float],
    *,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Offsets:
    """Compute the curves at some distances from polygons and lines, as exact lines and circular arcs.

    Outwards (a distance above 0) the shapes grow into what is outside of all of them: they join where they come close,
    and holes shrink. Inwards (below 0) each region inside shrinks by itself, splits, or vanishes. Along each edge of
    the Voronoi diagram the clearance passes the distance where the curve crosses from cell to cell; within a cell it is
    a line parallel to an edge, or an arc about a vertex.

    Whether the curve passes on this or the other side of a vertex of the diagram is told by the vertex' radius, which
    is right to some ulp, and is the same for all that meet there: rings are closed and nested whatever the rounding. A
    disc of just the distance does not fit: at a tie what is no farther than the distance is one, and rounding may let a
    ring touch itself.

    Parameters
    ----------
    shapes : Skeleton, ShapeDiagram, or polygons
        Of a skeleton its polygons: how it was pruned makes no difference. Polygons are as for `skeleton_exact`.
    distances : float or sequence of float
        In input units; above 0 outwards, below 0 inwards.
    strict : bool
        Refuse polygons that would be repaired.
    threads : int
        0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    Offsets
        In the order of the distances; for each by polygon, what is around several polygons last.

    Raises
    ------
    InputError
        If a coordinate is not finite, or `strict` and something would be repaired.
    UsageError
        If there is no distance, or one is 0, not finite, there twice, or beyond all proportion to the shapes.
    LimitError
        If there are too many vertices.

    Examples
    --------
    A neck less than 2 wide splits the shape:

    >>> rooms = [[0, 0], [4, 0], [4, 1], [6, 1], [6, 0], [10, 0], [10, 4], [6, 4], [6, 2], [4, 2], [4, 4], [0, 4]]
    >>> made = offset(rooms, [-1, -0.25])
    >>> made.distance.tolist(), made.polygon.tolist()
    ([-1.0, -1.0, -0.25], [0, 0, 0])
    """
    wanted = checked_distances(distances)
    if isinstance(shapes, Skeleton):
        shapes = shapes.polygons
    if not isinstance(shapes, ShapeDiagram):
        shapes = shape_diagram(shapes, strict=strict, threads=threads, progress=progress)
    return _offsets_of(shapes, wanted, threads, progress)


def checked_distances(distances: float | Sequence[float]) -> list[float]:
    """Distances as a list, after a check."""
    wanted = np.atleast_1d(np.asarray(distances, dtype=np.float64))
    if wanted.ndim != 1 or not len(wanted):
        raise UsageError("there is no distance: give one or more, above 0 outwards, below 0 inwards")
    wrong = wanted[~np.isfinite(wanted) | (wanted == 0)]
    if wrong.size:
        raise UsageError(f"a distance is {wrong[0]:g}: use finite ones, above 0 outwards, below 0 inwards")
    found: list[float] = wanted.tolist()
    check_lengths(found, "distance")
    repeated = next((one for one in found if found.count(one) > 1), None)
    if repeated is not None:
        raise UsageError(f"the distance {repeated:g} is there {found.count(repeated)} times: give each one once")
    return found


def _offsets_of(shapes: ShapeDiagram, distances: list[float], threads: int, progress: Progress) -> Offsets:
    graph, diagram, placed = shapes.graph, shapes.diagram, shapes.placed
    for distance in distances:
        if len(diagram.edges) and not np.isfinite(distance / graph.scale):
            raise UsageError(f"the distance {distance:g} is beyond all proportion to the shapes: use a smaller one")
    face = np.full(len(diagram.edges), -1, dtype=np.int32)
    edges, faces = kept_edges(shapes, threads=threads, progress=progress)
    face[edges] = faces
    made = _core.offset_curves(
        *diagram_arrays(diagram),
        diagram.vertex_start,
        diagram.vertex_sites,
        face,
        graph.segment_faces,
        placed.face_polygon,
        placed.sites.polygon,
        distances,
        *graph.origin,
        graph.scale,
        progress,
    )
    shape_counts = [len(curves["polygon"]) for curves in made]
    return Offsets(
        **{
            name: np.concatenate([curves[name] for curves in made])
            for name in ("start", "end", "centre", "site", "polygon")
        },
        ring_start=_joined([curves["ring_start"] for curves in made]),
        shape_start=_joined([curves["shape_start"] for curves in made]),
        distance=np.repeat(distances, shape_counts),
        site_table=placed.sites,
        polygons=placed.polygons,
    )


def _joined(starts: list[NDArray[np.int64]]) -> NDArray[np.int64]:
    """Starts of several lists, one after the other."""
    counts = np.concatenate([np.diff(start) for start in starts])
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
