"""Table of points: measures by a triangulation and its Voronoi cells."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vorotool import _core
from vorotool.engines.delaunay.cells import voronoi_cells
from vorotool.errors import InputError
from vorotool.numeric.checks import checked_flag, checked_threads
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.progress import Progress
from vorotool.types.arguments import check_value
from vorotool.types.mesh.cells import CellSet
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.table import Table

if TYPE_CHECKING:
    from vorotool.typing import FrameLike


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
    on_hull = np.zeros(len(mesh.points), dtype=bool)
    on_hull[mesh.hull] = True
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
