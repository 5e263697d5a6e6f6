"""How far cells reach from their sites."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.borders import ridges_of
from vorotool.engines.voronoi.crossings import crossings_of
from vorotool.engines.voronoi.cut_arguments import given_cuts
from vorotool.engines.voronoi.diagram import diagram_of
from vorotool.engines.voronoi.frame_cut import FrameOverlay
from vorotool.engines.voronoi.joint_graph import joint_graph
from vorotool.engines.voronoi.local_diagrams import local_diagrams
from vorotool.engines.voronoi.measures import graph_again
from vorotool.engines.voronoi.regions import regions_of
from vorotool.errors import RepairWarning
from vorotool.types.voronoi.shapes import cell_polygons
from vorotool.types.voronoi.site_shapes import site_shapes
from vorotool.types.voronoi.voronoi_map import OUTSIDE, VoronoiMap

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_TIE = 2.0**-40
"""By which a distance may be above the limit and be the limit, as a part of it: rounding is less."""

_ENDS = 2
"""Vertices of a segment; a point has fewer."""


def reaches(cells: VoronoiMap) -> Floats:
    """(s,) the largest distance that a place of each cell has from its site; NaN of empty cells."""
    made = np.full(len(cells), -np.inf)
    _take_vertices(made, cells)
    if _has_ridges(cells):
        is_cut = cells.clip is not None or cells.enclosures is not None
        (_take_ridges_between_cuts if is_cut else _take_ridges_in_frame)(made, cells)
    made[cells.components == 0] = np.nan
    return made


def _has_ridges(cells: VoronoiMap) -> bool:
    """Whether a site is more than a point or a segment, from which distances are convex, and largest at vertices."""
    given = cells.polygons
    is_single = np.bincount(cells.polygon_site, minlength=len(cells)) <= 1
    is_straight = given.is_line & (np.diff(given.ring_starts)[given.polygon_starts[:-1]] <= _ENDS)
    return not (is_single.all() and is_straight.all())


def _take_vertices(reach: Floats, cells: VoronoiMap) -> None:
    import shapely

    site, vertex = np.tile(cells.sites, 2).ravel(), np.repeat(cells.arcs, 2, axis=1).ravel()
    inner = site != OUTSIDE
    site, vertex = site[inner], vertex[inner]
    radius = cells.radius[vertex]
    unknown = np.isnan(radius)
    if unknown.any():
        shapes = site_shapes(cells)[site[unknown]]
        radius[unknown] = shapely.distance(shapes, shapely.points(cells.vertices[vertex[unknown]]))
    np.maximum.at(reach, site, radius)


def _take_ridges_in_frame(reach: Floats, cells: VoronoiMap) -> None:
    owned = graph_again(cells)
    ridges = ridges_of(owned, diagram_of(owned))
    cut = FrameOverlay(ridges, owned.graph, cells.frame)
    for radius in owned.graph.scale * cut.found.radius[cut.pieces.ends].T:
        _take(reach, cells, ridges.sites[cut.pieces.piece, 0], radius)


def _take_ridges_between_cuts(reach: Floats, cells: VoronoiMap) -> None:
    """Cut ridges as borders are; of their ends those count that lie in the cells."""
    import shapely

    with warnings.catch_warnings(action="ignore", category=RepairWarning):
        cuts = given_cuts(cells.clip, cells.enclosures, cells.crs)
        joint = joint_graph(cells.polygons, cuts.sides_near(cells.frame), cuts.clip, cuts.enclosures)
    regions = regions_of(joint, cells.polygon_site, len(cells))
    local = local_diagrams(joint.sites, cells.polygon_site, len(cells), regions, pieces_of=ridges_of)
    ridges, scale = local.borders, joint.sites.scale
    found = crossings_of(local, regions.edges)
    stops = found.curves[found.stop_row].radius(found.stop_t)
    _take(reach, cells, ridges.sites[found.pieces[found.stop_row], 0], scale * stops)
    end, row = np.unique(ridges.ends, return_index=True)
    site, end = ridges.sites[row // 2, 0][end >= 0], end[end >= 0]
    radius = scale * ridges.radius[end]
    higher = np.flatnonzero(radius > reach[site])
    site, end, radius = site[higher], end[higher], radius[higher]
    shapes = cell_polygons(cells, None)
    inside = shapely.intersects(shapes[site], shapely.points(joint.sites.coordinates(ridges.places[end])))
    _take(reach, cells, site[inside], radius[inside])


def _take(reach: Floats, cells: VoronoiMap, site: NDArray[np.integer], radius: Floats) -> None:
    """Raise reaches to distances of places; what is beyond the limit is in no cell."""
    limit = np.inf if cells.max_distance is None else cells.max_distance
    near = radius <= limit * (1 + _TIE)
    np.maximum.at(reach, site[near], np.minimum(radius[near], limit))
