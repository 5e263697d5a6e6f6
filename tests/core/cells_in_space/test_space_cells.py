"""Voronoi cells in a box, against brute force in integers."""

from itertools import product

import numpy as np
import pytest

from support.oracles.space_cells_oracle import cells_of
from vorotool import _core, delaunay

pytestmark = pytest.mark.filterwarnings("ignore:.*lie on an earlier point")
RNG = np.random.default_rng


def made(points, box, threads=0, mesh=None):
    mesh = mesh or delaunay(np.asarray(points, dtype=float))
    edges = np.zeros((0, 2), dtype=np.int32) if len(mesh) else mesh.edges
    arrays = mesh.points, mesh.tetrahedra, mesh.neighbors, edges, mesh.first
    return _core.cells_in_space.space_cells(*arrays, np.array(box, dtype=float), threads, None)


def measured(cells):
    return _core.cells_in_space.measures(**cells, threads=0, progress=None)


def faces_of(cells, cell):
    """Corners of each face of a cell by its label, counter-clockwise from outside."""
    found = {}
    for face in cells["cell_faces"][cells["cell_starts"][cell] : cells["cell_starts"][cell + 1]].tolist():
        a, b = cells["face_cells"][face].tolist()
        corners = cells["corners"][cells["face_starts"][face] : cells["face_starts"][face + 1]].tolist()
        assert cell in (a, b)
        found[b if cell == a else a] = corners if cell == a else corners[::-1]
    return found


