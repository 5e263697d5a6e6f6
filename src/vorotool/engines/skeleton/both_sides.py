"""Skeletons of both sides: inside each feature by itself, and outside of all of them."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.arrangement.planar_graph import arranged, placed_vertices
from vorotool.engines.arrangement.repaired_polygons import PlacedShapes
from vorotool.engines.features.batches import are_apart
from vorotool.engines.skeleton.exact import ShapeDiagram, diagram_of_graph, skeleton_of, warn_empty
from vorotool.engines.skeleton.parts import PER_ARC
from vorotool.engines.skeleton.per_feature import feature_skeleton
from vorotool.errors import VorotoolWarning
from vorotool.numeric.parallel import Progress
from vorotool.types.box import Extent
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import EDGE, SiteTable, Skeleton


def sides_of(
    shapes: ShapeDiagram, *, side: str, frame: Extent | None = None, threads: int = 0, progress: Progress = None
) -> Skeleton:
    """Give what is outside of the features of one arrangement, and what is inside each of them by itself."""
    common: dict[str, Any] = {"threads": threads, "progress": progress}
    if side == "exterior" or are_apart(shapes.graph):
        return replace(skeleton_of(shapes, side=side, frame=frame, **common), features="separate")
    polygons = shapes.graph.polygons
    assert polygons is not None
    with warnings.catch_warnings(
        action="ignore", category=VorotoolWarning
    ):  # repairs were told where all were put together
        inside = feature_skeleton(polygons, **common).skeleton
    if not len(inside):
        warn_empty(polygons, side)
    placement = placed_vertices(inside.polygons, **common)
    again = diagram_of_graph(arranged(inside.polygons, placement, progress=progress).graph, **common)
    # outlines of pixels are cut where only neighbors meet, and stay outlines of pixels
    placed = replace(again.placed.polygons, connectivity=inside.polygons.connectivity)
    again = replace(again, placed=replace(again.placed, polygons=placed))
    outside = skeleton_of(again, side="exterior", frame=frame, **common)
    return joined_sides(inside, outside, again.placed, again.graph)


def joined_sides(inside: Skeleton, outside: Skeleton, placed: PlacedShapes, graph: PlanarGraph) -> Skeleton:
    """Put what is inside features and what is outside of all into one skeleton."""
    sites, shift = joined_sites(inside.polygons, inside.site_table, placed, graph)
    nodes, branches = len(inside.vertices), int(inside.branch.max(initial=-1)) + 1
    moved = {
        "arcs": outside.arcs + np.int32(nodes),
        "sites": outside.sites + np.int32(shift),
        "branch": outside.branch + np.int32(branches),
    }
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(inside, name), moved.get(name, getattr(outside, name))])
        for name in (*PER_ARC, "vertices", "radius")
    }
    return replace(inside, **columns, site_table=sites, frame=outside.frame)


def joined_sites(
    polygons: PolygonSet, table: SiteTable, placed: PlacedShapes, graph: PlanarGraph
) -> tuple[SiteTable, int]:
    """Sites of features, followed by those of an arrangement of their polygons if these are others."""
    if placed.polygons.xy.tobytes() == polygons.xy.tobytes() and _are_equal(placed.sites, table):
        return table, 0
    own = _on_polygons(polygons, table, graph)
    ends = np.full((len(table), 2, 2), np.nan)
    assert own.ends is not None
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(table, name), getattr(own, name)])
        for name in ("kind", "polygon", "ring", "index", "source_ring", "source_index")
    }
    return SiteTable(**columns, ends=np.concatenate([ends, own.ends])), len(table)


def _are_equal(one: SiteTable, other: SiteTable) -> bool:
    return all(
        np.array_equal(getattr(one, name), getattr(other, name)) for name in ("kind", "polygon", "ring", "index")
    )


def _on_polygons(polygons: PolygonSet, table: SiteTable, graph: PlanarGraph) -> SiteTable:
    """Sites of an arrangement, each at a vertex of its polygons or on the edge after it, with its ends."""
    count = len(graph.points)
    edge = graph.source_edge[graph.source_starts[:-1]].astype(np.int64)
    beside = np.zeros(count, dtype=np.int64)  # an edge that ends at each point
    beside[graph.segments] = edge[:, None]
    vertex = np.concatenate([np.where(graph.point_vertex >= 0, graph.point_vertex, beside), edge])
    kind = np.repeat([1 - EDGE, EDGE], [count, len(edge)]).astype(np.int8)
    ring = np.searchsorted(polygons.ring_starts, vertex, side="right") - 1
    polygon = polygons.ring_polygon[ring]
    index = (vertex - polygons.ring_starts[ring]).astype(np.int32)
    places = graph.coordinates()
    ends = np.concatenate([np.repeat(places[:, None], 2, axis=1), places[graph.segments]])
    source = _sources(polygons, table)[kind, vertex]
    source[:count][graph.point_vertex < 0] = -1
    first = polygons.polygon_starts[polygon]
    return SiteTable(kind, polygon, (ring - first).astype(np.int32), index, source[:, 0], source[:, 1], ends)


def _sources(polygons: PolygonSet, table: SiteTable) -> NDArray[np.int32]:
    """(2, n, 2) the ring and index in the input of each vertex of used polygons, and of the edge after it; or -1."""
    source = np.full((2, len(polygons.xy), 2), -1, dtype=np.int32)
    vertex = polygons.ring_starts[polygons.polygon_starts[table.polygon] + table.ring] + table.index
    source[table.kind, vertex] = np.stack([table.source_ring, table.source_index], axis=1)
    return source
