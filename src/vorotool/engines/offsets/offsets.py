"""Offset curves of polygons and lines, from the clearance along the edges of their Voronoi diagram."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.polygons import as_polygons
from vorotool.engines.arrangement.planar_graph import arranged, placed_vertices
from vorotool.engines.features.batches import BatchShapes, are_apart, in_batches, together
from vorotool.engines.features.order import InputOrder
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram
from vorotool.engines.skeleton.diagrams import batch_diagram, joined_sites
from vorotool.engines.skeleton.exact import (
    ShapeDiagram,
    check_features,
    diagram_of_graph,
    kept_edges,
    shape_diagram,
)
from vorotool.errors import UsageError, VorotoolWarning
from vorotool.numeric.arrays import ranges, starts_of
from vorotool.numeric.numbers import finite_double
from vorotool.numeric.parallel import Progress, Run, running
from vorotool.types.box import check_lengths
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.offsets import Offsets
from vorotool.types.skeleton.segment_voronoi import SiteTable
from vorotool.types.skeleton.skeleton import Skeleton

if TYPE_CHECKING:
    from vorotool.typing import FeaturesChoice, ShapesLike

Curves = dict[str, NDArray[Any]]
"""Arrays of `Offsets` at one distance."""


def offset(
    shapes: ShapeDiagram | ShapesLike,
    distances: float | Sequence[float],
    *,
    features: FeaturesChoice = "separate",
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Offsets:
    """Compute offset curves of polygons and lines as exact lines and circular arcs.

    Outwards (a distance above 0) the shapes grow into what is outside of all of them: they join where they come close,
    and holes shrink. Inwards (below 0) each feature shrinks as if there were no others, each region in it by itself; it
    splits, or vanishes. Along each edge of the Voronoi diagram the clearance passes the distance where the curve
    crosses from cell to cell; within a cell it is a line parallel to an edge, or an arc about a vertex.

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
    features : {"separate", "together"}
        Inwards, take each feature by itself, or the regions between the edges of all of them; of a skeleton as it was
        made, and of a diagram together.
    strict : bool
        Refuse polygons that need repair.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    Offsets
        Shapes in the order of the distances, then by polygon; those around several polygons come last.

    Raises
    ------
    InputError
        If a coordinate is not finite, or `strict` and something would be repaired.
    UsageError
        If there is no distance, or one is 0, not finite, repeated, or too large for the shapes.
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
    wanted, run = checked_distances(distances), running(threads, progress)
    check_features(features)
    are_separate = (shapes.features if isinstance(shapes, Skeleton) else features) == "separate"
    if not isinstance(shapes, ShapeDiagram):
        polygons = shapes.polygons if isinstance(shapes, Skeleton) else as_polygons(shapes, "shapes")
        if are_separate:
            return _offsets_of_features(polygons, wanted, strict, run)
        shapes = shape_diagram(polygons, strict=strict, **run)
    made = _offsets_of(shapes, wanted, run)
    feature = made.polygons.feature
    has_several = len(feature) > 0 and feature[0] != feature[-1]
    return replace(made, features="together") if has_several else made


def checked_distances(distances: float | Sequence[float]) -> list[float]:
    """Distances as a list, after a check."""
    wanted = np.array([finite_double(distance, "a distance") for distance in listed_distances(distances)])
    if not len(wanted):
        raise UsageError("the list of distances is empty: give one or more, positive outwards, negative inwards")
    if not wanted.all():
        raise UsageError("a distance is 0: use positive ones outwards, negative ones inwards")
    found: list[float] = wanted.tolist()
    check_lengths(found, "distance")
    repeated = next((one for one in found if found.count(one) > 1), None)
    if repeated is not None:
        raise UsageError(
            f"the distance {repeated:g} is repeated {found.count(repeated)} times: give each distance once"
        )
    return found


def listed_distances(distances: Any) -> list[Any]:
    """One distance, or several, as a list; text is one that is wrong."""
    try:
        return [distances] if isinstance(distances, str | bytes) else list(distances)
    except (TypeError, ValueError):  # as of a file that is closed
        return [distances]


def _offsets_of_features(polygons: PolygonSet, distances: list[float], strict: bool, run: Run) -> Offsets:
    """Outwards of all features, inwards of each by itself."""
    if max(distances) > 0:
        graph = together(polygons, strict=strict, **run)
        if min(distances) > 0 or are_apart(graph):
            return _offsets_of(diagram_of_graph(graph, **run), distances, run)
    inwards = [distance for distance in distances if distance < 0]

    def work(shapes: BatchShapes, run: Run) -> list[Curves]:
        return curves_of(batch_diagram(shapes, is_whole=True, **run), inwards, run)

    with warnings.catch_warnings():
        if max(distances) > 0:
            warnings.simplefilter("ignore", VorotoolWarning)  # repairs were told where all were put together
        whole, made = in_batches(polygons, work, strict=strict, **run)
    order = InputOrder.of(whole, [shapes for shapes, _ in made])
    curves: dict[float, Curves] = {
        distance: _joined_curves(order, made, number) for number, distance in enumerate(inwards)
    }
    sites = order.site_table
    if max(distances) > 0:
        placement = placed_vertices(order.polygons, **run)
        shapes = diagram_of_graph(arranged(order.polygons, placement, progress=run["progress"]).graph, **run)
        sites, shift = joined_sites(order.polygons, sites, shapes.placed, shapes.graph)
        outwards = [distance for distance in distances if distance > 0]
        for distance, found in zip(outwards, curves_of(shapes, outwards, run), strict=True):
            source = np.append(shapes.placed.source, -1)
            curves[distance] = found | {
                "site": found["site"] + np.int32(shift),
                "polygon": source[found["polygon"]].astype(np.int32),
            }
    return _as_offsets(
        [curves[distance] for distance in distances], distances, sites, order.polygons, whole.placement.origin
    )