def assert_closed(faces):
    """A polyhedron: each edge once in both directions, and Euler's relation."""
    edges = [edge for corners in faces.values() for edge in zip(corners, [*corners[1:], corners[0]], strict=True)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    vertices = {v for corners in faces.values() for v in corners}
    assert len(vertices) - len(edges) // 2 + len(faces) == 2


def certify(points, box):
    """All cells, their faces and vertices are those of brute force, bit for bit."""
    points = np.asarray(points, dtype=float)
    cells = made(points, box)
    expected = cells_of(points.tolist(), box)
    place_of = {}
    for cell, right in enumerate(expected):
        found = faces_of(cells, cell)
        assert set(found) == set(right)
        for label, corners in found.items():
            rounded = sorted(tuple(float(x) for x in v) for v in right[label])
            assert sorted(tuple(cells["vertices"][v].tolist()) for v in corners) == rounded
            assert len(set(corners)) == len(right[label])
        if found:
            assert_closed(found)
        exact = {v for face in right.values() for v in face}
        numbers = {v for corners in found.values() for v in corners}
        assert len(exact) == len(numbers)
        for v in exact:
            place_of.setdefault(v, set())
    assert len(cells["vertices"]) == len(place_of)
    assert set(range(len(place_of))) == set(cells["corners"].tolist())
    measures = measured(cells)
    whole = np.prod(np.subtract(box[3:], box[:3]))
    assert measures["volumes"].sum() == pytest.approx(whole, rel=1e-12)
    assert (measures["volumes"] > 0).tolist() == [bool(right) for right in expected]
    return cells


def bounds(points):
    return [*np.min(points, axis=0), *np.max(points, axis=0)]


CUBE = np.array(list(product((0, 1), repeat=3)), dtype=float)
OCTAHEDRON = np.vstack([np.eye(3), -np.eye(3)])
UNIT = [0, 0, 0, 1, 1, 1]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("box", [UNIT, [0.25, 0.25, 0.25, 0.75, 0.5, 0.75], [-9, -9, -9, 9, 9, 9]], ids=str)
def test_points_at_random(seed, box):
    certify(RNG(seed).random((9, 3)), box)


@pytest.mark.parametrize("seed", range(12))
def test_points_of_a_small_lattice(seed):
    points = RNG(seed).integers(0, 3, (9, 3)).astype(float)
    for box in ([-1, -1, -1, 3, 3, 3], [0, 0, 0, 2, 2, 2], [0, 0.5, 0, 1.5, 1, 2], [0.5, 0.5, 0.5, 1.5, 1.5, 1.5]):
        certify(points, box)


@pytest.mark.parametrize("seed", range(6))
def test_sides_of_the_box_in_bisectors_and_through_vertices(seed):
    points = 2.0 * RNG(seed).integers(-1, 2, (8, 3)) + 1
    for box in ([0, 0, 0, 2, 2, 2], [-1, -1, 0, 1, 1, 2], [0, -2, -2, 2, 0, 0], [-2, -2, -2, 2, 2, 2]):
        certify(points, box)


@pytest.mark.parametrize(
    "points",
    [CUBE, OCTAHEDRON, np.vstack([CUBE * 2 - 1, OCTAHEDRON]), np.vstack([CUBE, [[0.5, 0.5, 0.5]]])],
    ids=["cube", "octahedron", "both", "centered"],
)
def test_points_on_spheres(points):
    for box in ([-2, -2, -2, 2, 2, 2], [0, 0, 0, 1, 1, 1], [-0.5, 0, 0, 0.5, 1, 0.25], [0.5, 0.5, 0.5, 2, 2, 2]):
        certify(points, box)


@pytest.mark.parametrize("seed", range(4))
def test_points_in_a_plane_on_a_line_and_at_one_place(seed):
    flat = RNG(seed).integers(0, 4, (7, 3)).astype(float)
    flat[:, 2] = flat[:, 0] + 2 * flat[:, 1]
    line = RNG(seed).integers(0, 9, (5, 1)) * np.array([[1.0, 2, -1]])
    for points in (flat, line, flat[:1], np.repeat(flat[:1], 3, axis=0)):
        for box in ([-1, -1, -1, 4, 4, 10], [0, 0, 0, 2, 1, 3]):
            certify(points, box)


def test_duplicates_share_a_cell():
    points = RNG(5).random((6, 3))[[0, 1, 1, 2, 3, 0, 4, 5]]
    cells = certify(points, UNIT)
    assert (np.diff(cells["cell_starts"]) == 0).tolist() == [False, False, True, False, False, True, False, False]


@pytest.mark.parametrize("scale", [2.0**-300, 2.0**300, 1e-9])
@pytest.mark.parametrize("offset", [0, 1e3])
def test_magnitudes(scale, offset):
    points = (RNG(3).random((8, 3)) + offset) * scale
    certify(points, bounds(points))


def test_nearly_cospherical_points():
    points = CUBE + RNG(2).integers(-2, 3, CUBE.shape) * 2.0**-50
    certify(points, [-1, -1, -1, 2, 2, 2])
    certify(points, [0.5, 0.5, 0.5, 2, 2, 2])


def test_lattices_have_cubes():
    points = np.array(list(product(range(9), repeat=3)), dtype=float)
    cells = made(points, [-0.5, -0.5, -0.5, 8.5, 8.5, 8.5])
    assert set(np.diff(cells["cell_starts"]).tolist()) == {6}
    assert len(cells["vertices"]) == 1000
    assert measured(cells)["volumes"].tolist() == [1.0] * 729
    assert measured(cells)["areas"].tolist() == [6.0] * 729


def test_threads_and_permutations_change_nothing():
    points = RNG(7).random((3000, 3))
    points[::3] = np.round(points[::3], 1)
    one, several = made(points, UNIT, threads=1), made(points, UNIT, threads=3)
    for name, values in one.items():
        np.testing.assert_array_equal(values, several[name])
    order = RNG(8).permutation(len(points))
    other = made(points[order], UNIT)
    np.testing.assert_array_equal(np.unique(one["vertices"], axis=0), np.unique(other["vertices"], axis=0))
    first = delaunay(points).first
    for cell in np.flatnonzero(first == np.arange(len(points)))[:300].tolist():
        twin = int(np.flatnonzero((points[order] == points[cell]).all(axis=1))[0])
        a = {frozenset(map(tuple, one["vertices"][c].tolist())) for c in faces_of(one, cell).values()}
        b = {frozenset(map(tuple, other["vertices"][c].tolist())) for c in faces_of(other, twin).values()}
        assert a == b
        assert_closed(faces_of(one, cell))


def test_cells_of_many_points_fill_the_box():
    points = RNG(9).random((20000, 3))
    cells = made(points, bounds(points))
    whole = np.prod(np.ptp(points, axis=0))
    assert measured(cells)["volumes"].sum() == pytest.approx(whole, rel=1e-12)
    corners, faces = cells["corners"], len(cells["face_cells"])
    assert len(cells["vertices"]) - len(corners) // 2 + faces < 0  # each vertex has several cells
    assert (np.diff(cells["face_starts"]) >= 3).all()


def test_a_frame_far_away_is_of_one_cell():
    cells = made(RNG(1).random((50, 3)), [100, 100, 100, 101, 101, 101])
    assert np.count_nonzero(np.diff(cells["cell_starts"])) == 1
    assert len(cells["vertices"]) == 8


def test_what_is_no_triangulation_is_refused():
    mesh = delaunay(RNG(1).random((30, 3)))
    turned = np.ascontiguousarray(mesh.tetrahedra[:, [1, 0, 2, 3]])
    edges = np.zeros((0, 2), dtype=np.int32)
    with pytest.raises(ValueError, match="not Delaunay"):
        _core.cells_in_space.space_cells(
            mesh.points, turned, mesh.neighbors, edges, mesh.first, np.array(UNIT, dtype=float), 0, None
        )
