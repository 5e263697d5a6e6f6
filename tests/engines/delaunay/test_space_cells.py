"""Voronoi cells of points in space: the functions, beside scipy, and the checker. The core has tests of its own."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import ConvexHull, Voronoi

import vorotool
from vorotool import InputError, VerificationError, verify_cells, voronoi_cells

POINTS = np.random.default_rng(3).random((60, 3))
UNIT = (0, 0, 0, 1, 1, 1)


def test_volumes_of_inner_cells_are_those_of_scipy():
    cells = voronoi_cells(POINTS, frame=(-9, -9, -9, 19, 19, 19))
    diagram = Voronoi(POINTS)
    inner = 0
    for point, region in enumerate(diagram.point_region):
        corners = diagram.regions[region]
        places = diagram.vertices[corners]
        if -1 in corners or not ((places > -9) & (places < 10)).all():
            continue
        hull = ConvexHull(places)
        assert cells.volumes[point] == pytest.approx(hull.volume, rel=1e-9)
        assert cells.areas[point] == pytest.approx(hull.area, rel=1e-9)
        inner += 1
    assert inner > 10


def test_cells_of_points_and_of_their_triangulation_are_the_same():
    mesh = vorotool.delaunay(POINTS)
    cells = voronoi_cells(mesh, frame=UNIT)
    assert cells == voronoi_cells(POINTS, frame=UNIT)
    assert cells == voronoi_cells(vorotool.VolumePoints(POINTS), frame=UNIT, threads=1)
    assert len(cells) == 60
    assert cells.volumes.sum() == pytest.approx(1, rel=1e-14)
    assert cells.box.tolist() == [[0, 0, 0], [1, 1, 1]]
    assert repr(cells).startswith("SpaceCellSet: 60 cells, ")
    verify_cells(cells)


def test_the_default_box_is_that_of_the_points():
    cells = voronoi_cells(POINTS)
    np.testing.assert_array_equal(cells.box, [POINTS.min(axis=0), POINTS.max(axis=0)])
    verify_cells(cells)
    with pytest.raises(InputError, match=r"the same z, .*give frame=\(x, y, z, width, height, depth\)"):
        voronoi_cells(np.c_[POINTS[:, :2], np.ones(60)])
    with pytest.raises(InputError, match="there are no points"):
        voronoi_cells(np.empty((0, 3)))


def test_what_cells_in_space_lack_is_refused():
    with pytest.raises(InputError, match="cells in space are clipped to a box alone"):
        voronoi_cells(POINTS, frame=UNIT, clip=[[0, 0], [1, 0], [0, 1]])
    with pytest.raises(InputError, match="large enough for coordinates of this size"):
        voronoi_cells(POINTS, frame=(1e20, 0, 0, 1, 1, 1))


def test_points_in_a_plane_have_cells_in_a_box():
    cells = voronoi_cells([[0, 0, 0], [2, 0, 0], [0, 2, 0]], frame=(-1, -1, -1, 4, 4, 2))
    assert cells.volumes.tolist() == [8, 12, 12]
    verify_cells(cells)


@pytest.mark.filterwarnings("ignore:.*lie on an earlier point")
def test_rows_tell_of_empty_cells():
    points = vorotool.VolumePoints([[1, 1, 1], [1, 1, 1], [9, 1, 1], [30, 1, 1]], labels=[5, 6, 7, 8])
    cells = voronoi_cells(points, frame=(0, 0, 0, 10, 2, 2))
    verify_cells(cells)
    assert dict(cells.table().items()) == {
        "label": pytest.approx([5, 6, 7, 8]),
        "x": pytest.approx([1, 1, 9, 30]),
        "y": pytest.approx([1] * 4),
        "z": pytest.approx([1] * 4),
        "volume": pytest.approx([20, 0, 20, 0]),
        "area": pytest.approx([48, 0, 48, 0]),
        "faces": pytest.approx([6, 0, 6, 0]),
        "neighbors": pytest.approx([1, 0, 1, 0]),
    }


# ---- the checker ---------------------------------------------------------------------------------
def changed(array, at, value):
    copy = array.copy()
    copy[at] = value
    return copy


CELLS = voronoi_cells(POINTS, frame=UNIT)
INNER = int(np.argmax(CELLS.face_cells[:, 1] >= 0))
CORNER = int(CELLS.face(INNER)[0])
FAULTS = {
    "a coordinate is not finite": {"sites": changed(CELLS.sites, (0, 0), np.nan)},
    "not two cells": {"face_cells": CELLS.face_cells[:, ::-1]},
    "not those that have them": {"cell_faces": CELLS.cell_faces[::-1]},
    "nearer to one of their sites": {"sites": CELLS.sites + 1e-12},
    "outside the box": {"box": CELLS.box * 0.5},
    "not on its side": {"box": CELLS.box * 2},
    "is not closed|three faces": {"corners": changed(CELLS.corners, 0, CORNER + 1)},
    "two faces lie between|not those that have them": {
        "face_cells": changed(CELLS.face_cells, INNER + 1, CELLS.face_cells[INNER]),
    },
    "by the cells across, then the sides": {
        "cell_faces": changed(CELLS.cell_faces, [0, 1], CELLS.cell_faces[[1, 0]]),
    },
    "the surface is not closed": {
        "corners": np.insert(CELLS.corners, 0, CORNER),
        "face_starts": np.append(0, CELLS.face_starts[1:] + 1),
    },
    "is empty, but its site is the nearest": {
        "sites": np.vstack([CELLS.sites, [[0.5, 0.5, 0.5]]]),
        "cell_starts": np.append(CELLS.cell_starts, CELLS.cell_starts[-1]),
    },
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_are_found(fault):
    with pytest.raises(VerificationError, match=fault):
        verify_cells(replace(CELLS, **FAULTS[fault]))


def test_a_face_that_is_divided_is_found():
    divided = next(face for face in range(len(CELLS.face_cells)) if len(CELLS.face(face)) == 4)
    at = int(CELLS.face_starts[divided])
    halves = CELLS.face(divided)[[0, 1, 2, 0, 2, 3]]
    rings = np.concatenate([CELLS.corners[:at], halves, CELLS.corners[at + 4 :]])
    sizes = np.diff(CELLS.face_starts).tolist()
    sizes[divided : divided + 1] = 3, 3
    face_cells = np.insert(CELLS.face_cells, divided, CELLS.face_cells[divided], axis=0)
    owners = sorted((cell, face) for face, cells in enumerate(face_cells.tolist()) for cell in cells if cell >= 0)
    starts = np.searchsorted([cell for cell, _ in owners], range(len(CELLS) + 1))
    changes = {"corners": rings, "face_starts": np.cumsum([0, *sizes]), "face_cells": face_cells}
    with pytest.raises(VerificationError, match="two faces lie between the same cells"):
        verify_cells(replace(CELLS, **changes, cell_faces=[face for _, face in owners], cell_starts=starts))


def test_a_vertex_within_an_edge_is_found():
    points = np.array([[x, y, z] for x in (1, 3, 5) for y in (1, 3, 5) for z in (1, 3, 5)])
    cells = voronoi_cells(points, frame=(0, 0, 0, 6, 6, 6))
    a, b = cells.face(0)[:2]
    rings = [cells.face(face).tolist() for face in range(len(cells.face_cells))]
    for ring in rings:
        for i in range(len(ring)):
            if {ring[i - 1], ring[i]} == {a, b}:
                ring.insert(i, len(cells.vertices))
                break
    changes = {"corners": np.concatenate(rings), "face_starts": np.cumsum([0, *map(len, rings)])}
    middle = (cells.vertices[a] + cells.vertices[b]) / 2
    with pytest.raises(VerificationError, match="fewer than three faces"):
        verify_cells(replace(cells, vertices=np.vstack([cells.vertices, middle]), **changes))


@pytest.mark.filterwarnings("ignore:.*lie on an earlier point")
def test_a_cell_of_a_point_on_an_earlier_one_is_found():
    cells = voronoi_cells([[1, 1, 1], [1, 1, 1]], frame=(0, 0, 0, 2, 2, 2))
    second = {"face_cells": np.c_[cells.face_cells[:, 0] + 1, cells.face_cells[:, 1]], "cell_starts": [0, 0, 6]}
    with pytest.raises(VerificationError, match="point 1 lies on an earlier one, but has a cell"):
        verify_cells(replace(cells, **second))


@pytest.mark.parametrize("seed", range(12))
def test_cells_of_a_triangulation_that_is_not_delaunay_are_found(seed):
    """An inner point has moved since; not always so that it is in other tetrahedra now."""
    rng = np.random.default_rng([7, seed])
    points = rng.random((300, 3))
    mesh = vorotool.delaunay(points)
    points[np.argmin(np.abs(points - 0.5).max(axis=1))] += rng.normal(scale=0.01, size=3)
    cells, right = (voronoi_cells(each, frame=UNIT) for each in (replace(mesh, points=points), points))
    verify_cells(right)
    if np.array_equal(cells.face_cells, right.face_cells):
        verify_cells(cells)
    else:
        with pytest.raises(VerificationError, match=r"is not convex|goes round the wrong way"):
            verify_cells(cells)


def test_missing_cells_and_turned_faces_are_found():
    turned = np.concatenate([CELLS.face(face)[::-1] for face in range(len(CELLS.face_cells))])
    with pytest.raises(VerificationError, match="the wrong way"):
        verify_cells(replace(CELLS, corners=turned))
    nothing = {"corners": [], "face_starts": [0], "face_cells": np.empty((0, 2), int), "cell_faces": []}
    with pytest.raises(VerificationError, match="do not add up"):
        verify_cells(replace(CELLS, **nothing, cell_starts=np.zeros(61, int)))
    with pytest.raises(InputError, match="corners must be from 0 to"):
        replace(CELLS, corners=CELLS.corners + 99999)


@pytest.mark.parametrize("seed", range(40))
def test_faces_that_roundings_make_small_are_no_faults(seed):
    points = np.random.default_rng([45, seed]).integers(0, 4, (30, 3)) * 0.1
    cells = vorotool.voronoi_cells(np.unique(points, axis=0), frame=(-1, -1, -1, 3, 3, 3))
    vorotool.verify_cells(cells)
    assert cells.volumes.sum() == pytest.approx(27)
