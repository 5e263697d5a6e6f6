"""Delaunay triangulation of points in space: exact, whatever the coordinates; the table of points, and spheres."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.volumes import as_volume_points
from vorotool.engines.delaunay.delaunay import report_duplicates
from vorotool.errors import InputError, LimitError, UsageError, option
from vorotool.numeric.arrays import Floats
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.numbers import finite_double, shown_number
from vorotool.numeric.parallel import Progress, Run, running
from vorotool.types.mesh.tetrahedralization import FACES, SpaceCellSet, Tetrahedralization, scaled_norms
from vorotool.types.points.point_set import known_of_points
from vorotool.types.table import Table

PLANE = 2
_LARGE = 2.0**1021
"""Coordinates beyond it are divided by 4, so that there is a place beyond them."""


def tetrahedralization(
    points: Any, *, strict: bool = False, threads: int = 0, progress: Progress = None
) -> Tetrahedralization:
    """Triangulate points in space, as `vorotool.delaunay` does."""
    given, run = as_volume_points(points), running(threads, progress)
    known = {name: value for name, value in known_of_points(given).items() if name in ("labels", "properties", "index")}
    found = _triangulated(given.xyz, run)
    is_planar = found["dimension"] == PLANE
    planar = _planar_triangles(given.xyz, run) if is_planar else np.zeros((0, 3), dtype=np.int32)
    mesh = Tetrahedralization(given.xyz, found["tetrahedra"], found["neighbors"], planar, found["first"], **known)
    if mesh.duplicates:
        report_duplicates(mesh, strict=strict)
    return mesh


def _triangulated(xyz: Floats, run: Run) -> dict[str, Any]:
    try:
        return _core.tetrahedra.triangulate(xyz, **run)
    except _core.tetrahedra.TooManyTetrahedraError as error:
        raise LimitError(
            f"{len(xyz)} points have more than {error} tetrahedra, and there is no memory for more: points along a few "
            "lines or curves have so many; leave points out, or triangulate parts of them"
        ) from None


# ---- points in one plane -------------------------------------------------------------------------
def _planar_triangles(xyz: Floats, run: Run) -> NDArray[np.int32]:
    """Triangles of points in one plane, counter-clockwise as seen from where z, or else x or y, is greater.

    Together with any place off the plane the points are divided into tetrahedra that all have it for a corner. A
    sphere through it and three points meets the plane in their circle, so that the faces opposite to it are the
    Delaunay triangles of the plane; since it is lexicographically greater than all points, ties are broken by these.
    """
    meshes = (_triangulated(places, run) for places in _with_places_beyond(xyz))
    cone = next(each["tetrahedra"] for each in meshes if len(each["tetrahedra"]))
    row, corner = np.nonzero(cone == len(xyz))
    triangles: NDArray[np.int32] = cone[row[:, None], FACES[corner]]
    return triangles if _faces_up(xyz[triangles[0]]) else triangles[:, ::-1]


def _with_places_beyond(xyz: Floats) -> Iterator[Floats]:
    """Add to points places that are greater; one of them is off the plane of the points, whatever plane it is."""
    if np.abs(xyz).max() > _LARGE:
        xyz = xyz / 4
    greatest = xyz.max(axis=0)
    beyond = np.maximum(greatest + np.ptp(xyz, axis=0).max(), np.nextafter(greatest, np.inf))
    for is_moved in ([True, False, False], [True, True, False], [True, False, True]):
        yield np.vstack([xyz, np.where(is_moved, beyond, greatest)])


def _faces_up(triangle: Floats) -> bool:
    """Whether the normal of a triangle goes upwards, exactly; of upright ones where x, or else y, is greater."""
    a, b, c = ([Fraction(x) for x in corner] for corner in triangle.tolist())
    u, v = ([x - y for x, y in zip(p, a, strict=True)] for p in (b, c))
    z, x, y = (u[i] * v[i - 2] - u[i - 2] * v[i] for i in (0, 1, 2))
    return bool(next((sign > 0 for sign in (z, x, y) if sign), False))


# ---- the checker ---------------------------------------------------------------------------------
def fault(mesh: Tetrahedralization, run: Run) -> str | None:
    """The first fault of a triangulation of finite points, if it has any."""
    arrays = mesh.points, mesh.tetrahedra, mesh.neighbors, mesh.first
    found = _core.tetrahedra.find_fault(*arrays, **run)
    if found is None and not len(mesh):
        return _planar_fault(mesh, run)
    return "there are tetrahedra and planar triangles" if found is None and len(mesh.planar) else found


def _planar_fault(mesh: Tetrahedralization, run: Run) -> str | None:
    """The first fault of triangles in a plane: with a place off the plane they are tetrahedra, which are checked."""
    places = mesh.points
    if not len(mesh.planar):
        is_on_line = _triangulated(places, run)["dimension"] < PLANE
        return None if is_on_line else "there is no triangle, but the points are not collinear"
    if mesh.planar.min() < 0 or mesh.planar.max() >= len(places):
        return "a planar triangle names a point that does not exist"
    apex = np.full((len(mesh.planar), 1), len(places), dtype=np.int32)
    first = np.append(mesh.first, len(places)).astype(np.int32)
    for beyond in _with_places_beyond(places):
        cone = np.hstack([mesh.planar, apex])
        signs = _core.tetrahedra.orient3d(beyond[cone[:1]])
        if signs[0] == 0:
            continue
        cone = cone if signs[0] > 0 else cone[:, [1, 0, 2, 3]]
        neighbors = _neighbors_of_cone(cone)
        if neighbors is None:
            return "two planar triangles lie on one side of an edge"
        found = _core.tetrahedra.find_fault(beyond, np.ascontiguousarray(cone), neighbors, first, **run)
        return found and f"together with a point {len(places)} off the plane: {found}"
    return "planar triangle 0 has no area"


def _neighbors_of_cone(cone: NDArray[np.int32]) -> NDArray[np.int32] | None:
    """The tetrahedron across the face opposite to each corner; none across that of the apex, which is the last."""
    sides = np.concatenate([cone[:, [1, 2]], cone[:, [2, 0]], cone[:, [0, 1]]]).astype(np.int64)
    keys, turned = sides[:, 0] << 32 | sides[:, 1], sides[:, 1] << 32 | sides[:, 0]
    order = np.argsort(keys)
    if (np.diff(keys[order]) == 0).any():
        return None
    at = order[np.minimum(np.searchsorted(keys, turned, sorter=order), len(order) - 1)]
    across = np.where(keys[at] == turned, at % len(cone), -1).reshape(3, -1).T
    return np.ascontiguousarray(np.hstack([across, np.full((len(cone), 1), -1)]), dtype=np.int32)


# ---- measures ------------------------------------------------------------------------------------
def space_table(mesh: Tetrahedralization) -> Table:
    """Tabulate the points: neighbors, the volume of the Voronoi cell, the nearest other point, hull and duplicates."""
    labels, is_duplicate, found = mesh.label_array, mesh.is_duplicate, _found(mesh)
    nearest, on_hull = found["nearest"], found["on_hull"].astype(bool)
    alone = nearest < 0
    x, y, z = np.ascontiguousarray(mesh.points.T)
    columns: dict[str, Any] = {
        "label": labels,
        "x": x,
        "y": y,
        "z": z,
        "neighbors": np.ma.array(found["neighbors"], mask=is_duplicate),
        "cell_volume": np.ma.array(found["cell_volume"], mask=is_duplicate | on_hull),
        "nearest_label": np.ma.array(labels[nearest], mask=alone),
        "nearest_distance": np.ma.array(scaled_norms(mesh.points[nearest] - mesh.points), mask=alone),
        "on_hull": np.ma.array(on_hull, mask=is_duplicate),
        "duplicate_of_label": np.ma.array(labels[mesh.first], mask=~is_duplicate),
    }
    return Table(columns).with_properties(mesh.properties)


def _found(mesh: Tetrahedralization) -> dict[str, Any]:
    """Count the neighbors, and find the volume of the cell, the nearest point, and what is on the hull."""
    labels = mesh.label_array
    if len(mesh):
        return _core.tetrahedra.point_table(mesh.points, mesh.tetrahedra, mesh.neighbors, labels, 0, None)
    simplices = mesh.planar if len(mesh.planar) else mesh.edges
    return {
        "neighbors": np.bincount(mesh.edges.reshape(-1), minlength=len(labels)),
        "cell_volume": np.full(len(labels), np.inf),
        "nearest": _core.tetrahedra.nearest_corners(mesh.points, simplices, labels, 0, None),
        "on_hull": np.ones(len(labels), dtype=bool),
    }


def spheres(mesh: Tetrahedralization) -> tuple[Floats, Floats]:
    """Vectors from the first corner of each tetrahedron to the center of its sphere, and volumes of tetrahedra."""
    return _core.tetrahedra.spheres(mesh.points, mesh.tetrahedra, 0, None)


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


def cells_fault(cells: SpaceCellSet, threads: int, progress: Progress) -> str | None:
    """The first fault of cells, if they have any."""
    how: Any = {"box": cells.box.reshape(-1), "threads": checked_threads(threads), "progress": progress}
    return _core.cells_in_space.find_fault(cells.sites, **_polyhedra(cells), **how)


def _polyhedra(cells: SpaceCellSet) -> dict[str, Any]:
    names = "vertices", "face_starts", "corners", "face_cells", "cell_starts", "cell_faces"
    return {name: getattr(cells, name) for name in names}
