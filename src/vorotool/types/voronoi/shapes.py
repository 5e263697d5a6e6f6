"""Cells of a Voronoi map as polygons, with polylines instead of curves."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.flatten import circle_tolerances, curve_tolerances, least_focal_distances
from vorotool.numeric.ragged import Nesting, owners, starts_of, within
from vorotool.products.formats import resolved
from vorotool.types.features import Areas, Lines, Rows, without_places
from vorotool.types.voronoi.cut_corners import with_feet_of_corners
from vorotool.types.voronoi.tables import border_table, cell_table
from vorotool.types.voronoi.voronoi_map import VoronoiMap

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

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
    most[paired] = np.fmin(most[paired], np.sqrt((bend * bend).sum(axis=1)) / _BEND_OF_TWO)
    most[paired] = np.minimum(most[paired], arcs[paired].sagittas / 2)
    return with_feet_of_corners(cells, *arcs.polylines(most), most)


def _in_pairs(cells: VoronoiMap) -> Indices:
    """Arcs of rings of two: of one piece each they would hold nothing."""
    first = cells.ring_starts[:-1][np.diff(cells.ring_starts) == 2]
    arcs: Indices = np.abs(cells.ring_arcs[np.concatenate([first, first + 1])].astype(np.int64)) - 1
    return arcs


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
    made: NDArray[Any] = resolved("convert.geometry:shapely_of")(map_features(cells, "cells", tolerance).geometry)
    return made


def map_features(cells: VoronoiMap, what: str | None, tolerance: float | None) -> Rows:
    """Return the rows of borders, or of cells; only without a part with all columns of their table, some slow."""
    every = np.arange(len(cells))
    if what == "edges":
        return _borders(cells, tolerance)
    points, start = cell_rings(cells, tolerance)
    areas = Areas(points, Nesting(start, cells.polygon_starts, cells.cell_starts))
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
