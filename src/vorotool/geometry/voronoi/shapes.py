"""Cells of a Voronoi map as polygons, with polylines instead of curves."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.curves.flatten import circle_tolerances, curve_tolerances, least_focal_distances
from vorotool.geometry.mesh.cells import Nesting
from vorotool.geometry.ragged import owners, starts_of, within
from vorotool.geometry.voronoi.cut_corners import with_feet_of_corners
from vorotool.geometry.voronoi.voronoi_map import VoronoiMap
from vorotool.products.formats import resolved

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

PART_OF_RADIUS = 0.25
"""How far a polyline may be from its curve, as a part of the smallest distance of that from the sites."""

_BEND_OF_TWO = 10
"""A parabola that may be off by its second difference over this is divided in two: more than 4, at most 16."""


def flattened_arcs(cells: VoronoiMap, tolerance: float | None) -> tuple[Floats, Indices]:
    """Give each arc as a polyline, from its source to its target.

    A chord of a parabola lies in the sector of the cell between the focus and the parabola as long as it is nearer to
    the parabola than the focus is; and that of a circular arc in the sector between the centre and the arc. So
    polylines cross neither sites nor each other, whatever the tolerance. They do not pass corners of clips and
    enclosures either.

    Parameters
    ----------
    cells : VoronoiMap
        With the arcs.
    tolerance : float, optional
        How far polylines may be from curves; where these come nearer to sites, a fourth of that distance. By default
        1/2000 of the radius of circular arcs, of other curves the larger of 1/2000 of their extent and 1/100 of their
        least distance from sites.

    Returns
    -------
    points : (n, 2) float64 array
        Places along each arc, its ends included.
    start : (a + 1,) int64 array
        Where the places of each arc begin.

    Examples
    --------
    >>> from vorotool import voronoi
    >>> cells = voronoi(["LINESTRING (0 0, 4 0)", "POINT (2 2)"], frame=(0, 0, 4, 4))
    >>> int(np.diff(flattened_arcs(cells, 1.0)[1]).max())
    3
    """
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
    most[paired] = np.minimum(most[paired], arcs[paired].sagittas() / 2)
    return with_feet_of_corners(cells, *arcs.polylines(most), most)


def _in_pairs(cells: VoronoiMap) -> Indices:
    """Arcs of rings of two: of one piece each they would hold nothing."""
    first = cells.ring_start[:-1][np.diff(cells.ring_start) == 2]
    arcs: Indices = np.abs(cells.ring_arcs[np.concatenate([first, first + 1])].astype(np.int64)) - 1
    return arcs


def cell_rings(cells: VoronoiMap, tolerance: float | None) -> tuple[Floats, Indices]:
    """Give the vertices of all rings of cells, the first of each not repeated.

    Parameters
    ----------
    cells : VoronoiMap
        With its rings.
    tolerance : float, optional
        As of `flattened_arcs`.

    Returns
    -------
    points : (n, 2) float64 array
        Ring after ring; what two cells share is the same in both, bit for bit.
    start : (r + 1,) int64 array
        Where each ring begins.

    Examples
    --------
    >>> from vorotool import voronoi
    >>> points, start = cell_rings(voronoi([[0, 0], [4, 0]], frame=(0, 0, 4, 2)), 1.0)
    >>> points[start[0] : start[1]].tolist()
    [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]
    """
    points, start = flattened_arcs(cells, tolerance)
    arc, is_back = np.abs(cells.ring_arcs.astype(np.int64)) - 1, cells.ring_arcs < 0
    sizes = np.diff(start)[arc] - 1
    row = owners(sizes)
    step = within(sizes)
    taken = np.where(is_back[row], start[arc + 1][row] - 1 - step, start[arc][row] + step)
    return points[taken], starts_of(sizes)[cells.ring_start]


def cell_polygons(cells: VoronoiMap, tolerance: float | None) -> NDArray[Any]:
    """(s,) each cell as a polygon or multipolygon of shapely; what two cells share is the same in both, bit for bit.

    Parameters
    ----------
    cells : VoronoiMap
        Empty cells are empty polygons.
    tolerance : float, optional
        As of `flattened_arcs`.

    Examples
    --------
    >>> from vorotool import voronoi
    >>> [cell.area for cell in cell_polygons(voronoi([[0, 0], [4, 0]], frame=(0, 0, 4, 2)), 1.0)]
    [4.0, 4.0]
    """
    points, start = cell_rings(cells, tolerance)
    nesting = Nesting(start, cells.polygon_start, cells.cell_start)
    made: NDArray[Any] = resolved("formats.written.rings:valid_coverage")(points, nesting)
    return made
