"""Voronoi cells of points in space, clipped to a box, and their check."""

from __future__ import annotations

from typing import Any

import numpy as np

from vorotool import _core
from vorotool.engines.delaunay.tetrahedralization import tetrahedralization
from vorotool.errors import InputError, UsageError, option
from vorotool.numeric.arrays import Floats
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.numbers import finite_double, shown_number
from vorotool.numeric.parallel import Progress
from vorotool.types.mesh.space_cells import SpaceCellSet
from vorotool.types.mesh.tetrahedralization import Tetrahedralization
from vorotool.types.points.point_set import known_of_points

_FRAME = option("--frame X,Y,Z,W,H,D", "frame=(x, y, z, width, height, depth)")
_EXPECTED = "expected six finite numbers, the last three above 0"


def space_cells(
    points: Any, *, frame: Any = None, clip: Any = None, threads: int = 0, progress: Progress = None
) -> SpaceCellSet:
    """Compute the Voronoi cells of points in space, as `vorotool.voronoi_cells` does."""
    if clip is not None:
        raise InputError("invalid clip: cells in space are clipped to a box alone; give it as frame")
    mesh = points
    if not isinstance(points, Tetrahedralization):
        mesh = tetrahedralization(points, threads=threads, progress=progress)
    if not np.isfinite(mesh.points).all():
        raise InputError("a coordinate of the triangulation is not finite")
    box = _bounds(mesh.points) if frame is None else as_space_box(frame)
    edges = np.zeros((0, 2), dtype=np.int32) if len(mesh) else mesh.edges
    arrays = mesh.points, mesh.tetrahedra, mesh.neighbors, edges, mesh.first
    try:
        found = _core.cells_in_space.space_cells(*arrays, box.reshape(-1), checked_threads(threads), progress)
    except ValueError as error:
        raise InputError(f"{error}: give a Delaunay triangulation, such as delaunay() returns") from None
    known = {name: value for name, value in known_of_points(mesh).items() if name in ("labels", "properties", "index")}
    return SpaceCellSet(sites=mesh.points, **found, box=box, **known)


def _bounds(points: Floats) -> Floats:
    if not len(points):
        raise InputError(f"there are no points, whose bounds would be the box: give {_FRAME}")
    box = np.array([points.min(axis=0), points.max(axis=0)])
    flat = [axis for axis, low, high in zip("xyz", *box.tolist(), strict=True) if not low < high]
    if flat:
        raise InputError(f"the points have the same {flat[0]}, so that their bounds have no volume: give {_FRAME}")
    return box


def as_space_box(frame: Any) -> Floats:
    """Return the lowest and the highest corner of a box, from its lowest corner, width, height and depth."""
    try:
        values = [finite_double(value, "frame") for value in frame]
    except (TypeError, ValueError):  # a UsageError is one of the latter
        values = []
    if len(values) != 6 or min(values[3:]) <= 0:
        shown = ", ".join(f"{value:g}" for value in values) if values else shown_number(frame)
        raise UsageError(f"invalid frame ({shown}): points in space need {_FRAME}; {_EXPECTED}")
    low, sizes = np.array(values).reshape(2, 3)
    with np.errstate(over="ignore"):
        box = np.array([low, low + sizes]) + 0.0
    if not np.isfinite(box).all() or not (box[0] < box[1]).all():
        raise InputError(
            f"the frame extends from {tuple(box[0].tolist())} to {tuple(box[1].tolist())}: its sizes must be large "
            "enough for coordinates of this size, and its sides finite"
        )
    return box


def measures_of(cells: SpaceCellSet) -> dict[str, Any]:
    """Areas of faces, and volumes and areas of cells."""
    return _core.cells_in_space.measures(**_polyhedra(cells), threads=0, progress=None)


def fault(cells: SpaceCellSet, threads: int, progress: Progress) -> str | None:
    """The first fault of cells, if they have any."""
    how: Any = {"box": cells.box.reshape(-1), "threads": checked_threads(threads), "progress": progress}
    return _core.cells_in_space.find_fault(cells.sites, **_polyhedra(cells), **how)


def _polyhedra(cells: SpaceCellSet) -> dict[str, Any]:
    names = "vertices", "face_starts", "corners", "face_cells", "cell_starts", "cell_faces"
    return {name: getattr(cells, name) for name in names}
