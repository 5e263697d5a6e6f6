"""Polygons whose features are taken one by one: batches of them, each with a diagram of its own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from math import ceil, ldexp
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.planar_graph import (
    MOST_VERTICES,
    Arrangement,
    Found,
    Placement,
    arranged,
    placed_vertices,
    report_repairs,
    report_small,
)
from vorotool.engines.arrangement.repaired_polygons import (
    PlacedShapes,
    given_shapes,
    placed_shapes,
    with_flat_shells_as_lines,
)
from vorotool.errors import LimitError, warn
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Indices, mask_of, owners, ranges, starts_of
from vorotool.numeric.checks import available_threads
from vorotool.numeric.numbers import distinct
from vorotool.numeric.parallel import Progress, Run, in_threads
from vorotool.types.box import bounds, check_magnitude
from vorotool.types.polygons.planar_graph import REPAIRS, PlanarGraph
from vorotool.types.polygons.polygon_set import LINE, PolygonSet
from vorotool.types.polygons.shapely_geometry import RingArrays

Result = TypeVar("Result")


@frozen(eq=False)
class FeatureBatch:
    """Some features of a set that is placed, as if there were no others."""

    polygons: Indices  # int64 arrays: their numbers in the set
    rings: Indices  # int64 arrays: their numbers in the set
    vertices: Indices  # int64 arrays: their numbers in the set
    part: PolygonSet  # these polygons alone
    placement: Placement  # of their vertices, on the lattice of all
    # (k, 2) int32 array: corners of the bounds of all that are no vertices of these: as further sites they put the
    # sites into the order of all, and with them what is numbered or rounded along them. They are outside of
    # everything
    beyond: NDArray[np.int32]
    share: float  # of all vertices


@frozen(eq=False)
class BatchShapes:
    """A batch as a planar graph."""

    batch: FeatureBatch
    arrangement: Arrangement  # the graph, and what was repaired
    placed: PlacedShapes  # the rings as the graph has them: of features that were repaired what bounds them

    @property
    def graph(self) -> PlanarGraph:
        """The planar graph."""
        return self.arrangement.graph

    @property
    def feature_of_point(self) -> Indices:
        """(n,) the feature in the batch of each point of the graph."""
        of_vertex, graph = Features.of(self.batch.part).of_vertex, self.graph
        feature = of_vertex[graph.point_vertex]  # of crossings any: they are ends
        feature[graph.segments] = of_vertex[graph.source_edge[graph.source_starts[:-1]]][:, None]
        return feature


@frozen(eq=False)
class FeatureShapes:
    """Totals of features, each by itself, when all batches are done."""

    given: PolygonSet
    # what the batches are parts of: the input without vertices that objects of an image have from their neighbors
    used: PolygonSet
    corners: OwnCorners | None  # the vertices that are left of the input; None if all are
    placement: Placement
    largest_move: float  # as of a planar graph, as are
    repairs: dict[str, int]  # the repairs of all features together,
    points: int
    segments: int
    polygon_count: int  # how many polygons have any inside

    @property
    def scale(self) -> float:
        """The step of the lattice."""
        return ldexp(1.0, self.placement.exponent)

    def counts(self) -> dict[str, Any]:
        """Counts and sizes, as of one arrangement."""
        return {
            "polygons": len(self.given),
            "vertices": len(self.given.xy),
            "sites": self.points + self.segments,
            "segments": self.segments,
            "lattice_step": self.scale,
            "largest_move": self.largest_move,
            "repairs": self.repairs,
        }


class _DependentError(Exception):
    """Features of a batch have something in common."""


def in_batches(
    polygons: PolygonSet,
    work: Callable[[BatchShapes, Run], Result],
    *,
    reach: Callable[[PolygonSet, float], NDArray[np.int64]] | None = None,
    alone: bool = False,
    around: NDArray[np.float64] | None = None,
    drops: bool = True,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> tuple[FeatureShapes, list[tuple[BatchShapes, Result]]]:
    """Do some work for batches of features, each as if it were alone, on the lattice of all."""
    _check_size(polygons)
    given, polygons = polygons, with_flat_shells_as_lines(polygons)
    if polygons is not given:
        _report_flat(int(np.count_nonzero(polygons.is_line != given.is_line)))
    run: Run = {"threads": threads or available_threads(), "progress": progress}
    is_cracks = polygons.connectivity is not None and reach is None and not polygons.is_line.any()
    corners = own_corners(polygons) if is_cracks and drops else None
    used = polygons if corners is None else corners.polygons
    placement = placed_vertices(used, around=around, **run)
    features = Features.of(used)
    made: list[tuple[BatchShapes, Result]] | None = None
    if alone:
        made = _done(used, placement, features, np.arange(len(features), dtype=np.int32), work, run)
    elif is_cracks:
        sheets = sheets_of_cracks(features, placement.vertices, progress=progress)
        made = _done(used, placement, features, sheets, work, run, checks=True)
    if made is None:
        steps = None if reach is None else reach(used, ldexp(1.0, placement.exponent))
        sheets = sheets_of_boxes(features, placement.vertices, reach=steps, progress=progress)
        made = _done(used, placement, features, sheets, work, run)
    assert made is not None  # what is apart by its bounds is independent
    found = _all_repairs([shapes for shapes, _ in made], corners)
    repaired = _repaired(len(polygons), [shapes for shapes, _ in made])
    report_repairs(polygons, found, repaired, ldexp(1.0, placement.exponent), strict=strict)
    report_small(used, placement, strict=strict)
    return _as_a_whole(polygons, used, corners, placement, found, [shapes for shapes, _ in made]), made


def together(polygons: PolygonSet, *, strict: bool = False, threads: int = 0, progress: Progress = None) -> PlanarGraph:
    """Make the planar graph of all features; what is told is repairs of single ones: others may lie over them."""
    _check_size(polygons)
    polygons = with_flat_shells_as_lines(polygons)
    placement = placed_vertices(polygons, threads=threads, progress=progress)
    graph = arranged(polygons, placement, progress=progress).graph
    if any(graph.repairs.values()):
        in_batches(polygons, lambda *_: None, strict=strict, threads=threads, progress=progress)
    else:
        report_small(polygons, placement, strict=strict)
    return graph


def are_apart(graph: PlanarGraph) -> bool:
    """Whether nothing in the graph of all features was repaired, and none touches another one or lies over it."""
    given, vertices = given_shapes(graph)
    if any(graph.repairs.values()):
        return False
    face = owners(np.diff(graph.face_starts))
    feature = given.feature[graph.face_polygon]
    if ((face[1:] == face[:-1]) & (feature[1:] != feature[:-1])).any():
        return False
    if given.is_line.any() and _has_lines_inside(graph, given):
        return False
    return len(graph.points) == len(given.xy) or not len(touching_features(Features.of(given), vertices))


def _has_lines_inside(graph: PlanarGraph, given: PolygonSet) -> bool:
    """Whether an open line is inside another feature; of one that is a point it is taken to be so."""
    is_free = np.bincount(graph.segments.ravel(), minlength=len(graph.points)) == 0
    is_free[graph.point_holes[:, 0]] = False
    if is_free.any():
        return True
    edge = graph.source_edge[graph.source_starts[:-1]]
    ring = np.searchsorted(given.ring_starts, edge, side="right") - 1
    own = given.feature[given.ring_polygon[ring]]
    of_face = np.full(graph.faces, -1, dtype=np.int64)
    inside = graph.is_inside
    of_face[inside] = given.feature[graph.face_polygon[graph.face_starts[:-1][inside]]]
    beside = of_face[graph.segment_faces]
    return bool(((beside >= 0) & (beside != own[:, None])).any())


def _report_flat(count: int) -> None:
    """Warn of polygons that are taken for lines where what is inside is asked for."""
    polygons = "1 polygon has its" if count == 1 else f"{count} polygons have their"
    message = f"{polygons} vertices at one or two positions only and no area: treated as points and segments"
    warn(message)


def _check_size(polygons: PolygonSet) -> None:
    """Raise for coordinates that cannot be computed with, and for too many of them."""
    check_magnitude(polygons.xy)
    if len(polygons.xy) > MOST_VERTICES:
        raise LimitError(f"there are {len(polygons.xy)} vertices, more than {MOST_VERTICES}: split the polygons")


def _as_a_whole(
    given: PolygonSet,
    used: PolygonSet,
    corners: OwnCorners | None,
    placement: Placement,
    found: Found,
    parts: Sequence[BatchShapes],
) -> FeatureShapes:
    return FeatureShapes(
        given,
        used,
        corners,
        placement,
        max((shapes.graph.largest_move for shapes in parts), default=placement.largest_move),
        {name: count for name, (count, _, _) in found.items()},
        sum(len(shapes.graph.points) for shapes in parts),
        sum(len(shapes.graph) for shapes in parts),
        sum(len(distinct(shapes.graph.face_polygon)) for shapes in parts),
    )


def _done(
    used: PolygonSet,
    placement: Placement,
    features: Features,
    sheets: NDArray[np.int32],
    work: Callable[[BatchShapes, Run], Result],
    run: Run,
    *,
    checks: bool = False,
) -> list[tuple[BatchShapes, Result]] | None:
    """Batches and their results; None if features of a batch have something in common."""
    batches = _batches(used, placement, features, sheets)

    def task(batch: FeatureBatch, poll: Progress) -> tuple[BatchShapes, Result]:
        shapes = _shapes_of(batch, checks, poll)
        return shapes, work(shapes, {"threads": max(1, ceil(batch.share * run["threads"])), "progress": poll})

    order = sorted(range(len(batches)), key=lambda k: -batches[k].share)  # a large one that is late is waited for
    try:
        results = in_threads([partial(task, batches[k]) for k in order], **run) if batches else []
    except _DependentError:
        return None
    by_batch = dict(zip(order, results, strict=True))
    return [by_batch[k] for k in range(len(batches))]


def _batches(
    used: PolygonSet, placement: Placement, features: Features, sheets: NDArray[np.int32]
) -> list[FeatureBatch]:
    chosen = batches_of(features, sheets)
    if not chosen:
        return []
    arrays = RingArrays.of(used)
    if len(chosen) == 1:
        return [_whole_batch(used, arrays, placement)]
    corners = np.stack(bounds(placement.vertices))
    return [_batch(used, arrays, placement, corners, features.polygons_of(own)) for own in chosen]


def _whole_batch(used: PolygonSet, arrays: RingArrays, placement: Placement) -> FeatureBatch:
    polygons, rings, vertices = (np.arange(len(rows)) for rows in (arrays.rings, arrays.sizes, arrays.xy))
    part = arrays.bare(feature=used.feature, connectivity=used.connectivity)
    return FeatureBatch(polygons, rings, vertices, part, placement, placement.vertices[:0], 1.0)


def _batch(
    used: PolygonSet, arrays: RingArrays, placement: Placement, corners: NDArray[np.int32], polygons: Indices
) -> FeatureBatch:
    taken, rings, vertices = arrays.taken(polygons)
    part = taken.bare(feature=used.feature[polygons], connectivity=used.connectivity)
    places = placement.vertices[vertices]
    x, y = places.T
    is_known = [bool(((x == corner_x) & (y == corner_y)).any()) for corner_x, corner_y in corners.tolist()]
    beyond = corners[np.logical_not(is_known)]
    own = replace(placement, vertices=places)
    return FeatureBatch(polygons, rings, vertices, part, own, beyond, len(vertices) / len(used.xy))


def _shapes_of(batch: FeatureBatch, checks: bool, progress: Progress) -> BatchShapes:
    made = arranged(batch.part, batch.placement, progress=progress)
    if checks and not _are_apart(made):
        raise _DependentError
    repaired = made.is_repaired
    if repaired.any():
        _, own = np.unique(batch.part.feature, return_inverse=True)
        repaired = np.bincount(own, repaired, minlength=1)[own] > 0
    return BatchShapes(batch, made, placed_shapes(made.graph, is_repaired=repaired))


def _are_apart(made: Arrangement) -> bool:
    """Whether there is nothing to be repaired, and no face lies in two polygons."""
    graph = made.graph
    return not any(graph.repairs.values()) and bool((np.diff(graph.face_starts) < 2).all())


def _repaired(count: int, parts: Sequence[BatchShapes]) -> NDArray[np.bool_]:
    """Of so many polygons those with repairs."""
    made = np.zeros(count, dtype=bool)
    for shapes in parts:
        made[shapes.batch.polygons[shapes.arrangement.is_repaired]] = True
    return made


def _all_repairs(parts: Sequence[BatchShapes], corners: OwnCorners | None) -> Found:
    """Repairs of all batches, with the places in the input where each is found first."""
    total: Found = {}
    for name in REPAIRS:
        rows = [(shapes.arrangement.found[name], shapes.batch.vertices) for shapes in parts]
        count = sum(row[0] for row, _ in rows)
        places = [
            (int(vertices[edge]), int(vertices[other]) if other >= 0 else -1)
            for (own, edge, other), vertices in rows
            if own
        ]
        edge, other = min(places, default=(-1, -1))
        if corners is not None:
            edge, other = (int(corners.vertex[k]) if k >= 0 else -1 for k in (edge, other))
        total[name] = (count, edge, other)
    return total


@frozen(eq=False)
class OwnCorners:
    """Polygons without vertices in which they go straight on."""

    polygons: PolygonSet  # with the same rings
    vertex: Indices  # (n,) int64 array: the number of each vertex among those that were given


def own_corners(polygons: PolygonSet) -> OwnCorners | None:
    """Leave out vertices in which rings go straight on; None if there are none."""
    if not len(polygons.xy):
        return None
    candidates = _between_likes(polygons)
    before, after = (polygons.xy[k] for k in _neighbors(polygons, candidates))
    here = polygons.xy[candidates]
    (ux, uy), (vx, vy) = (here - before).T, (after - here).T
    straight = candidates[(ux * vy == uy * vx) & (ux * vx + uy * vy > 0)]
    if not straight.size:
        return None
    is_straight = mask_of(straight, len(polygons.xy))
    start = polygons.ring_starts
    kept = np.flatnonzero(~is_straight)
    sizes = np.add.reduceat(~is_straight, start[:-1])
    return OwnCorners(replace(polygons, xy=polygons.xy[kept], ring_starts=starts_of(sizes)), kept)


def _between_likes(polygons: PolygonSet) -> Indices:
    """Vertices between two edges that are both along the rows, or both not; those of lines have none on one side."""
    xy, start = polygons.xy, polygons.ring_starts
    is_along = np.empty(len(xy), dtype=bool)
    np.equal(xy[1:, 1], xy[:-1, 1], out=is_along[:-1])
    is_along[start[1:] - 1] = xy[start[:-1], 1] == xy[start[1:] - 1, 1]
    is_like = np.empty(len(xy), dtype=bool)
    np.equal(is_along[1:], is_along[:-1], out=is_like[1:])
    is_like[start[:-1]] = is_along[start[:-1]] == is_along[start[1:] - 1]
    candidates = np.flatnonzero(is_like)
    ring = np.searchsorted(start, candidates, side="right") - 1
    return candidates[~np.equal(polygons.ring_kind, LINE)[ring]]


def _neighbors(polygons: PolygonSet, vertices: Indices) -> tuple[Indices, Indices]:
    """The vertices before and after some."""
    start = polygons.ring_starts
    ring = np.searchsorted(start, vertices, side="right") - 1
    first, last = start[ring], start[ring + 1] - 1
    return np.where(vertices == first, last, vertices - 1), np.where(vertices == last, first, vertices + 1)


BATCH = 1 << 13
"""Vertices of a batch or more: some megabytes of its diagram, which stay in the cache, and soon done by any thread."""
APART = 1
"""Lattice steps around each feature: what snap rounding may move is nearer than one to it."""


@frozen(eq=False)
class Features:
    """The features of polygons, numbered without gaps."""

    polygon_starts: Indices  # (f + 1,) int64 array: the first polygon of each, and the number of polygons
    vertex_starts: Indices  # (f + 1,) int64 array: the first vertex of each, and the number of vertices

    @classmethod
    def of(cls, polygons: PolygonSet) -> Features:
        """Find them."""
        first = np.flatnonzero(np.diff(polygons.feature, prepend=-1))
        start = np.append(first, len(polygons))
        return cls(start, polygons.ring_starts[polygons.polygon_starts[start]])

    def __len__(self) -> int:
        return len(self.polygon_starts) - 1

    @property
    def of_vertex(self) -> Indices:
        """(n,) the feature of each vertex."""
        return owners(np.diff(self.vertex_starts))

    def polygons_of(self, chosen: Indices) -> Indices:
        """Polygons of some features."""
        first = self.polygon_starts[chosen]
        return ranges(first, self.polygon_starts[chosen + 1] - first)


def sheets_of_boxes(
    features: Features,
    vertices: NDArray[np.int32],
    *,
    reach: NDArray[np.int64] | None = None,
    progress: Progress = None,
) -> NDArray[np.int32]:
    """(f,) sheets of features: on the lattice the bounds of those of one sheet have a gap between them."""
    if len(features) < 2:
        return np.zeros(len(features), dtype=np.int32)
    first = features.vertex_starts[:-1]
    low, high = (bound.reduceat(vertices, first, axis=0).astype(np.int64) for bound in (np.minimum, np.maximum))
    wide = (APART if reach is None else reach + APART) * np.ones((len(features), 1), dtype=np.int64)
    return _core.spatial.disjoint_sheets(np.hstack([low - wide, high + wide]), progress)


def sheets_of_cracks(
    features: Features, vertices: NDArray[np.int32], *, progress: Progress = None
) -> NDArray[np.int32]:
    """(f,) sheets of features that are outlines of pixels: those of one sheet have no vertex in common."""
    sheet = np.zeros(len(features), dtype=np.int32)
    pairs = touching_features(features, vertices, progress=progress)
    if len(pairs):
        touching, index = np.unique(pairs, return_inverse=True)
        a, b = np.ascontiguousarray(index.reshape(-1, 2).T.astype(np.uint32))
        sheet[touching] = _core.graphs.color_graph(len(touching), a, b, progress).astype(np.int32) - 1
    return sheet


def touching_features(features: Features, vertices: NDArray[np.int32], *, progress: Progress = None) -> Indices:
    """(k, 2) pairs of features that have a vertex in common, each once: the smaller number first."""
    first = _core.arrangement.first_at_place(vertices, progress)
    again = np.flatnonzero(first != np.arange(len(first)))
    if not again.size:
        return np.empty((0, 2), dtype=np.int64)
    owner = features.of_vertex
    count = len(features)
    at = distinct(np.concatenate([first[again] * count + owner[again], first[again] * count + owner[first[again]]]))
    place, own = at // count, at % count
    pairs = []
    for step in range(1, int(np.bincount(np.unique(place, return_inverse=True)[1]).max())):
        same = place[step:] == place[:-step]
        pairs.append(own[:-step][same] * count + own[step:][same])
    if not pairs:
        return np.empty((0, 2), dtype=np.int64)
    keys = distinct(np.concatenate(pairs))
    return np.stack([keys // count, keys % count], axis=1)


def batches_of(features: Features, sheet: NDArray[np.int32]) -> list[Indices]:
    """Features of each batch: of one sheet, ascending, and about `BATCH` vertices or more."""
    if not len(features):
        return []
    order = np.argsort(sheet, kind="stable")
    sizes = np.diff(features.vertex_starts)[order]
    begin = starts_of(sizes)[:-1]
    new_sheet = np.diff(sheet[order], prepend=-1) != 0
    of_sheet = begin - np.maximum.accumulate(np.where(new_sheet, begin, 0))
    cut = new_sheet | (np.diff(of_sheet // BATCH, prepend=0) > 0)
    return np.split(order, np.flatnonzero(cut)[1:])
