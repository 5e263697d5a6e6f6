"""Skeletons inside many outlines of pixels: in batches, each of them with a diagram of its own."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.label_arrays import Progress
from vorotool.engines.placed_rings import placed_shapes
from vorotool.engines.planar_graph import Placement, graph_of_placement, placed_vertices
from vorotool.engines.segment_voronoi import segment_voronoi
from vorotool.engines.skeleton_exact import ShapeDiagram, skeleton_of
from vorotool.errors import InputError
from vorotool.geometry.checks import available_threads
from vorotool.geometry.polygons import PolygonSet
from vorotool.geometry.skeleton import VERTEX, SiteTable, Skeleton

BATCH = 1 << 14
"""Vertices of a batch or more: some megabytes of its diagram, which stay in the cache."""

Integers = NDArray[np.int64]


def batched_skeleton(polygons: PolygonSet, *, threads: int, progress: Progress = None) -> Skeleton | None:
    """Give the skeleton inside crack outlines as one diagram of all has it, or None if it is to be made of that.

    Crack outlines of different objects do not cross, and their insides are disjoint: what is nearest to a place inside
    one is its own boundary. So polygons that share no vertex are independent. Each batch is on the lattice of all, and
    the corners of their bounds are sites of its diagram: then its sites are ordered as those of all, and with them what
    is numbered or rounded along them. A batch with more than a thread's share of the vertices has all threads.
    """
    if polygons.connectivity is None or len(polygons.xy) < 2 * BATCH:
        return None
    placement = placed_vertices(polygons, threads=threads, progress=progress)
    starts = batch_starts(polygons, placement.vertices)
    if placement.largest_move > 0 or len(starts) < 3:
        return None
    corners = np.stack([placement.vertices.min(axis=0), placement.vertices.max(axis=0)])
    ranges = zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True)
    batches = [_Batch(polygons, placement, corners, begin, end) for begin, end in ranges]
    parts = _made(batches, threads or available_threads(), progress)
    return joined(parts, batches, polygons) if len(parts) == len(batches) else None


def batch_starts(polygons: PolygonSet, vertices: NDArray[np.int32]) -> Integers:
    """First polygon of each batch, and the number of polygons; no two batches have a vertex in common.

    Examples
    --------
    >>> from vorotool import outlines
    >>> pixels = outlines(np.array([[1, 0, 1], [0, 0, 0], [2, 0, 2]]), mode="labels")
    >>> batch_starts(pixels, (2 * pixels.xy).astype(np.int32)).tolist()
    [0, 4]
    """
    first = polygons.ring_start[polygons.polygon_start]
    key = vertices[:, 0].astype(np.int64) << 32 | vertices[:, 1].view(np.uint32).astype(np.int64)
    order = np.argsort(key, kind="stable")
    key = key[order]
    same = np.flatnonzero(key[1:] == key[:-1])
    low, high = np.searchsorted(first, np.stack([order[same], order[same + 1]]), side="right") - 1
    pairs = np.zeros(len(polygons) + 2, dtype=np.int64)  # that begin before, less those that end before
    np.add.at(pairs, np.minimum(low, high) + 1, 1)
    np.add.at(pairs, np.maximum(low, high) + 1, -1)
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
        known = (graph.points[:, None] == self.corners).all(axis=2).any(axis=0)
        points = np.concatenate([graph.points, self.corners[~known]])
        diagram = segment_voronoi(points, graph.segments, threads=threads, progress=progress)
        shapes = ShapeDiagram(graph, diagram, placed_shapes(graph, threads=threads))
        made = skeleton_of(shapes, threads=threads, progress=progress)
        beyond = made.sites >= len(points)
        return replace(made, sites=made.sites - beyond * np.int32(len(points) - len(graph.points)))


def _made(batches: list[_Batch], threads: int, progress: Progress) -> list[Skeleton]:
    """Skeletons of batches, as far as the first that has none."""
    total = len(batches[0].polygons.xy)
    share = total / threads
    sizes = [batch.vertices.stop - batch.vertices.start for batch in batches]
    parts: dict[int, Skeleton | None] = {}
    for k in [k for k, size in enumerate(sizes) if size > share]:
        parts[k] = batches[k].skeleton(threads, progress)
    rest = [k for k in range(len(batches)) if k not in parts]
    stop = threading.Event()

    def poll(_: float) -> None:
        if stop.is_set():
            raise KeyboardInterrupt

    with ThreadPoolExecutor(threads) as pool:
        futures = {k: pool.submit(batches[k].skeleton, 1, poll) for k in rest}
        try:
            for done, (k, future) in enumerate(futures.items()):
                parts[k] = future.result()
                if progress is not None:
                    progress((done + 1) / len(rest))
        except BaseException:
            stop.set()
            pool.shutdown(cancel_futures=True)
            raise
    found = [parts[k] for k in range(len(batches))]
    return [part for part in found if part is not None]


def joined(parts: list[Skeleton], batches: list[_Batch], polygons: PolygonSet) -> Skeleton:
    """Make one skeleton of those of batches, in their order."""
    points = [int(np.count_nonzero(part.site_table.kind == VERTEX)) for part in parts]
    segments = [len(part.site_table) - count for part, count in zip(parts, points, strict=True)]
    point, segment = _before(points), sum(points) + _before(segments)
    node, branch = (_before([count(part) for part in parts]) for count in (_nodes, _branches))
    rows: dict[str, list[Any]] = {name: [] for name in ("arcs", "sites", "polygon", "branch")}
    for k, (part, batch) in enumerate(zip(parts, batches, strict=True)):
        is_segment = part.sites >= points[k]
        rows["arcs"].append(part.arcs + node[k])
        rows["sites"].append(part.sites + np.where(is_segment, segment[k] - points[k], point[k]))
        rows["polygon"].append(part.polygon + batch.begin)
        rows["branch"].append(part.branch + branch[k])
    for name in ("vertices", "radius", "control", "side", "length", "error_bound"):
        rows[name] = [getattr(part, name) for part in parts]
    arrays: dict[str, Any] = {name: np.concatenate(values) for name, values in rows.items()}
    return Skeleton(**arrays, site_table=_joined_sites(parts, batches, points), polygons=polygons)


def _joined_sites(parts: list[Skeleton], batches: list[_Batch], points: list[int]) -> SiteTable:
    """All points, then all segments."""
    columns: dict[str, Any] = {}
    for field in fields(SiteTable):
        shift = {"polygon": "begin", "source_ring": "first_ring"}.get(field.name)
        values = [
            getattr(part.site_table, field.name) + (getattr(batch, shift) if shift else 0)
            for part, batch in zip(parts, batches, strict=True)
        ]
        firsts = [value[:count] for value, count in zip(values, points, strict=True)]
        columns[field.name] = np.concatenate([*firsts, *(v[n:] for v, n in zip(values, points, strict=True))])
    return SiteTable(**columns)


def _before(counts: list[int]) -> Integers:
    """How many come before each."""
    return np.cumsum([0, *counts[:-1]])


def _nodes(skeleton: Skeleton) -> int:
    return len(skeleton.radius)


def _branches(skeleton: Skeleton) -> int:
    return int(skeleton.branch[-1]) + 1 if len(skeleton) else 0
