"""How much of each cell is its site's own."""

from __future__ import annotations

import warnings

import numpy as np

from vorotool.engines.voronoi.borders import ridges_of
from vorotool.engines.voronoi.overlay import FrameOverlay, Overlay, RegionOverlay
from vorotool.engines.voronoi.regions import local_diagrams, regions_of
from vorotool.engines.voronoi.site_graph import (
    OwnedGraph,
    diagram_of,
    given_cuts,
    joint_graph,
    owned_graph,
    shared_elements,
)
from vorotool.errors import RepairWarning
from vorotool.numeric.arrays import Floats
from vorotool.numeric.numbers import distinct
from vorotool.types.box import Extent
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.voronoi.shapes import cell_polygons
from vorotool.types.voronoi.tables import site_shapes
from vorotool.types.voronoi.voronoi_map import OUTSIDE, VoronoiMap


def graph_again(cells: VoronoiMap) -> OwnedGraph:
    """The graph that cells were made from; what was repaired has been reported then."""
    with warnings.catch_warnings(action="ignore", category=RepairWarning):
        return owned_graph(cells.polygons, cells.polygon_site)


def ties(cells: VoronoiMap) -> dict[str, int]:
    """Count what several sites have, and the smallest was given: points and segments of their boundaries, and areas."""
    counts = shared_elements(graph_again(cells), cells.polygon_site)
    return dict(zip(("shared_points", "shared_segments", "overlaps"), counts, strict=True))


def own_areas(cells: VoronoiMap) -> Floats:
    """(s,) the area of its site's own polygons in each cell, without what smaller sites cover and cuts take away."""
    owned = graph_again(cells)
    made: Floats = np.zeros(len(cells))
    covered = owned.face >= 0
    np.add.at(made, owned.face[covered], _face_areas(owned.graph, cells.frame)[covered])
    if cells.clip is not None:
        _cut_to_cells(made, cells)
    made[cells.components == 0] = 0
    return made


def _face_areas(graph: PlanarGraph, frame: Extent) -> Floats:
    """(f,) areas of faces within a frame, with the corners that were given."""
    x, y, w, h = frame
    at = graph.coordinates_as_given
    is_out = (at != at.clip([x, y], [x + w, y + h])).any(axis=1)
    doubled, is_cut = np.zeros(graph.faces), np.zeros(graph.faces, dtype=bool)
    near = np.zeros((graph.faces, 2))  # a corner of each: products are of the size of the face
    for hand in (0, 1):
        near[graph.segment_faces[:, hand]] = at[graph.segments[:, 0]]
    for hand, sign in ((0, 1), (1, -1)):
        face = graph.segment_faces[:, hand]
        a, b = at[graph.segments.T] - near[face]
        np.add.at(doubled, face, sign * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))
        is_cut[face[is_out[graph.segments].any(axis=1)]] = True
    area: Floats = doubled / 2
    if is_cut.any():
        chosen = np.flatnonzero(is_cut[graph.segment_faces].any(axis=1))
        below = _below(at[graph.segments[chosen, 0]] - [x, y], at[graph.segments[chosen, 1]] - [x, y], w, h)
        within = np.zeros(graph.faces)
        for hand, sign in ((0, -1), (1, 1)):
            np.add.at(within, graph.segment_faces[chosen, hand], sign * below)
        area[is_cut] = np.maximum(within[is_cut], 0)
    return area


def _below(source: Floats, target: Floats, w: float, h: float) -> Floats:
    """(k,) areas between segments and the lower side of a frame with its corner at 0, within it; above 0 rightwards."""
    way = target - source
    left, right = source[:, 0].clip(0, w), target[:, 0].clip(0, w)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.where(way[:, 0] != 0, way[:, 1] / way[:, 0], 0)
        first, last = (source[:, 1] + (x - source[:, 0]) * slope for x in (left, right))
        stops = np.stack([(bound - first) / (last - first) for bound in (0, h)])
    stops = np.sort(np.where(np.isfinite(stops), stops, 0).clip(0, 1), axis=0)
    stops = np.concatenate([np.zeros((1, len(way))), stops, np.ones((1, len(way)))])
    height = (first + stops * (last - first)).clip(0, h)
    return (right - left) * (np.diff(stops, axis=0) * (height[:-1] + height[1:])).sum(axis=0) / 2


def _cut_to_cells(areas: Floats, cells: VoronoiMap) -> None:
    """Measure anew what of sites is in cells that have a cut: polylines instead of curves cross no site."""
    import shapely

    at = distinct(cells.sites[cells.is_cut])
    at = at[at != OUTSIDE]
    shapes = cell_polygons(cells, None)[at]
    of_sites = shapely.union_all(site_shapes(cells)[at][:, None], axis=1)
    areas[at] = shapely.area(shapely.intersection(shapes, of_sites))


_TIE = 2.0**-40
"""By which a distance may be above the limit and be the limit, as a part of it: rounding is less."""

_ENDS = 2
"""Vertices of a segment; a point has fewer."""


def reaches(cells: VoronoiMap) -> Floats:
    """(s,) the largest distance that a place of each cell has from its site; NaN of empty cells."""
    made = np.full(len(cells), -np.inf)
    _take_vertices(made, cells)
    if _has_ridges(cells):
        _take_ridges(made, cells)
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


def _take_ridges(reach: Floats, cells: VoronoiMap) -> None:
    """Raise reaches to distances of the ends of ridges, which are cut as borders are."""
    cut = _ridges(cells)
    site, limit = cut.borders.sites[cut.pieces.piece, 0], np.inf if cells.max_distance is None else cells.max_distance
    for radius in cut.graph.scale * cut.end_radii().T:
        near = radius <= limit * (1 + _TIE)  # what is beyond the limit is in no cell
        np.maximum.at(reach, site[near], np.minimum(radius[near], limit))


def _ridges(cells: VoronoiMap) -> Overlay:
    if cells.clip is None and cells.enclosures is None:
        owned = graph_again(cells)
        return FrameOverlay(ridges_of(owned, diagram_of(owned)), owned.graph, cells.frame)
    with warnings.catch_warnings(action="ignore", category=RepairWarning):
        cuts = given_cuts(cells.clip, cells.enclosures, cells.crs)
        joint = joint_graph(cells.polygons, cuts.sides_near(cells.frame), cuts.clip, cuts.enclosures)
    regions = regions_of(joint, cells.polygon_site, len(cells))
    local = local_diagrams(joint.sites, cells.polygon_site, len(cells), regions, pieces_of=ridges_of)
    return RegionOverlay(local, regions.edges, joint.graph)
