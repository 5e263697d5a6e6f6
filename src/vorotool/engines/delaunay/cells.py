"""Voronoi cells of points: exact, clipped to a frame or to polygons (paper, section 2.1), or as shapely has them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.polygons import as_geometry
from vorotool.engines.delaunay.delaunay import core_mesh, is_of_space, triangulated
from vorotool.errors import InputError, VerificationError, warn
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, owners, starts_of
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.crs import crs_name, same_crs
from vorotool.numeric.lazy import shapely
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.products.registry import is_of
from vorotool.types.arguments import check_value
from vorotool.types.box import Box, as_box
from vorotool.types.mesh.cells import CellSet
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.points.point_set import known_of_points

if TYPE_CHECKING:
    from vorotool.types.mesh.tetrahedralization import SpaceCellSet, Tetrahedralization
    from vorotool.types.points.point_set import VolumePoints
    from vorotool.types.volumes.volume import VolumeSeeds
    from vorotool.typing import FrameLike, HasGeoInterface, MeshLike, PolygonsLike

_IN_SPACE = "engines.delaunay.tetrahedralization"
"""What makes and checks cells in space."""


@overload
def voronoi_cells(
    points: Tetrahedralization | VolumePoints | VolumeSeeds,
    *,
    frame: FrameLike | None = ...,
    clip: None = ...,
    threads: int = ...,
    progress: Progress = ...,
) -> SpaceCellSet: ...


@overload
def voronoi_cells(
    points: MeshLike,
    *,
    frame: FrameLike | None = ...,
    clip: PolygonsLike | None = ...,
    threads: int = ...,
    progress: Progress = ...,
) -> CellSet: ...


def voronoi_cells(
    points: MeshLike | Tetrahedralization | VolumePoints | VolumeSeeds,
    *,
    frame: FrameLike | None = None,
    clip: PolygonsLike | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> CellSet | SpaceCellSet:
    """Compute the Voronoi cells of points, clipped to a frame.

    Cells of points in space are polyhedra, clipped to a box.

    Which vertices a cell has is decided exactly, and every vertex is the place nearest to the exact one that doubles
    hold: neighboring cells share vertices bit for bit, and the cells tile the frame. Points outside the frame are
    allowed; their cells may be empty. So may be cells too small for doubles.

    Parameters
    ----------
    points : Triangulation, PointSet, SeedSet, (n, 2) array, … or Tetrahedralization, VolumePoints, (n, 3) array, …
        Points, or a triangulation, which is used unchanged.
    frame : Box or (x, y, width, height), in space (x, y, z, width, height, depth), optional
        By default the image that the points come from, or the bounds of the points, widened by a tenth of the longer
        side; with `clip`, its bounds. In space by default the bounds of the points.
    clip : polygons as for `skeleton_exact`, optional
        Cells in the plane are cut to these too, by shapely: they may fall in several parts and have holes.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    CellSet
        One cell per point, in the order of the points. Duplicate points have empty cells.
    SpaceCellSet
        Of points in space. Which vertices, edges and faces its cells have is decided exactly, and they share vertices
        and faces; cells too small for doubles keep theirs. A cell that only touches the box is empty.

    Raises
    ------
    InputError
        If the frame is flat, a coordinate is not finite, the triangulation is none, or `clip` is no polygon.

    Warns
    -----
    VorotoolWarning
        If points lie on an earlier one, or a polygon of `clip` is not valid and was repaired: how many.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.1.

    Examples
    --------
    >>> cells = voronoi_cells([[1, 1], [3, 1]], frame=(0, 0, 4, 2))
    >>> [cell.wkt for cell in cells.to_shapely()]
    ['POLYGON ((0 0, 2 0, 2 2, 0 2, 0 0))', 'POLYGON ((2 0, 4 0, 4 2, 2 2, 2 0))']
    """
    if not isinstance(points, Triangulation) and is_of_space(points):
        return resolved(f"{_IN_SPACE}:space_cells")(points, frame=frame, clip=clip, threads=threads, progress=progress)
    mesh = points if isinstance(points, Triangulation) else triangulated(points, threads=threads, progress=progress)
    if not np.isfinite(mesh.points).all():
        raise InputError("a coordinate of the triangulation is not finite")
    area = None if clip is None else _clip_area(clip, mesh.crs)
    box = _box(frame, mesh, area)
    try:
        coordinates, starts = _core.cells.voronoi_cells(core_mesh(mesh), box.sides, checked_threads(threads), progress)
    except ValueError as error:
        raise InputError(f"{error}: give a Delaunay triangulation, such as delaunay() returns") from None
    cells = CellSet(mesh.points, coordinates, starts, box, **known_of_points(mesh))
    return cells if area is None else _clipped(cells, area)


def _box(frame: FrameLike | None, mesh: Triangulation, area: Any) -> Box:
    if frame is not None:
        return as_box(frame, "frame")
    if mesh.frame is not None:
        return mesh.frame
    if area is None:
        return Box.around(mesh.points)
    return Box(*area.bounds)


def cell_colors(mesh: Triangulation, *, progress: Progress = None) -> NDArray[np.uint32]:
    """Color points so that neighbors in the triangulation, and so neighboring cells, differ.

    Parameters
    ----------
    mesh : Triangulation
        Of the points.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    (n,) uint32 array
        Colors 1, 2, … of about equal frequency, at most 6.

    Examples
    --------
    >>> from vorotool import delaunay
    >>> cell_colors(delaunay([[0, 0], [4, 0], [0, 3]])).tolist()
    [3, 2, 1]
    """
    check_value(mesh, "mesh", "Triangulation")
    a, b = (np.ascontiguousarray(mesh.edges[:, side].astype(np.uint32)) for side in (0, 1))
    return _core.graphs.color_graph(len(mesh.points), a, b, progress)


# ---- clipping to polygons ----------------------------------------------------------------------------------


def _clip_area(clip: Any, crs: Any) -> Any:
    """Union of the polygons, valid."""
    polygons, own_crs = as_geometry(clip, "clip")
    if crs is not None and own_crs is not None and not same_crs(crs, own_crs):
        raise InputError(
            f"invalid clip: it is in {crs_name(own_crs)}, but the points in {crs_name(crs)}; reproject one of them"
        )
    polygons = polygons[~shapely.is_missing(polygons)]
    for number, polygon in enumerate(polygons, 1):
        if polygon.geom_type not in ("Polygon", "MultiPolygon"):
            raise InputError(f"invalid clip: polygon {number} is a {polygon.geom_type}; give polygons")
    bad = ~shapely.is_valid(polygons)
    if bad.any():
        reason = shapely.is_valid_reason(polygons[np.argmax(bad)])
        warn(f"{int(bad.sum())} of {len(polygons)} clip polygons are invalid and were repaired (the first: {reason})")
        polygons[bad] = shapely.make_valid(polygons[bad])
    area = shapely.union_all(polygons)
    if area.area == 0:
        raise InputError("the clip polygons have no area: give polygons that have one")
    return area


def _clipped(cells: CellSet, area: Any) -> CellSet:
    """Cells cut to an area; those inside it stay as they are, bit for bit."""
    shapes = cells.to_shapely()
    shapely.prepare(area)
    inside, meets = shapely.contains_properly(area, shapes), shapely.intersects(area, shapes)
    crossing = meets & ~inside
    shapes[~meets] = shapely.Polygon()
    parts = cut_out(shapes[crossing], area)
    shapes[crossing] = [_polygons_of(part) for part in parts]
    return _from_shapely(cells, shapes)


def _polygons_of(shape: Any) -> Any:
    """The part of a shape that has area: of a boundary that is only touched, nothing."""
    if shape.geom_type in ("Polygon", "MultiPolygon"):
        return shape
    return shapely.MultiPolygon([p for p in shapely.get_parts([shape]) if p.geom_type == "Polygon"])


def _from_shapely(cells: CellSet, shapes: NDArray[Any]) -> CellSet:
    parts, cell_of_part = shapely.get_parts(shapes, return_index=True)
    kept = ~shapely.is_empty(parts)
    parts, cell_of_part = parts[kept], cell_of_part[kept]
    rings, polygon_of_ring = shapely.get_rings(parts, return_index=True)
    first = np.ones(len(rings), dtype=bool)
    first[1:] = polygon_of_ring[1:] != polygon_of_ring[:-1]
    turned = shapely.is_ccw(rings) != first
    rings[turned] = shapely.reverse(rings[turned])
    coordinates, ring_of = shapely.get_coordinates(rings, return_index=True)
    last = np.ones(len(coordinates), dtype=bool)
    last[:-1] = ring_of[1:] != ring_of[:-1]  # it repeats the first
    return replace(
        cells,
        coordinates=coordinates[~last] + 0.0,
        starts=_starts(ring_of[~last], len(rings)),
        polygon_starts=_starts(polygon_of_ring, len(parts)),
        cell_starts=_starts(cell_of_part, len(cells)),
    )


def _starts(owner: NDArray[Any], count: int) -> NDArray[np.int64]:
    """Where the items of each owner begin, in a list ordered by owner."""
    return np.searchsorted(owner, np.arange(count + 1)).astype(np.int64)


# ---- the checker --------------------------------------------------------------------------------------------


def verify_cells(cells: CellSet | SpaceCellSet, *, threads: int = 0, progress: Progress = None) -> None:
    """Check Voronoi cells that were clipped to a frame alone, from the sites and the coordinates.

    Every ring is convex and in the frame; no site is nearer to a vertex than that of its cell; the areas add up to
    that of the frame; duplicates have no cell. Signs are taken exactly, and what must be allowed for is the rounding
    of vertices alone: each lies at most half a unit in the last place of each coordinate from its exact place.

    Of cells in space every surface is closed, with V - E + F = 2, and in the box; every face is convex, and lies
    half-way between the sites of its two cells, or on the box; the volumes add up to that of the box; no vertex is
    nearer to the site of an empty cell. The bounds of what roundings explain cover those of the vertices and of the
    check.

    Parameters
    ----------
    cells : CellSet or SpaceCellSet
        However it was made; its cells are rings, or polyhedra.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.
    InputError
        If the cells were clipped to polygons.

    Examples
    --------
    >>> from dataclasses import replace
    >>> cells = voronoi_cells([[1, 1], [3, 1]], frame=(0, 0, 4, 2))
    >>> verify_cells(cells)
    >>> verify_cells(replace(cells, sites=cells.sites + [0.5, 0]))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: vertex (2, 2) of cell 1 is nearer to site 0 by more than rounding explains
    """
    check_value(cells, "cells", "CellSet", "SpaceCellSet")
    find_fault = resolved(f"{_IN_SPACE}:cells_fault") if is_of(cells, "SpaceCellSet") else _fault
    fault = find_fault(cells, threads, progress)
    if fault is not None:
        raise VerificationError(fault)


def _fault(cells: Any, threads: int, progress: Progress) -> str | None:
    """The first fault of cells in the plane, if they have any."""
    if cells.polygon_starts is not None:
        raise InputError("cells clipped to polygons cannot be verified: verify them before clipping")
    if not (np.isfinite(cells.sites).all() and np.isfinite(cells.coordinates).all()):
        return "a coordinate is not finite"
    return _core.cells.find_cell_fault(
        cells.sites, cells.coordinates, cells.starts, cells.frame.sides, checked_threads(threads), progress
    )


FEW_SHAPES, FEW_VERTICES = 4, 256
"""Where dividing further takes longer than cutting."""

MARGIN = 0.25
"""Of the larger side of the bounds of shapes: GEOS cuts at bounds that are wider by 0.1 of their smaller side."""


def cut_out(shapes: NDArray[Any], area: Any) -> NDArray[Any]:
    """Give the intersections of shapes with an area, as `shapely.intersection` gives them."""
    made = np.empty(len(shapes), dtype=object)
    center = shapely.bounds(shapes).reshape(-1, 2, 2).mean(axis=1)
    waiting = [(np.arange(len(shapes)), Rings.of(area))]
    while waiting:
        chosen, rings = waiting.pop()
        if not len(chosen):
            continue
        bounds = rings.with_crossing_edges(shapely.total_bounds(shapes[chosen]))
        margin = MARGIN * max(bounds[2] - bounds[0], bounds[3] - bounds[1])
        rings = rings.around(bounds + margin * np.array([-1, -1, 1, 1]))
        if len(chosen) <= FEW_SHAPES or len(rings.xy) <= FEW_VERTICES:
            made[chosen] = _cut_out_of(shapes[chosen], rings.area(), area)
            continue
        axis = int(np.argmax(np.ptp(center[chosen], axis=0)))
        chosen = chosen[np.argsort(center[chosen, axis], kind="stable")]
        middle = len(chosen) // 2
        waiting += [(chosen[:middle], rings), (chosen[middle:], rings)]
    return made


def _cut_out_of(shapes: NDArray[Any], near: Any, whole: Any) -> NDArray[Any]:
    """Cut out of what is near; where GEOS cannot, which what crosses itself far away may be the cause of, of all."""
    try:
        made = shapely.intersection(shapes, near)
    except shapely.errors.GEOSException:
        made = shapely.intersection(shapes, whole)
    return np.asarray(made)


@frozen
class Rings:
    """The rings of an area."""

    xy: Floats  # (k, 2) float64 array: vertices, ring by ring, the first not repeated
    start: NDArray[np.int64]  # (r + 1,) int64 array: where rings begin
    part: NDArray[np.int64]  # (r,) int64 array: the polygon of each; its shell comes first

    @classmethod
    def of(cls, area: Any) -> Rings:
        """Those of a shapely polygon, of one part or several."""
        rings, part = shapely.get_rings(shapely.get_parts([area]), return_index=True)
        xy, ring = shapely.get_coordinates(rings, return_index=True)
        is_last = np.append(ring[1:] != ring[:-1], True)
        return cls(xy[~is_last], starts_of(np.bincount(ring, minlength=len(rings)) - 1), part.astype(np.int64))

    def bounds(self) -> Floats:
        """Least x and y, most x and y; of nothing they are the wrong way round."""
        x, y = np.ascontiguousarray(self.xy.T)
        least, most = {"initial": np.inf}, {"initial": -np.inf}
        return np.array([x.min(**least), y.min(**least), x.max(**most), y.max(**most)])

    def with_crossing_edges(self, bounds: Floats) -> Floats:
        """Bounds that hold the edges that reach into some bounds, too: GEOS looks at all that is in these."""
        after = np.arange(1, len(self.xy) + 1)
        after[self.start[1:] - 1] = self.start[:-1]
        ends = self.xy, self.xy[after]
        least, most = np.minimum(*ends), np.maximum(*ends)
        meets = ((most >= bounds[:2]) & (least <= bounds[2:])).all(axis=1)
        edges = Rings(np.concatenate([least[meets], most[meets]]), self.start, self.part).bounds()
        return np.concatenate([np.minimum(bounds[:2], edges[:2]), np.maximum(bounds[2:], edges[2:])])

    def around(self, bounds: Floats) -> Rings:
        """Rings that are the same inside some bounds, with fewer vertices outside, and the same bounds of their own."""
        side = np.zeros(len(self.xy), dtype=np.int8)
        for number, is_beyond in enumerate(
            (self.xy[:, 0] < bounds[0], self.xy[:, 0] > bounds[2], self.xy[:, 1] < bounds[1], self.xy[:, 1] > bounds[3])
        ):
            side[is_beyond & (side == 0)] = number + 1
        lengths = np.diff(self.start)
        first, last = np.repeat(self.start[:-1], lengths), np.repeat(self.start[1:] - 1, lengths)
        place = np.arange(len(side))
        before, after = np.where(place == first, last, place - 1), np.where(place == last, first, place + 1)
        kept = (side == 0) | (side != side[before]) | (side != side[after])
        farthest = np.concatenate([self.xy.argmin(axis=0), self.xy.argmax(axis=0)])
        kept[[farthest, before[farthest], after[farthest]]] = True
        ring = owners(lengths)
        # with a shell beyond one side its holes are gone, too
        is_ring = np.bincount(ring[kept], minlength=len(lengths)) > 0
        # at the top of a ring GEOS sees which way it goes around
        y = self.xy[:, 1]
        top = np.flatnonzero(y == np.maximum.reduceat(y, self.start[:-1])[ring])
        kept[np.concatenate([top, before[top], after[top]])] = True
        kept &= is_ring[ring]
        counts = np.bincount(ring[kept], minlength=len(lengths))
        return Rings(self.xy[kept], starts_of(counts[is_ring]), self.part[is_ring])

    def area(self) -> Any:
        """Make a polygon of them, which need not be valid outside the bounds that they are around."""
        lengths = np.diff(self.start)
        closed = np.insert(self.xy, self.start[1:], self.xy[self.start[:-1]], axis=0)
        rings = shapely.linearrings(closed, indices=owners(lengths + 1))
        _, part = np.unique(self.part, return_inverse=True)
        return shapely.multipolygons(shapely.polygons(rings, indices=part))


def voronoi_polygons(
    points: MeshLike, *, extend_to: HasGeoInterface | None = None, threads: int = 0
) -> shapely.GeometryCollection:
    """Return the exact Voronoi cells of points as shapely polygons.

    As `shapely.voronoi_polygons` with ``ordered=True``: the cells fill the bounds of the points, widened on all sides
    by the longer side, and those of `extend_to`. Which cells meet is decided exactly, and vertices are rounded once.

    Parameters
    ----------
    points : as of `delaunay`
        The points.
    extend_to : geometry of shapely, optional
        The cells fill its bounds, too.
    threads : int
        Number of threads; 0 uses all.

    Returns
    -------
    shapely.GeometryCollection
        Polygon i is the cell of point i; that of a point which lies on an earlier one is empty. Of points that are all
        at one place the first has all of the bounds of `extend_to`; without it there is no cell.

    Raises
    ------
    InputError
        If the points are unusable, or `extend_to` is no geometry.

    Warns
    -----
    VorotoolWarning
        If points are duplicates: how many.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.1.

    Examples
    --------
    >>> [cell.wkt for cell in voronoi_polygons([[0, 0], [2, 0]]).geoms]
    ['POLYGON ((-2 -2, 1 -2, 1 2, -2 2, -2 -2))', 'POLYGON ((1 -2, 4 -2, 4 2, 1 2, 1 -2))']
    """
    mesh = points if isinstance(points, Triangulation) else triangulated(points, threads=threads)
    corners = [*_widened(mesh), *_bounds_of(extend_to)]
    if not corners:
        return shapely.GeometryCollection()
    (left, bottom), (right, top) = np.min(corners, axis=0).tolist(), np.max(corners, axis=0).tolist()
    if not (left < right and bottom < top):
        return shapely.GeometryCollection()
    return shapely.GeometryCollection(
        list(voronoi_cells(mesh, frame=Box(left, bottom, right, top), threads=threads).to_shapely())
    )


def _widened(mesh: Triangulation) -> list[Any]:
    if not len(mesh.points):
        return []
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    margin = (high - low).max()
    return [low - margin, high + margin]


def _bounds_of(geometry: Any) -> list[Any]:
    if geometry is None:
        return []
    if not hasattr(geometry, "geom_type"):
        raise InputError(
            f"invalid extend_to: expected a geometry of shapely, but got a {type(geometry).__name__}; for bounds give "
            "shapely.box(xmin, ymin, xmax, ymax)"
        )
    if geometry.is_empty:
        return []
    return [geometry.bounds[:2], geometry.bounds[2:]]
