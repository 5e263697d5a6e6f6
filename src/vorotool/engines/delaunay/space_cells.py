"""Voronoi cells of points in space, clipped to a box, and their check."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.delaunay.tetrahedralization import tetrahedralization
from vorotool.errors import InputError, UsageError, option
from vorotool.numeric.arrays import Floats
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.numbers import finite_double, shown_number
from vorotool.numeric.parallel import Progress
from vorotool.types.mesh.space_cells import BOX_SIDES, SpaceCellSet
from vorotool.types.mesh.tetrahedralization import Tetrahedralization, norms
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
    arrays = cells.face_starts, cells.corners, cells.face_cells, cells.cell_starts, cells.cell_faces
    return _core.cells_in_space.measures(cells.vertices, *arrays, 0, None)


# ---- the checker ---------------------------------------------------------------------------------
_SLACK = 64 * 2.0**-53
"""Of the terms of what is compared, for roundings of the comparison."""


def fault(cells: SpaceCellSet) -> str | None:
    """The first fault of cells, if they have any.

    Polyhedra whose surfaces are closed, whose faces belong to two of them or lie on the box, and that go round once,
    fill the box if their volumes add up to that of the box. Such a subdivision, across each of whose faces the distance
    to the site of the next cell becomes the smaller one, is that of the nearest site: the smallest distance is a
    concave function there, less the square of the place, if it is so across faces.
    """
    if not (np.isfinite(cells.sites).all() and np.isfinite(cells.vertices).all() and np.isfinite(cells.box).all()):
        return "a coordinate is not finite"
    for check in (_fault_of_sides, _fault_of_surfaces, _fault_of_places, _fault_of_volumes):
        found: str | None = check(cells)
        if found is not None:
            return found
    return None


def _fault_of_sides(cells: SpaceCellSet) -> str | None:
    """Each face belongs to its two cells, the smaller first, or to one and the box; no two to the same cells."""
    a, b = cells.face_cells.T.astype(np.int64)
    bad = np.flatnonzero((a < 0) | ((b >= 0) & (b <= a)))
    if bad.size:
        return f"the cells of face {bad[0]} are not two cells, the smaller first, or one and a side of the box"
    keys = a << 32 | (b + len(BOX_SIDES))
    if len(np.unique(keys)) < len(keys):
        return "two faces lie between the same cells"
    owner = np.repeat(np.arange(len(cells)), np.diff(cells.cell_starts))
    faces = np.arange(len(a))
    of_cells = np.concatenate([np.stack([a, faces]), np.stack([b, faces])[:, b >= 0]], axis=1)
    listed = np.stack([owner, cells.cell_faces.astype(np.int64)])
    expected, found = (np.sort(rows[0] << 32 | rows[1]) for rows in (of_cells, listed))
    if not np.array_equal(expected, found):
        return "the faces of cells are not those that have them on a side"
    return None


def _fault_of_surfaces(cells: SpaceCellSet) -> str | None:
    """The surface of each cell is closed, and vertices - edges + faces is 2."""
    sizes = np.diff(cells.face_starts)
    face = np.repeat(np.arange(len(sizes)), sizes)
    tails = cells.corners.astype(np.int64)
    after = np.arange(1, len(tails) + 1)
    after[cells.face_starts[1:] - 1] = cells.face_starts[:-1]
    heads = tails[after]
    first, second = cells.face_cells[face].T.astype(np.int64)
    inner = second >= 0
    cell = np.concatenate([first, second[inner]])
    start, end = np.concatenate([tails, heads[inner]]), np.concatenate([heads, tails[inner]])
    forth, back = np.lexsort([end, start, cell]), np.lexsort([start, end, cell])
    if ((np.diff(cell[forth]) == 0) & (np.diff(start[forth]) == 0) & (np.diff(end[forth]) == 0)).any():
        return "an edge of a cell belongs to three faces"
    open_ones = (cell[forth] != cell[back]) | (start[forth] != end[back]) | (end[forth] != start[back])
    if open_ones.any():
        return f"the surface of cell {cell[forth][np.argmax(open_ones)]} is not closed"
    count = len(cells)
    corner = np.unique(cell * len(cells.vertices) + start) // max(len(cells.vertices), 1)
    euler = np.bincount(corner, minlength=count) - np.bincount(cell, minlength=count) // 2 + np.diff(cells.cell_starts)
    bad = np.flatnonzero((euler != 2) & ~cells.is_empty)
    return f"of cell {bad[0]}, vertices - edges + faces is not 2" if bad.size else None


def _fault_of_places(cells: SpaceCellSet) -> str | None:
    """Corners are as far from the sites of both cells, or on the side of the box; each site is on its side."""
    face = np.repeat(np.arange(len(cells.face_cells)), np.diff(cells.face_starts))
    places = cells.vertices[cells.corners]
    first, second = cells.face_cells[face].T
    low, high = cells.box
    outside = (places < low) | (places > high)
    if outside.any():
        return f"vertex {cells.corners[np.argmax(outside.any(axis=1))]} is outside the box"
    on_box = second < 0
    side = -1 - second[on_box]
    wrong = places[on_box, side // 2] != cells.box[side % 2, side // 2]
    if wrong.any():
        return f"a corner of face {face[on_box][np.argmax(wrong)]} is not on its side of the box"
    v, p, q = places[~on_box], cells.sites[first[~on_box]], cells.sites[second[~on_box]]
    exponent = -_exponent(cells)
    v, p, q = (np.ldexp(each, exponent) for each in (v, p, q))
    terms = (q - p) * ((v - p) + (v - q))
    allowed = np.abs(q - p) * (np.abs(v - p) + np.abs(v - q)) * _SLACK + 2 * np.abs(q - p) * np.spacing(np.abs(v))
    nearer = np.abs(terms.sum(axis=1)) > allowed.sum(axis=1) + 2.0**-1000
    if nearer.any():
        at = np.flatnonzero(~on_box)[np.argmax(nearer)]
        return (
            f"vertex {tuple(places[at].tolist())} between cells {first[at]} and {second[at]} is nearer to one of their "
            "sites by more than rounding explains"
        )
    return _fault_of_normals(cells)


def _fault_of_normals(cells: SpaceCellSet) -> str | None:
    """Faces go round as seen from outside the first cell: their areas, as vectors, go to the second site."""
    inner = np.flatnonzero(cells.face_cells[:, 1] >= 0)
    first, second = cells.face_cells[inner].T
    areas, roundings = (each[inner] for each in _area_vectors(cells))
    ways = cells.sites[second] - cells.sites[first]
    exponent = -_exponent(cells)
    areas, roundings = np.ldexp(areas, 2 * exponent), np.ldexp(roundings, 2 * exponent)
    ways = np.ldexp(ways, exponent)
    allowed = (np.abs(areas) * np.abs(ways)).sum(axis=1) / 2 + roundings * np.abs(ways).sum(axis=1)
    bad = np.flatnonzero((areas * ways).sum(axis=1) < -allowed)
    return f"face {inner[bad[0]]} goes round the wrong way" if bad.size else None


def _exponent(cells: SpaceCellSet) -> int:
    """Give that of two of which no coordinate is larger."""
    return int(np.frexp(max(np.abs(cells.sites).max(initial=0.0), np.abs(cells.box).max()))[1])


def _area_vectors(cells: SpaceCellSet) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Twice the area of each face, along its normal, and how far each component may be off as corners are rounded."""
    if not len(cells.face_cells):
        return np.zeros((0, 3)), np.zeros(0)
    starts = cells.face_starts
    start = np.repeat(cells.vertices[cells.corners[starts[:-1]]], np.diff(starts), axis=0)
    ways = cells.vertices[cells.corners] - start
    after = np.arange(1, len(ways) + 1)
    after[starts[1:] - 1] = starts[:-1]
    areas: NDArray[np.float64] = np.add.reduceat(np.cross(ways, ways[after]), starts[:-1])
    step = 2 * np.spacing(np.abs(cells.box).max())  # corners are in the box: no way is off by more
    reach = np.add.reduceat(np.abs(ways).max(axis=1) + step, starts[:-1])
    return areas, 4 * step * reach


def _fault_of_volumes(cells: SpaceCellSet) -> str | None:
    """No volume is negative, and they add up to that of the box."""
    diagonal = float(norms(cells.box[1:] - cells.box[:1])[0])
    if not 2.0**-300 < diagonal < 2.0**300:
        return None
    allowed = 2.0**-40 * diagonal**3
    if (cells.volumes < -allowed).any():
        return f"the volume of cell {np.argmin(cells.volumes)} is negative"
    difference = cells.volumes.sum() - np.prod(cells.box[1] - cells.box[0])
    if len(cells) and abs(difference) > allowed:
        return f"the volumes of the cells do not add up to that of the box: they differ by {difference:g}"
    return None
