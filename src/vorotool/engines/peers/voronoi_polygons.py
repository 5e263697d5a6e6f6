"""Voronoi cells as a collection of polygons, as `shapely.voronoi_polygons` gives them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vorotool.engines.delaunay.cells import voronoi_cells
from vorotool.engines.delaunay.delaunay import delaunay
from vorotool.errors import InputError
from vorotool.types.box import Box
from vorotool.types.mesh.triangulation import Triangulation

if TYPE_CHECKING:
    import shapely

    from vorotool.typing import HasGeoInterface, MeshLike


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
    import shapely

    mesh = points if isinstance(points, Triangulation) else delaunay(points, threads=threads)
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
