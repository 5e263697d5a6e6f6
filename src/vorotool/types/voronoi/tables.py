"""Tables of a Voronoi map: its borders, pairs of neighbors, and one row a cell."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, Indices
from vorotool.types.features import Rows
from vorotool.types.identity import with_ends
from vorotool.types.polygons.shapely_geometry import used_shapes
from vorotool.types.table import Computed, Lookup, Table
from vorotool.types.voronoi.voronoi_map import VoronoiMap

KINDS = ["line", "parabola", "circle"]
"""Of arcs."""


def kinds_of(cells: VoronoiMap) -> NDArray[np.int32]:
    """(a,) the kind of each arc, a number among `KINDS`."""
    return np.where(cells.is_circle, 2, cells.is_parabola).astype(np.int32)


def border_table(cells: VoronoiMap) -> Table:
    """Return one row an arc between two cells."""
    arc = np.flatnonzero(cells.is_border)
    low, high = np.sort(cells.sites[arc], axis=1).T
    source, target = np.ascontiguousarray(cells.arcs[arc].T)
    x, y = np.ascontiguousarray(cells.vertices.T)
    cx, cy = np.ascontiguousarray(cells.control[arc].T)
    return with_ends(
        {
            "label_a": cells.labels[low],
            "label_b": cells.labels[high],
            "kind": Lookup(KINDS, kinds_of(cells)[arc]),
            "x0": Lookup(x, source),
            "y0": Lookup(y, source),
            "x1": Lookup(x, target),
            "y1": Lookup(y, target),
            "cx": cx,
            "cy": cy,
            "length": cells.length[arc],
            "arc": arc,
            "r0": cells.radius[source],
            "r1": cells.radius[target],
        },
        cells.properties,
        {"a": low, "b": high},
    )


def neighbor_pairs(cells: VoronoiMap) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """(n, 2) pairs of cells that share a border of positive length, ascending, and (n,) its length."""
    arc = np.flatnonzero(cells.is_border & (cells.length > 0))
    pair = np.sort(cells.sites[arc], axis=1).astype(np.int64)
    key, row = np.unique(pair[:, 0] * max(len(cells), 1) + pair[:, 1], return_inverse=True)
    pairs = np.stack(np.divmod(key, max(len(cells), 1)), axis=1)
    length: NDArray[np.float64] = np.bincount(row, cells.length[arc], minlength=len(key)).astype(np.float64)
    return pairs, length


def neighbor_table(cells: VoronoiMap) -> Table:
    """Return one row a pair of cells that share a border; cells that meet in places only are none."""
    pairs, length = neighbor_pairs(cells)
    low, high = cells.labels[pairs.T]
    distance = _when_asked(lambda: site_distances(cells, pairs), len(pairs))
    columns = {"label_a": low, "label_b": high, "border_length": length, "distance": distance}
    return with_ends(columns, cells.properties, dict(zip("ab", pairs.T, strict=True)))


def cell_table(cells: VoronoiMap) -> Table:
    """Return one row a cell."""
    pairs, _ = neighbor_pairs(cells)
    columns: dict[str, Any] = {"label": cells.labels}
    if cells.ids is not None:
        columns["id"] = list(cells.ids)
    columns |= {
        "area": cells.areas,
        "perimeter": cells.perimeters,
        "neighbors": np.bincount(pairs.ravel(), minlength=len(cells)),
        "own_area": _when_asked(lambda: cells.own_areas, len(cells)),
        "max_distance": _when_asked(lambda: cells.reaches, len(cells)),
        "components": cells.components,
    }
    return Table(columns).with_properties(cells.other_columns)


def map_rows(cells: VoronoiMap, what: str | None) -> Rows | None:
    """Return the rows of a part, by default of the cells; None if these are to have their geometry."""
    if what == "cells":
        return None
    if what in ("edges", "neighbors"):
        return Rows(border_table(cells) if what == "edges" else neighbor_table(cells))
    return Rows(cell_table(cells), {}, cells, np.arange(len(cells)))


def _when_asked(function: Callable[[], NDArray[np.float64]], size: int) -> Computed:
    """A column that is computed as a whole, once, by the first thread that asks for rows of it."""
    lock, once = Lock(), cache(function)

    def rows_of(rows: slice) -> NDArray[np.float64]:
        with lock:
            return once()[rows]

    return Computed(rows_of, size)


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
