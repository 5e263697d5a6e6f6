"""The Voronoi diagram of points, lines and polygons (paper, sections 1 and 3.2)."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vorotool.convert.sites import Sites, as_sites
from vorotool.engines.voronoi.borders import borders_of, ridges_of
from vorotool.engines.voronoi.overlay import FrameOverlay, Overlay, RegionOverlay
from vorotool.engines.voronoi.planar_map import (
    Arcs,
    CutMap,
    Rings,
    cells_of,
    cut_map,
    moved_vertices,
    rings_of,
    shells_of,
    without_lost,
)
from vorotool.engines.voronoi.regions import frame_of, local_diagrams, regions_of, site_at
from vorotool.engines.voronoi.site_graph import (
    GivenCuts,
    OwnedGraph,
    diagram_of,
    given_cuts,
    joint_graph,
    owned_graph,
    shared_elements,
)
from vorotool.errors import InputError, RepairWarning, UsageError
from vorotool.numeric.arrays import Floats, crosses
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import distinct, finite_double, shown_number
from vorotool.numeric.parallel import Progress, Run, running
from vorotool.types.box import Extent, as_extent, check_lengths, default_frame, is_extent
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.voronoi.tables import cell_polygons, site_shapes
from vorotool.types.voronoi.voronoi_map import OUTSIDE, VoronoiMap

if TYPE_CHECKING:
    from vorotool.typing import FrameLike, ImageLike, PointsLike, PolygonsLike

LEAST = 2.0**-40
"""Of the largest coordinate: smaller limits are less than what a lattice moves sites by, and near what is rounded."""

_PLACES = ((0.5, 0.5), (0.3125, 0.71875), (0.15625, 0.109375), (0.828125, 0.34375))
"""In a frame, in parts of its sides."""

_BITS = 30
"""Steps of a lattice that a limit around a single place is counted in, as bits: as many as others have."""


def voronoi(
    sites: PointsLike | PolygonsLike | ImageLike,
    *,
    by: str | ArrayLike | None = None,
    clip: PolygonsLike | None = None,
    frame: FrameLike | None = None,
    max_distance: float | None = None,
    enclosures: PolygonsLike | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> VoronoiMap:
    """Compute the Voronoi diagram of points, lines and polygons.

    Each site gets the places nearest to it. All sites are rounded to a lattice of 31 bits and split where they meet.
    After that every decision is exact: of the Voronoi diagram of the vertices and open edges, the edges between
    different sites are kept. Polygons are filled: distances inside are 0. A region equally near to several sites, as
    where polygons overlap or share a corner, belongs to the first; another cell may be empty. The inside of a polygon
    follows from its rings by the even-odd rule; a polygon without inside is a line.

    Parameters
    ----------
    sites : PolygonSet, PointSet, (n, 2) array-like, data frame, geometry of shapely, geopandas, GeoJSON or WKT, image
        Each feature is a site, with all its parts; each row of an array is a point. Each object of a mask or a label
        image is a site, bounded by its outline, in map coordinates if the image is georeferenced.
    by : str or sequence, optional
        Values that join features into sites: a column of the input, or one value per feature. Sites are numbered by
        first appearance.
    clip : PolygonSet, geometry of shapely, geopandas, GeoJSON or WKT, optional
        Polygons that cells are clipped to. Sites outside them count as well. If the frame and the clip have no area in
        common, all cells are empty.
    frame : Box or (x, y, w, h), optional
        Rectangle that cells are clipped to; by default the image, or the bounds, widened by a tenth of their longer
        side, but none with a clip.
    max_distance : float, optional
        Largest distance from a site, in input units: places farther from every site belong to none. The limit is formed
        by parallels of edges and by circular arcs. The default frame contains all of it, but for an image.
    enclosures : PolygonSet, geometry of shapely, geopandas, GeoJSON or WKT, optional
        Lines and boundaries of polygons that divide the plane into faces. Each face is partitioned among the sites that
        meet its inside, by distances to the whole site; a face without sites is unassigned. The default frame contains
        the enclosures. A site that meets several faces has a part in each.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    VoronoiMap
        A cell for each site, in order; some may be empty.

    Raises
    ------
    InputError
        If `sites`, the frame, the clip or the enclosures are invalid, a coordinate is not finite, the clip has no area,
        or the coordinate reference systems differ.
    UsageError
        If the sides of the frame or `max_distance` are not positive, `max_distance` is too small for the coordinates,
        or `by` is not a column.
    LimitError
        If there are too many vertices.
    VerificationError
        If the clip coincides with a cell border to within rounding.

    Warns
    -----
    RepairWarning
        If vertices are repeated, or an edge or a polygon bounds nothing.
    VorotoolWarning
        If all cells are empty because the frame and the clip have no area in common.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", sections 1 and 3.2.

    Examples
    --------
    >>> wall_and_tree = voronoi(["LINESTRING (0 0, 4 0)", "POINT (2 2)"], frame=(0, 0, 4, 4))
    >>> wall_and_tree.areas.round(6).tolist(), wall_and_tree.neighbors["border_length"].round(6).tolist()
    ([5.333333, 10.666667], [4.591174])
    >>> voronoi([[0, 0]], frame=(-2, 0, 4, 4), max_distance=1).areas.round(6).tolist()
    [1.570796]
    """
    given_frame = None if frame is None else _checked_frame(frame)
    run, given = running(threads, progress), as_sites(sites, by)
    limit = None if max_distance is None else _checked_limit(max_distance, given.polygons.xy)
    cuts = given_cuts(clip, enclosures, given.polygons.crs)
    if cuts.are_there:
        arcs, extent = _map_between_cuts(given, cuts, given_frame, limit, run)
        rings = rings_of(arcs)
    else:
        extent = given_frame or default_frame(given.polygons, limit)
        arcs, rings = _map(owned_graph(given.polygons, given.site, **run), extent, limit, run)
    vertices = moved_vertices(arcs, rings)
    return VoronoiMap(
        vertices,
        arcs.radius,
        arcs.ends.astype(np.int32),
        arcs.sites.astype(np.int32),
        arcs.control,
        without_lost(arcs.center, vertices, arcs.ends, arcs.sites[:, 0] != OUTSIDE),
        arcs.is_cut,
        *cells_of(rings, shells_of(rings, arcs), given.count),
        extent,
        given.polygons,
        given.site,
        given.ids,
        given.properties,
        given.index,
        max_distance=limit,
        clip=cuts.clip,
        enclosures=cuts.enclosures,
    )


def _checked_frame(frame: FrameLike) -> Extent:
    extent = as_extent(frame, "frame")
    if not is_extent(extent):
        raise UsageError(f"invalid frame {extent}: expected X, Y, W, H with W and H above 0")
    check_lengths(extent, "frame's coordinate")
    return extent


def _checked_limit(max_distance: float, xy: NDArray[np.float64]) -> float:
    limit = finite_double(max_distance, "max_distance")
    if limit <= 0:
        raise UsageError(f"max_distance must be above 0, but is {shown_number(limit)}")
    check_lengths([limit], "distance")
    least = LEAST * float(np.abs(xy).max(initial=0))
    if limit < least:
        raise UsageError(
            f"max_distance is {shown_number(limit)}, too small for coordinates of this size: use at least "
            f"{1.1 * least:.2g}"
        )
    return limit


def _map_between_cuts(
    given: Sites, cuts: GivenCuts, frame: Extent | None, limit: float | None, run: Run
) -> tuple[Arcs, Extent]:
    """Make the diagrams of all regions that a frame, a clip and enclosures leave, in one map."""
    frame = cuts.frame_for(given.polygons, frame, limit)
    joint = joint_graph(given.polygons, cuts.sides_near(frame), cuts.clip, cuts.enclosures, **run)
    if cuts.clip is not None and not joint.clips:
        raise InputError("the clip has no area: give polygons that have one")
    regions = regions_of(joint, given.site, given.count)
    local = local_diagrams(joint.sites, given.site, given.count, regions, limit=limit, **run)
    arcs = cut_map(RegionOverlay(local, regions.edges, joint.graph)).arcs()
    return arcs, frame_of(regions.edges, frame, cuts.clip)


def _map(owned: OwnedGraph, frame: Extent, limit: float | None, run: Run) -> tuple[Arcs, Rings]:
    if limit is not None:
        owned = _on_fine_lattice(owned, limit)
    diagram = diagram_of(owned, is_whole=limit is not None, **run)
    if limit is not None:
        borders = borders_of(owned, diagram, level=limit / owned.graph.scale, threads=run["threads"])
        overlay = FrameOverlay(borders, owned.graph, frame)
        if (borders.sites[overlay.pieces.piece] == OUTSIDE).any() or _is_beyond(owned, borders.level, frame):
            made, level = CutMap(overlay), borders.level
            del diagram, borders, overlay
            return _cells_of(owned, made, level, frame)
    borders = borders_of(owned, diagram, threads=run["threads"])
    del diagram  # large, as borders are: what is made of them goes on alone
    made, level = CutMap(FrameOverlay(borders, owned.graph, frame)), borders.level
    del borders
    return _cells_of(owned, made, level, frame)


def _is_beyond(owned: OwnedGraph, level: float, frame: Extent) -> bool:
    """Whether the middle of a frame, and so all of it if no limit is there, is farther than that from all sites."""
    x, y, w, h = frame
    return not len(owned.graph.points) or site_at(owned, (x + w / 2, y + h / 2), level) == OUTSIDE


def _on_fine_lattice(owned: OwnedGraph, limit: float) -> OwnedGraph:
    """Give the lattice of a single place steps that a limit can be counted in."""
    graph = owned.graph
    if len(graph.points) != 1:
        return owned
    assert not graph.points.any()
    return replace(owned, graph=replace(graph, scale=math.ldexp(1.0, int(np.frexp(limit)[1]) - _BITS)))


def _cells_of(owned: OwnedGraph, made: CutMap, level: float, frame: Extent) -> tuple[Arcs, Rings]:
    """Give the arcs and rings of a map; along a frame that no border meets those of what its inside tells."""
    if made.unknown.size:
        made.tell(OUTSIDE, OUTSIDE)
        arcs = made.arcs()
        rings = rings_of(arcs)
        found = _of_frame(owned, level, frame, rings)
        if found[0] == OUTSIDE:
            return arcs, rings
        made.tell(*found)
    arcs = made.arcs()
    return arcs, rings_of(arcs)


def _of_frame(owned: OwnedGraph, level: float, frame: Extent, rings: Rings) -> tuple[int, int]:
    """Site and part along a frame that no border meets: those of what has no shell but the frame."""
    if not len(owned.graph.points):
        return OUTSIDE, OUTSIDE
    is_shell = rings.area > 0
    open_holes = np.flatnonzero(~is_shell & ~np.isin(rings.part, rings.part[is_shell]))
    if open_holes.size:
        widest = open_holes[rings.area[open_holes].argmin()]
        return int(rings.site[widest]), int(rings.part[widest])
    if is_shell.any():  # with nobody around it
        return OUTSIDE, OUTSIDE
    x, y, w, h = frame
    # places where smaller sites are as near have no area, but one of them may be the middle
    return max(site_at(owned, (x + right * w, y + up * h), level) for right, up in _PLACES), OUTSIDE


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
        np.add.at(doubled, face, sign * (crosses(a, b)))
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
