"""Skeletons inside many outlines of pixels: in batches, each of them with a diagram of its own."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields, replace
from functools import partial
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.label_arrays import Progress
from vorotool.engines.parts import in_threads, stacked, starts_of
from vorotool.engines.placed_rings import placed_shapes
from vorotool.engines.planar_graph import Placement, graph_of_placement, placed_vertices
from vorotool.engines.segment_voronoi import NEITHER, idle_sides, segment_voronoi
from vorotool.engines.skeleton_exact import ShapeDiagram, skeleton_of
from vorotool.errors import InputError
from vorotool.geometry.box import bounds
from vorotool.geometry.checks import available_threads
from vorotool.geometry.polygons import PolygonSet
from vorotool.geometry.skeleton import VERTEX, SiteTable, Skeleton

BATCH = 1 << 13
"""Vertices of a batch or more: some megabytes of its diagram, which stay in the cache, and soon done by any thread."""

Integers = NDArray[np.int64]


def batched_skeleton(polygons: PolygonSet, *, threads: int, progress: Progress = None) -> Skeleton | None:
    """Give the skeleton inside crack outlines as one diagram of all has it, or None if it is to be made of that.

    Crack outlines of different objects do not cross, and their insides are disjoint: what is nearest to a place inside
    one is its own boundary. So polygons that share no vertex are independent. Each batch is on the lattice of all, and
    the corners of their bounds are sites of its diagram: then its sites are ordered as those of all, and with them what
    is numbered or rounded along them. A batch has as many threads as it has shares of the vertices, and others go on
    while a large one is at what one thread does alone.
    """
    if polygons.connectivity is None or polygons.is_line.any() or len(polygons.xy) < 2 * BATCH:
        return None
    placement = placed_vertices(polygons, threads=threads, progress=progress)
    starts = batch_starts(polygons, placement.vertices, progress=progress)
    if placement.largest_move > 0 or len(starts) < 3:
        return None
    corners = np.stack(bounds(placement.vertices))
    ranges = zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True)
    batches = [_Batch(polygons, placement, corners, begin, end) for begin, end in ranges]
    threads = threads or available_threads()
    parts = _made(batches, threads, progress)
    return joined(parts, batches, polygons, threads=threads) if len(parts) == len(batches) else None


def batch_starts(polygons: PolygonSet, vertices: NDArray[np.int32], *, progress: Progress = None) -> Integers:
    """First polygon of each batch, and the number of polygons; no two batches have a vertex in common.

    Examples
    --------
    >>> from vorotool import outlines
    >>> pixels = outlines(np.array([[1, 0, 1], [0, 0, 0], [2, 0, 2]]), mode="labels")
    >>> batch_starts(pixels, (2 * pixels.xy).astype(np.int32)).tolist()
    [0, 4]
    """
    first = polygons.ring_start[polygons.polygon_start]
    earlier = _core.first_at_place(vertices, progress)
    again = np.flatnonzero(earlier != np.arange(len(earlier)))
    low, high = np.searchsorted(first, np.stack([earlier[again], again]), side="right") - 1
    pairs = np.zeros(len(polygons) + 2, dtype=np.int64)  # that begin before, less those that end before
    np.add.at(pairs, low + 1, 1)
    np.add.at(pairs, high + 1, -1)
    starts = [0]
    for polygon in np.flatnonzero(np.cumsum(pairs[:-1]) == 0).tolist():
        if first[polygon] - first[starts[-1]] >= BATCH or polygon == len(polygons) > starts[-1]:
            starts.append(polygon)
    return np.array(starts)


@dataclass(frozen=True)
class _Batch:
    """Polygons `begin` to `end` - 1 of a set that is placed, and the corners of the bounds of all."""

    polygons: PolygonSet
    placement: Placement
    corners: NDArray[np.int32]
    begin: int
    end: int

    @property
    def rings(self) -> slice:
        return slice(*self.polygons.polygon_start[[self.begin, self.end]].tolist())

    @property
    def first_ring(self) -> int:
        return int(self.rings.start)

    @property
    def vertices(self) -> slice:
        return slice(*self.polygons.ring_start[[self.rings.start, self.rings.stop]].tolist())

    def part(self) -> PolygonSet:
        """These polygons alone."""
        whole, rings = self.polygons, self.rings
        return PolygonSet(
            whole.xy[self.vertices],
            whole.ring_start[rings.start : rings.stop + 1] - self.vertices.start,
            whole.ring_kind[rings],
            whole.ring_polygon[rings] - self.begin,
            connectivity=whole.connectivity,
        )

    def skeleton(self, threads: int, progress: Progress) -> Skeleton | None:
        """Their skeleton; None if they would be repaired."""
        given = replace(self.placement, vertices=self.placement.vertices[self.vertices])
        try:
            graph = graph_of_placement(self.part(), given, strict=True, progress=progress)
        except InputError:
            return None
        x, y = graph.points.T
        known = [bool(((x == corner_x) & (y == corner_y)).any()) for corner_x, corner_y in self.corners]
        beyond = self.corners[np.logical_not(known)]  # points without segments, outside
        points = np.concatenate([graph.points, beyond])
        idle = idle_sides(graph, graph.is_inside)
        idle = np.insert(idle, len(graph.points), np.full(len(beyond), NEITHER, dtype=np.uint8))
        diagram = segment_voronoi(points, graph.segments, idle=idle, threads=threads, progress=progress)
        shapes = ShapeDiagram(graph, diagram, placed_shapes(graph, threads=threads))
        made = skeleton_of(shapes, threads=threads, progress=progress)
        is_segment = made.sites >= len(points)
        return replace(made, sites=made.sites - is_segment * np.int32(len(beyond)))


def _made(batches: list[_Batch], threads: int, progress: Progress) -> list[Skeleton]:
    """Skeletons of batches, but of those that have none."""
    share = len(batches[0].polygons.xy) / threads
    sizes = [batch.vertices.stop - batch.vertices.start for batch in batches]
    order = sorted(range(len(batches)), key=lambda k: -sizes[k])  # a large one that is late would be waited for
    tasks = [partial(batches[k].skeleton, ceil(sizes[k] / share)) for k in order]
    parts = dict(zip(order, in_threads(tasks, threads, progress), strict=True))
    found = [parts[k] for k in range(len(batches))]
    return [part for part in found if part is not None]


def joined(parts: list[Skeleton], batches: list[_Batch], polygons: PolygonSet, *, threads: int = 1) -> Skeleton:
    """Make one skeleton of those of batches, in their order. Its arrays are filled on several threads."""
    points = [int(np.count_nonzero(part.site_table.kind == VERTEX)) for part in parts]
    segments = [len(part.site_table) - count for part, count in zip(parts, points, strict=True)]
    shifts = {
        "arcs": starts_of([len(part.radius) for part in parts]),
        "branch": starts_of([_branches(part) for part in parts]),
        "polygon": [batch.begin for batch in batches],
    }
    first_segment = [sum(points) + count for count in starts_of(segments)]
    with ThreadPoolExecutor(threads) as pool:
        sites = pool.submit(_joined_sites, [part.sites for part in parts], points, starts_of(points), first_segment)
        table = {
            field.name: pool.submit(_joined_column, field.name, parts, batches, points) for field in fields(SiteTable)
        }
        names = ("vertices", "radius", "arcs", "control", "polygon", "side", "branch", "length", "error_bound")
        rows = {name: pool.submit(stacked, [getattr(part, name) for part in parts], shifts.get(name)) for name in names}
        arrays: dict[str, Any] = {name: row.result() for name, row in rows.items()}
        columns: dict[str, Any] = {name: column.result() for name, column in table.items()}
        return Skeleton(**arrays, sites=sites.result(), site_table=SiteTable(**columns), polygons=polygons)


def _joined_sites(
    sites: list[NDArray[np.int32]], points: list[int], first_point: list[int], first_segment: list[int]
) -> NDArray[Any]:
    """Sites of arcs: of each batch so many points, then segments."""
    made = stacked(sites, first_point)
    for k, begin in enumerate(starts_of([len(part) for part in sites])):
        own = made[begin : begin + len(sites[k])]
        np.add(own, first_segment[k] - points[k] - first_point[k], out=own, where=sites[k] >= points[k])
    return made


def _joined_column(name: str, parts: list[Skeleton], batches: list[_Batch], points: list[int]) -> NDArray[Any]:
    """Of the table of sites: all points, then all segments."""
    columns = [getattr(part.site_table, name) for part in parts]
    shift = {"polygon": "begin", "source_ring": "first_ring"}.get(name)
    shifts = None if shift is None else 2 * [getattr(batch, shift) for batch in batches]
    return stacked(
        [column[:count] for column, count in zip(columns, points, strict=True)]
        + [column[count:] for column, count in zip(columns, points, strict=True)],
        shifts,
    )


def _branches(skeleton: Skeleton) -> int:
    return int(skeleton.branch[-1]) + 1 if len(skeleton) else 0
