"""The sites of a Voronoi map as geometry, and how far they are from each other."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.types.polygons.used_shapes import used_shapes
from vorotool.types.voronoi.voronoi_map import VoronoiMap

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_MANY = 1 << 20
"""Pairs of vertices of two shapes that are gone through one by one, in some milliseconds; of more there is a tree."""


def site_shapes(cells: VoronoiMap) -> NDArray[Any]:
    """(s,) what each site bounds or is, as one collection of shapely; an empty one of a site without places."""
    import shapely

    parts = used_shapes(cells.polygons)
    shapes = np.full(len(cells), shapely.GeometryCollection(), dtype=object)
    order = np.argsort(cells.polygon_site, kind="stable")
    if len(order):
        numbers, rows = np.unique(cells.polygon_site[order], return_inverse=True)
        shapes[numbers] = shapely.geometrycollections(parts[order], indices=rows)
    return shapes


def site_distances(cells: VoronoiMap, pairs: Indices) -> Floats:
    """(n,) distances between two sites each; 0 where they touch or overlap."""
    import shapely

    shapes = site_shapes(cells)
    sizes = shapely.get_num_coordinates(shapes)
    is_long = sizes[pairs].prod(axis=1) > _MANY
    distance = np.empty(len(pairs))
    distance[~is_long] = shapely.distance(*shapes[pairs[~is_long]].T)
    larger = np.where(sizes[pairs[:, 0]] >= sizes[pairs[:, 1]], 0, 1)
    long = np.flatnonzero(is_long)
    of = pairs[long, larger[long]]
    for site in np.unique(of).tolist():
        rows = long[of == site]
        others = pairs[rows, 1 - larger[rows]]
        distance[rows] = _from_one(shapes[site], shapes[others])
    return distance


def _from_one(shape: Any, others: NDArray[Any]) -> Floats:
    """(n,) distances of shapes from one with many vertices, by a tree of its segments."""
    import shapely

    tree = shapely.STRtree(_segments([shape])[0])
    segments, owner = _segments(others)
    found, between = tree.query_nearest(segments, all_matches=False, return_distance=True)
    distance = np.full(len(others), np.inf)
    np.minimum.at(distance, owner[found[0]], between)
    shapely.prepare(shape)
    distance[shapely.intersects(shape, others)] = 0
    return distance


def _segments(shapes: Any) -> tuple[NDArray[Any], Indices]:
    """Edges of shapes, and lone points, as lines and points; and of which each is."""
    import shapely

    owner = np.arange(len(shapes))
    parts = np.array(shapes, dtype=object)
    while (shapely.get_type_id(parts) > 3).any():
        parts, index = shapely.get_parts(parts, return_index=True)
        owner = owner[index]
    is_polygon, is_point = shapely.get_type_id(parts) == 3, shapely.get_type_id(parts) == 0
    rings, index = shapely.get_rings(parts[is_polygon], return_index=True)
    lines = np.concatenate([rings, parts[~is_polygon & ~is_point]])
    of_lines = np.concatenate([owner[is_polygon][index], owner[~is_polygon & ~is_point]])
    xy, line = shapely.get_coordinates(lines, return_index=True)
    is_first = line[:-1] == line[1:]
    pieces = shapely.linestrings(np.stack([xy[:-1][is_first], xy[1:][is_first]], axis=1))
    return np.concatenate([pieces, parts[is_point]]), np.concatenate([of_lines[line[:-1][is_first]], owner[is_point]])
