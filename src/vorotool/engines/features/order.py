"""Polygons, sites and arcs of batches of features, put into the order of the input."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.features.batches import BatchShapes, FeatureShapes
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Indices, owners, ranks_of, starts_of, within
from vorotool.types.polygons.planar_graph import off_lattice
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.shapely_geometry import RingArrays
from vorotool.types.skeleton.segment_voronoi import SiteTable


@frozen(eq=False)
class Places:
    """Where the items of all batches, one batch after the other, come in the end."""

    place: Indices | None  # (n,) int64 array: of each item; None where they stay

    @classmethod
    def by(cls, keys: NDArray[Any]) -> Places:
        """Sort by keys: equal ones follow each other already, and keep their order."""
        if (keys[1:] >= keys[:-1]).all():
            return cls(None)
        counts = np.bincount(keys)
        runs = np.diff(np.flatnonzero(np.diff(keys, prepend=-1)), append=len(keys))
        return cls(starts_of(counts)[keys] + within(runs))

    def arranged(self, columns: Sequence[NDArray[Any]]) -> NDArray[Any]:
        """Values of all batches in their order."""
        stacked = np.concatenate(columns)
        if self.place is None:
            return stacked
        made = np.empty_like(stacked)
        made[self.place] = stacked
        return made

    def numbers(self, items: NDArray[Any]) -> NDArray[np.int32]:
        """New numbers of items."""
        if self.place is None:
            return items.astype(np.int32, copy=False)
        return self.place.astype(np.int32)[items]


@frozen(eq=False)
class InputOrder:
    """How what batches have comes in the order of the input."""

    polygons: PolygonSet  # as they were used, of all batches
    # of all: points in the order of the vertices, then crossings; then segments in the order of the edges
    site_table: SiteTable
    # list of arrays: of each batch: the number in `polygons` of each of its polygons, in `site_table` of each of its
    # sites
    polygon_numbers: list[NDArray[np.int32]]
    # list of arrays: of each batch: the number in `polygons` of each of its polygons, in `site_table` of each of its
    # sites
    site_numbers: list[NDArray[np.int32]]

    @classmethod
    def of(cls, whole: FeatureShapes, parts: Sequence[BatchShapes]) -> InputOrder:
        """Find it."""
        if len(parts) == 1 and whole.corners is None and not any(whole.repairs.values()):
            return cls._as_is(whole, parts[0])
        source = stacked([shapes.batch.polygons[shapes.placed.source] for shapes in parts])
        order = np.argsort(source, kind="stable")
        places = (
            Places(ranks_of(order, len(order))),
            Places.by(_point_keys(whole, parts)),
            Places.by(_segment_keys(parts)),
        )
        counts = [(len(shapes.placed.polygons), len(shapes.graph.points), len(shapes.graph)) for shapes in parts]
        polygons, points, segments = (
            numbers_of_batches(place, [row[k] for row in counts]) for k, place in enumerate(places)
        )
        first_segment = sum(row[1] for row in counts)
        sites = [
            np.concatenate([own, ends + np.int32(first_segment)]) for own, ends in zip(points, segments, strict=True)
        ]
        table = _all_sites(whole, parts, polygons, places[1:])
        return cls(_all_polygons(whole, parts, source[order], order), table, polygons, sites)

    @classmethod
    def _as_is(cls, whole: FeatureShapes, shapes: BatchShapes) -> InputOrder:
        """Keep the order of a batch with all features, of which none was repaired."""
        placed = shapes.placed
        numbers = [np.arange(len(rows), dtype=np.int32) for rows in (placed.polygons, placed.sites)]
        nothing = np.empty(0, dtype=np.int64)  # where nothing was repaired, nobody asks where polygons come from
        return cls(_all_polygons(whole, [], nothing, nothing), placed.sites, numbers[:1], numbers[1:])


def stacked(columns: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """One after the other; there may be none."""
    return np.concatenate(columns) if columns else np.empty(0, dtype=np.int64)


def numbers_of_batches(places: Places, counts: Sequence[int]) -> list[NDArray[np.int32]]:
    """Number so many items of each batch by where they come in the end."""
    numbers = places.numbers(np.arange(sum(counts), dtype=np.int32))
    return np.split(numbers, starts_of(counts)[1:-1]) if counts else []


def _point_keys(whole: FeatureShapes, parts: Sequence[BatchShapes]) -> Indices:
    """Of the points of all batches: their first vertices; for crossings numbers from there on, by their places."""
    vertex = stacked([shapes.graph.point_vertex.astype(np.int64) for shapes in parts])
    first = owners([len(shapes.graph.points) for shapes in parts])
    is_crossing = vertex < 0
    begin = starts_of([len(shapes.batch.vertices) for shapes in parts])
    known = np.flatnonzero(~is_crossing)
    vertex[known] = stacked([shapes.batch.vertices for shapes in parts])[vertex[known] + begin[first[known]]]
    crossings = np.flatnonzero(is_crossing)
    if crossings.size:
        x, y = np.concatenate([shapes.graph.points for shapes in parts])[crossings].T
        polygon = first[crossings]  # at one place the features' order is that of their batches
        vertex[crossings[np.lexsort((polygon, y, x))]] = len(whole.used.xy) + np.arange(len(crossings))
    return vertex


def _segment_keys(parts: Sequence[BatchShapes]) -> Indices:
    """Of the segments of all batches: the first edge that each is part of."""
    return stacked(
        [shapes.batch.vertices[shapes.graph.source_edge[shapes.graph.source_starts[:-1]]] for shapes in parts]
    )


def _all_polygons(whole: FeatureShapes, parts: Sequence[BatchShapes], source: Indices, order: Indices) -> PolygonSet:
    used, placement = whole.used, whole.placement
    if not any(whole.repairs.values()):
        if not placement.largest_move:
            return used
        return used.moved(off_lattice(placement.vertices.astype(np.float64), placement.origin, whole.scale))
    placed = [shapes.placed.polygons for shapes in parts]
    arrays, _, vertices = RingArrays.joined([RingArrays.of(polygons) for polygons in placed]).taken(order)
    made = arrays.polygons(used, source)
    if not whole.largest_move:
        return made
    as_given = np.concatenate([polygons.as_given.xy for polygons in placed])[vertices]
    return replace(made, xy=as_given).moved(made.xy)


def _all_sites(
    whole: FeatureShapes,
    parts: Sequence[BatchShapes],
    polygons: Sequence[NDArray[np.int32]],
    places: Sequence[Places],
) -> SiteTable:
    columns: dict[str, list[NDArray[Any]]] = {}
    for shapes, numbers in zip(parts, polygons, strict=True):
        own = shapes.placed.sites
        rings = np.append(shapes.batch.rings, -1)  # -1 is the last one
        rows: dict[str, NDArray[Any]] = {
            "kind": own.kind,
            "polygon": numbers[own.polygon],
            "ring": own.ring,
            "index": own.index,
            "source_ring": rings[own.source_ring].astype(np.int32),
            "source_index": own.source_index,
        }
        for name, values in rows.items():
            columns.setdefault(name, []).append(values)
    counts = [len(shapes.graph.points) for shapes in parts]
    made: dict[str, Any] = {
        name: np.concatenate(
            [
                places[0].arranged([column[:count] for column, count in zip(values, counts, strict=True)]),
                places[1].arranged([column[count:] for column, count in zip(values, counts, strict=True)]),
            ]
        )
        for name, values in columns.items()
    }
    if not made:
        nothing = np.empty(0, dtype=np.int32)
        return SiteTable(nothing.astype(np.int8), nothing, nothing, nothing, nothing, nothing)
    if whole.corners is not None:
        _tell_given_vertices(whole, made)
    return SiteTable(**made)


def _tell_given_vertices(whole: FeatureShapes, columns: dict[str, NDArray[Any]]) -> None:
    """Tell the vertices of the input instead of those that are left of it."""
    assert whole.corners is not None
    ring, index = columns["source_ring"], columns["source_index"]
    known = np.flatnonzero(ring >= 0)
    vertex = whole.corners.vertex[whole.used.ring_starts[ring[known]] + index[known]]
    index = index.copy()
    index[known] = vertex - whole.given.ring_starts[ring[known]]
    columns["source_index"] = index
