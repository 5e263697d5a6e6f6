"""Measures of cells and their summary, of points and of label images: cellular sociology (paper, section 2.3)."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.delaunay.cells import voronoi_cells
from vorotool.engines.delaunay.delaunay import triangulated
from vorotool.engines.delaunay.proximity import proximity_graph
from vorotool.errors import InputError, UsageError
from vorotool.numeric.arrays import mask_of
from vorotool.numeric.checks import checked_flag, checked_threads
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.parallel import Progress, Run, running
from vorotool.products.formats import resolved
from vorotool.types.arguments import check_value
from vorotool.types.images import LabelImage
from vorotool.types.mesh.cells import CellSet
from vorotool.types.mesh.tables import CellStatistics
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.table import Table

if TYPE_CHECKING:
    from vorotool.typing import FrameLike, MeshLike, PolygonsLike

_COLUMNS = ("label", "x", "y", "area", "perimeter", "roundness", "neighbors", "nearest_distance", "whole")


def cell_statistics(
    points: MeshLike | LabelImage,
    *,
    frame: FrameLike | None = None,
    clip: PolygonsLike | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> CellStatistics:
    """Measure the Voronoi cells of points, or the regions of a label image, and summarize the whole ones.

    A cell is whole if nothing cuts it: its point is not on the hull, whose cells are unbounded, it does not touch the
    frame, and it lies inside the polygons of ``clip``. A region of a label image is whole if it does not touch the
    frame. Others have their measures, but do not count in the summary; empty cells and duplicates do not either.

    Parameters
    ----------
    points : LabelImage, Triangulation, PointSet, SeedSet, (n, 2) array, data frame, GeoSeries, …
        A triangulation is used as it is. Of a label image area and perimeter are those of `region_table`, in pixels and
        their sides.
    frame, clip : optional
        As for `voronoi_cells`; not for label images.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    CellStatistics
        ``cells``, a table with one row a point or region, and ``summary``, one with a row a measure. The area that the
        spanning tree is normalized by is that of the frame, the polygons or the image where there are any, else that
        of the convex hull; of a label image that of its regions.

    Raises
    ------
    InputError
        As for `voronoi_cells`.
    UsageError
        If there is a label image and a frame or polygons.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.3; Marcelpoil and Usson 1992; Dussert and
    others 1986.

    Examples
    --------
    >>> import vorotool
    >>> summary = cell_statistics(vorotool.read(vorotool.sample("dots.csv"))).summary
    >>> summary["measure"][3], summary["count"][3], round(summary["mean"][3], 2)
    ('neighbors', np.int64(32), np.float64(5.75))
    """
    run = running(threads, progress)
    if isinstance(points, LabelImage):
        if frame is not None or clip is not None:
            raise UsageError("frame and clip are for points: leave them out with a label image")
        return _of_image(points, run)
    mesh = points if isinstance(points, Triangulation) else triangulated(points, **run)
    cells = voronoi_cells(mesh, frame=frame, clip=clip, **run)
    has_region = frame is not None or clip is not None
    return statistics_of(mesh, cells, has_region=has_region, **run)


def statistics_of(mesh: Triangulation, cells: CellSet, *, has_region: bool, **run: Unpack[Run]) -> CellStatistics:
    """Measure cells that are there already."""
    table = site_table(mesh, cells, properties=False, **run)
    area = np.ma.filled(table["area"], 0.0)
    touches, on_hull = (np.ma.filled(table[name], True).astype(bool) for name in ("touches_frame", "on_hull"))
    whole = (area > 0) & ~touches & ~on_hull
    if cells.polygon_starts is not None:
        uncut = voronoi_cells(mesh, frame=cells.frame, **run)
        whole &= area >= uncut.areas
    tree = proximity_graph(mesh, "mst", **run)
    region = float(area.sum()) if has_region or mesh.frame is not None else float(mesh.areas.sum())
    return CellStatistics(_measured(table, whole), tree.edge_lengths(), region, mesh.properties)


def _of_image(image: LabelImage, run: Run) -> CellStatistics:
    measure = resolved("engines.label_images.regions:region_table")
    table: Table = measure(image, properties=False, **run)
    area = np.ma.filled(table["area"], 0)
    whole = (area > 0) & ~np.ma.filled(table["touches_frame"], True).astype(bool)
    sites = np.stack([table["x"], table["y"]], axis=1)
    sites = np.unique(sites, axis=0)  # objects may have one centroid
    tree = proximity_graph(sites, "mst", **run)
    properties = {} if image.seeds is None else image.seeds.properties
    return CellStatistics(_measured(table, whole), tree.edge_lengths(), float(area.sum()), properties)


def _measured(table: Table, whole: NDArray[np.bool_]) -> Table:
    area, perimeter = (np.ma.asanyarray(table[name]).astype(float) for name in ("area", "perimeter"))
    ratio = np.ma.masked_invalid(np.ma.divide(4 * pi * area, perimeter * perimeter))
    made: dict[str, Any] = {**table, "roundness": ratio, "whole": whole}
    return Table({name: made[name] for name in _COLUMNS})


def site_table(
    mesh: Triangulation,
    cells: CellSet | None = None,
    *,
    frame: FrameLike | None = None,
    properties: bool = True,
    threads: int = 0,
    progress: Progress = None,
) -> Table:
    """Tabulate the points of a triangulation: one row per point, in the order of the input.

    Parameters
    ----------
    mesh : Triangulation
        Of the points.
    cells : CellSet, optional
        Their cells, if they are there already.
    frame : Box or (x, y, width, height), optional
        What to clip the cells to otherwise; by default the image, or the bounds of the points, widened by a tenth.
    properties : bool
        Whether to add the input's own columns.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    Table
        ``label, x, y, area, perimeter, neighbors, nearest_label, nearest_distance, touches_frame, max_distance,
        on_hull, duplicate_of_label``. Area and perimeter are of the clipped cell, 0 of an empty one; `neighbors` are
        the points with an edge to this one in the triangulation; ``nearest_label`` is the nearest point at another
        place, by exact comparison, ties to the smallest label; ``max_distance`` is that of the farthest place of the
        cell. ``touches_frame`` and ``max_distance`` do not exist for empty cells. A point that lies on an earlier one,
        ``duplicate_of_label``, has nothing else but its label and place; of the others only this does not exist.

    Raises
    ------
    InputError
        If the cells are not those of the points, or the frame has no area.

    Examples
    --------
    >>> from vorotool import delaunay
    >>> table = site_table(delaunay([[1, 1], [3, 1]]), frame=(0, 0, 4, 2))
    >>> table["area"].tolist(), table["nearest_label"].tolist(), table["max_distance"].tolist() == [2**0.5] * 2
    ([4.0, 4.0], [2, 1], True)
    """
    check_value(mesh, "mesh", "Triangulation")
    if cells is None:
        cells = voronoi_cells(mesh, frame=frame, threads=threads, progress=progress)
    check_value(cells, "cells", "CellSet")
    if not np.array_equal(cells.sites, mesh.points):
        raise InputError("the cells belong to other points: give cells computed from this triangulation")
    threads = checked_threads(threads)
    labels = np.ascontiguousarray(mesh.label_array, dtype=np.int64)
    nearest, neighbors = _core.delaunay.nearest_neighbors(mesh.points, mesh.edges, labels, progress)
    repeated = mesh.first != np.arange(len(mesh.first))
    alone = nearest < 0
    with np.errstate(over="ignore"):  # beyond the largest double: infinite
        step = mesh.points - mesh.points[nearest]
        distance = hypotenuse(step[:, 0], step[:, 1])
    on_hull = mask_of(mesh.hull, len(mesh.points))
    rings, polygons, of_cells = cells.nesting
    area, perimeter, reach, touches = _core.cells.measure_cells(
        cells.sites, cells.coordinates, rings, polygons[of_cells], cells.frame.sides, threads, progress
    )
    columns: dict[str, Any] = {
        "label": labels,
        "x": np.ascontiguousarray(mesh.points[:, 0]),
        "y": np.ascontiguousarray(mesh.points[:, 1]),
        "area": np.ma.array(area, mask=repeated),
        "perimeter": np.ma.array(perimeter, mask=repeated),
        "neighbors": np.ma.array(neighbors, mask=repeated),
        "nearest_label": np.ma.array(labels[nearest] if len(labels) else labels, mask=alone),
        "nearest_distance": np.ma.array(distance, mask=alone),
        "touches_frame": np.ma.array(touches, mask=cells.is_empty),
        "max_distance": np.ma.array(reach, mask=cells.is_empty),
        "on_hull": np.ma.array(on_hull, mask=repeated),
        "duplicate_of_label": np.ma.array(labels[mesh.first], mask=~repeated),
    }
    table = Table(columns)
    return table.with_properties(mesh.properties) if checked_flag(properties, "properties") else table