def _joined_curves(order: InputOrder, made: Sequence[tuple[BatchShapes, list[Curves]]], number: int) -> Curves:
    """Curves of all batches at one distance, polygon by polygon; what a beyond point is a site of is outside."""
    columns: dict[str, list[NDArray[Any]]] = {}
    parts = zip(made, order.polygon_numbers, order.site_numbers, strict=True)
    for (shapes, curves), polygons, sites in parts:
        own, beyond = curves[number], len(shapes.batch.beyond)
        site = own["site"] - (own["site"] >= len(shapes.graph.points)) * np.int32(beyond)
        rows: dict[str, Any] = own | {
            "site": sites[site],
            "polygon": polygons[own["polygon"]],
            "rings": np.diff(own["shape_starts"]),
            "pieces": np.diff(own["ring_starts"]),
        }
        for name, values in rows.items():
            columns.setdefault(name, []).append(values)
    found = {name: np.concatenate(values) for name, values in columns.items()}
    if not found:
        return _no_curves()
    chosen = np.argsort(found["polygon"], kind="stable")
    rings = ranges(starts_of(found["rings"])[chosen], found["rings"][chosen])
    pieces = ranges(starts_of(found["pieces"])[rings], found["pieces"][rings])
    return {
        **{name: found[name][pieces] for name in ("start", "end", "center", "site")},
        "polygon": found["polygon"][chosen],
        "ring_starts": starts_of(found["pieces"][rings]),
        "shape_starts": starts_of(found["rings"][chosen]),
    }


def _no_curves() -> Curves:
    places, numbers, start = np.empty((0, 2)), np.empty(0, dtype=np.int32), np.zeros(1, dtype=np.int64)
    return {
        **dict.fromkeys(("start", "end", "center"), places),
        **dict.fromkeys(("site", "polygon"), numbers),
        **dict.fromkeys(("ring_starts", "shape_starts"), start),
    }


def _offsets_of(shapes: ShapeDiagram, distances: list[float], run: Run) -> Offsets:
    made = curves_of(shapes, distances, run)
    return _as_offsets(made, distances, shapes.placed.sites, shapes.placed.polygons, shapes.graph.origin)


def curves_of(shapes: ShapeDiagram, distances: list[float], run: Run) -> list[Curves]:
    """The curves at each distance, as arrays; sites are those of the diagram."""
    graph, diagram, placed = shapes.graph, shapes.diagram, shapes.placed
    for distance in distances:
        if len(diagram.edges) and not np.isfinite(distance / graph.scale):
            raise UsageError(f"the distance {distance:g} is too large for shapes of this size: use a smaller one")
    face = np.full(len(diagram.edges), -1, dtype=np.int32)
    edges, faces = kept_edges(shapes, **run)
    face[edges] = faces
    count = len(graph.points)
    more = np.full(len(diagram.points) - count, -1, dtype=np.int32)  # points that are of no polygon
    polygon = np.insert(placed.sites.polygon, count, more)
    feature = np.append(placed.polygons.feature, -1).astype(np.int32)
    return _core.offsets.offset_curves(
        core_diagram(diagram, graph.segment_faces),
        face,
        placed.face_polygon,
        polygon,
        feature[polygon],
        distances,
        *graph.origin,
        graph.scale,
        run["progress"],
    )


def _as_offsets(
    made: Sequence[Curves],
    distances: list[float],
    sites: SiteTable,
    polygons: PolygonSet,
    origin: tuple[float, float],
) -> Offsets:
    shape_counts = [len(curves["polygon"]) for curves in made]
    columns: dict[str, Any] = {
        name: np.concatenate([curves[name] for curves in made])
        for name in ("start", "end", "center", "site", "polygon")
    }
    return Offsets(
        **columns,
        ring_starts=_joined([curves["ring_starts"] for curves in made]),
        shape_starts=_joined([curves["shape_starts"] for curves in made]),
        distance=np.repeat(distances, shape_counts),
        site_table=sites,
        polygons=polygons,
        origin=origin,
    )


def _joined(starts: list[NDArray[np.int64]]) -> NDArray[np.int64]:
    """Starts of several lists, one after the other."""
    return starts_of(np.concatenate([np.diff(start) for start in starts]))
