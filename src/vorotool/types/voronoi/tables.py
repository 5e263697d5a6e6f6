"""Tables of a Voronoi map: its borders, pairs of neighbors, and one row a cell."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, Indices, Nesting, crosses, dots, norms, owners, starts_of, within
from vorotool.numeric.curves.flatten import circle_tolerances, curve_tolerances, least_focal_distances
from vorotool.numeric.curves.mixed_arcs import MixedArcs
from vorotool.numeric.numbers import distinct
from vorotool.products.formats import resolved
from vorotool.types.features import Areas, Lines, Rows, without_places
from vorotool.types.identity import with_ends
from vorotool.types.polygons.shapely_geometry import used_shapes
from vorotool.types.table import Computed, Lookup, Table
from vorotool.types.voronoi.voronoi_map import VoronoiMap

PART_OF_RADIUS = 0.25
"""How far a polyline may be from its curve, as a part of the smallest distance of that from the sites."""

_BEND_OF_TWO = 10
"""A parabola that may be off by its second difference over this is divided in two: more than 4, at most 16."""


def flattened_arcs(cells: VoronoiMap, tolerance: float | None) -> tuple[Floats, Indices]:
    """Return each arc as a polyline, from its source to its target."""
    arcs = cells.mixed_arcs
    least = least_focal_distances(arcs.source, arcs.control, arcs.target)
    ends = np.stack([arcs.source, arcs.target], axis=1)
    clearance = np.where(np.isfinite(least), least, 0)
    most = np.minimum(curve_tolerances(ends, clearance, tolerance), PART_OF_RADIUS * least)
    if cells.max_distance is not None:
        at = np.flatnonzero(cells.is_circle)
        radius = np.full(len(at), cells.max_distance)
        most[at] = np.minimum(circle_tolerances(arcs.center[at], radius, tolerance), PART_OF_RADIUS * radius)
    paired = _in_pairs(cells)
    bend = (arcs.source - 2 * arcs.control + arcs.target)[paired]
    most[paired] = np.fmin(most[paired], norms(bend) / _BEND_OF_TWO)
    most[paired] = np.minimum(most[paired], arcs[paired].sagittas / 2)
    return with_feet_of_corners(cells, *arcs.polylines(most), most)


def _in_pairs(cells: VoronoiMap) -> Indices:
    """Arcs of rings of two: of one piece each they would hold nothing."""
    first = cells.ring_starts[:-1][np.diff(cells.ring_starts) == 2]
    return np.abs(cells.ring_arcs[np.concatenate([first, first + 1])].astype(np.int64)) - 1


def cell_rings(cells: VoronoiMap, tolerance: float | None) -> tuple[Floats, Indices]:
    """Return the vertices of all rings of cells, the first of each not repeated."""
    points, start = flattened_arcs(cells, tolerance)
    arc, is_back = np.abs(cells.ring_arcs.astype(np.int64)) - 1, cells.ring_arcs < 0
    sizes = np.diff(start)[arc] - 1
    row = owners(sizes)
    step = within(sizes)
    taken = np.where(is_back[row], start[arc + 1][row] - 1 - step, start[arc][row] + step)
    return points[taken], starts_of(sizes)[cells.ring_starts]


def cell_polygons(cells: VoronoiMap, tolerance: float | None) -> NDArray[Any]:
    """(s,) each cell as a polygon or multipolygon of shapely; what two cells share is the same in both, bit for bit."""
    return resolved("convert.frames:shapely_of")(cell_areas(cells, tolerance))


def cell_areas(cells: VoronoiMap, tolerance: float | None) -> Areas:
    """Return each cell with polylines for curves."""
    points, start = cell_rings(cells, tolerance)
    return Areas(points, Nesting(start, cells.polygon_starts, cells.cell_starts))


def map_features(cells: VoronoiMap, what: str | None, tolerance: float | None) -> Rows:
    """Return the rows of borders, or of cells; only without a part with all columns of their table, some slow."""
    every = np.arange(len(cells))
    if what == "edges":
        return _borders(cells, tolerance)
    areas = cell_areas(cells, tolerance)
    if what == VoronoiMap._plain:
        return Rows({}, {}, cells, every, areas)
    if what is None:
        return Rows(cell_table(cells), {}, cells, every, areas)
    further = dict(cells.other_columns)
    ids = further.pop("id", None) if cells.ids is None else list(cells.ids)
    names = {"label": cells.labels} | ({} if ids is None else {"id": ids})
    columns = {**names, "area": cells.areas, "perimeter": cells.perimeters}
    return Rows(columns, further, cells, every, areas, ids=cells.labels)


_LEFT_OUT = "x0", "y0", "x1", "y1", "cx", "cy", "r0", "r1", "arc"
"""Columns of the table of borders that features do not have."""


def _borders(cells: VoronoiMap, tolerance: float | None) -> Rows:
    """Return a row a piece of a border, in the order of the table."""
    points, start = flattened_arcs(cells, tolerance)
    sizes, shown = np.diff(start), cells.is_border
    geometry = Lines(points[shown[owners(sizes)]], starts_of(sizes[shown]))
    return Rows(without_places(border_table(cells), *_LEFT_OUT), {}, cells, None, geometry)


def with_feet_of_corners(
    cells: VoronoiMap, points: Floats, start: Indices, tolerance: Floats
) -> tuple[Floats, Indices]:
    """Add to polylines the feet of corners of cuts that may be between them and their curves."""
    curved = np.flatnonzero(cells.is_parabola | cells.is_circle)
    if (cells.clip is None and cells.enclosures is None) or not curved.size:
        return points, start
    import shapely

    arcs, corner = cells.mixed_arcs, distinct(cells.arcs[cells.is_cut])
    hulls = shapely.polygons(_hulls(arcs[curved]))
    row, at = shapely.STRtree(shapely.points(cells.vertices[corner])).query(hulls, predicate="intersects")
    arc, vertex = curved[row], corner[at]
    place = cells.vertices[vertex]
    own = arcs[arc]
    from_circles = np.abs(norms(place - own.center) - norms(own.source - own.center))
    near = np.where(own.is_circle, from_circles, _from_parabolas(own, place))
    chosen = (cells.arcs[arc] != vertex[:, None]).all(axis=1) & (near <= 2 * tolerance[arc])
    arc, place = arc[chosen], place[chosen]
    if not arc.size:
        return points, start
    rows = np.concatenate([owners(np.diff(start)), arc])
    places = np.concatenate([points, _feet(arcs[arc], place)])
    key = _along(arcs, rows, places)
    key[start[:-1]], key[start[1:] - 1] = -np.inf, np.inf
    others = np.flatnonzero(~np.isin(rows, arc))
    key[others] = others
    is_end = np.isinf(key)
    order = np.lexsort((key, rows))
    rows, places, is_end = rows[order], places[order], is_end[order]
    same = np.isin(rows[1:], arc) & (rows[1:] == rows[:-1]) & (places[1:] == places[:-1]).all(axis=1)
    kept = np.ones(len(rows), dtype=bool)
    kept[1:][same & ~is_end[1:]] = False
    kept[:-1][same & is_end[1:] & ~is_end[:-1]] = False
    return places[kept], starts_of(np.bincount(rows[kept], minlength=len(cells.arcs)))


def _axes(arcs: MixedArcs) -> Floats:
    """(k, 2) unit vectors across the axes of parabolas, on from source to target."""
    axis = arcs.source - 2 * arcs.control + arcs.target
    size = norms(axis)
    across = np.stack([-axis[:, 1], axis[:, 0]], axis=1) / np.where(size > 0, size, 1)[:, None]
    forward = np.sign(dots(across, arcs.target - arcs.source))
    return across * forward[:, None]


def _feet(arcs: MixedArcs, place: Floats) -> Floats:
    """(k, 2) places on curves: in the direction of the axis of a parabola, or of the center of a circle."""
    across = _axes(arcs)
    whole = dots(across, arcs.target - arcs.source)
    t = dots(across, place - arcs.source) / np.where(whole > 0, whole, 1)
    t = t.clip(0, 1)[:, None]
    feet = (1 - t) * (1 - t) * arcs.source + 2 * t * (1 - t) * arcs.control + t * t * arcs.target
    offset = place - arcs.center
    scale = norms(arcs.source - arcs.center) / norms(offset)
    return np.where(arcs.is_circle[:, None], arcs.center + scale[:, None] * offset, feet)


def _along(arcs: MixedArcs, arc: Indices, place: Floats) -> Floats:
    """(k,) numbers that rise along arcs: across the axis of a parabola, the half angle on a circle."""
    own = arcs[arc]
    key: Floats = np.nan_to_num(dots(_axes(own), place - own.source))
    circle = np.flatnonzero(own.is_circle)
    round_arcs = own[circle]
    middle, offset = _middles(round_arcs), place[circle] - round_arcs.center
    ahead = norms(middle) * norms(offset) + dots(middle, offset)
    turned = crosses(middle, offset) / np.where(ahead > 0, ahead, 1)
    key[circle] = np.where(round_arcs.is_left, turned, -turned)
    return key


def _middles(arcs: MixedArcs) -> Floats:
    """(k, 2) directions of the middles of circular arcs."""
    a, b = arcs.source - arcs.center, arcs.target - arcs.center
    chord = np.where(arcs.is_left[:, None], b - a, a - b)
    across = np.stack([chord[:, 1], -chord[:, 0]], axis=1)
    return np.where((dots(a, b) > 0)[:, None], a + b, across)


def _hulls(arcs: MixedArcs) -> Floats:
    """(k, 5, 2) closed rings around curves: two chords or tangents, and the chord between both ends."""
    corner = [arcs.control, arcs.control]
    if arcs.is_circle.any():
        a, b = arcs.source - arcs.center, arcs.target - arcs.center
        middle = _middles(arcs)
        square = dots(a, a)[:, None]
        size = norms(middle)[:, None]
        middle = middle * np.sqrt(square) / np.where(size > 0, size, 1)
        of_circles = [arcs.center + (one + middle) * square / (square + dots(one, middle)[:, None]) for one in (a, b)]
        corner = [np.where(arcs.is_circle[:, None], circle, arcs.control) for circle in of_circles]
    return np.stack([arcs.source, *corner, arcs.target, arcs.source], axis=1)


def _from_parabolas(arcs: MixedArcs, place: Floats) -> Floats:
    """(k,) no more than the distance of places in the triangles of Bezier curves from these."""
    a, b, c = arcs.source, arcs.control, arcs.target
    double = crosses(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        u, w = crosses(b - place, c - place) / double, crosses(a - place, b - place) / double
        rise = (2 * norms(c - a) + 4 * (norms(c - b) + norms(b - a))) / np.abs(double)
        near: Floats = np.abs((1 - u - w) * (1 - u - w) - 4 * u * w) / rise
    return np.where(np.isfinite(near), near, 0)


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
