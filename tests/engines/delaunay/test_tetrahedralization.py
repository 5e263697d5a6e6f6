"""Delaunay triangulations of points in space, against brute force in rationals and scipy."""

import re
import subprocess
import sys
from dataclasses import replace
from itertools import combinations, product

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import vorotool
from vorotool.engines.delaunay.tetrahedralization import space_table

CUBE = np.array(list(product((0.0, 1.0), repeat=3)))
GRID = np.array(list(product(range(4), range(3), range(3))), dtype=float)
SPHERE = np.array([p for p in product(range(-3, 4), repeat=3) if sum(x * x for x in p) == 9], dtype=float)
SETS = {
    "cube": CUBE,
    "grid": GRID,
    "sphere": SPHERE,
    "octahedron": np.vstack([np.eye(3), -np.eye(3)]),
    "skew lines": np.array([(k, 0, 0) for k in range(6)] + [(0, k, 1) for k in range(6)], dtype=float),
    "random": np.random.default_rng(2).random((40, 3)),
    "clusters": np.random.default_rng(3).normal(size=(30, 3)) * 1e-6 + np.repeat(CUBE[:3], 10, axis=0),
}


@pytest.mark.parametrize("name", SETS)
def test_the_hull_is_filled(name):
    points = SETS[name]
    mesh = vorotool.delaunay(points)
    vorotool.verify_triangulation(mesh)
    assert np.isclose(mesh.volumes.sum(), ConvexHull(points).volume, rtol=1e-9)
    assert len(mesh.points) - len(mesh.edges) + len(mesh.triangles) - len(mesh) == 1
    hull = mesh.points[mesh.hull]
    outside = np.einsum("ij,ij->i", np.cross(hull[:, 1] - hull[:, 0], hull[:, 2] - hull[:, 0]), hull[:, 0])
    assert np.isclose(outside.sum() / 6, mesh.volumes.sum())


def test_points_in_a_plane_have_the_triangles_of_the_plane():
    rng = np.random.default_rng(4)
    xy = np.unique(rng.integers(0, 6, (25, 2)).astype(float), axis=0)
    flat = vorotool.delaunay(xy)
    mesh = vorotool.delaunay(np.column_stack([xy, np.zeros(len(xy))]))
    assert (mesh.dimension, len(mesh), len(mesh.hull)) == (2, 0, 0)
    turned = [tuple(np.roll(row, -int(np.argmin(row)))) for row in (*flat.triangles.tolist(), *mesh.planar.tolist())]
    assert sorted(turned[: len(flat)]) == sorted(turned[len(flat) :])
    assert sorted(mesh.edges.tolist()) == sorted(flat.edges.tolist())
    for rotated in ([2, 1, 0], [0, 2, 1], [1, 2, 0]):  # upright planes
        again = vorotool.delaunay(np.column_stack([xy, np.full(len(xy), 7.0)])[:, rotated])
        assert len(again.triangles) == len(flat)
        vorotool.verify_triangulation(again)
    tilted = vorotool.delaunay(np.column_stack([xy, xy @ [2.0, -3.0]]))
    assert tilted.dimension == 2
    assert len(tilted.triangles) == len(flat)


@pytest.mark.filterwarnings("ignore:.*lie on an earlier point")
@pytest.mark.parametrize(
    ("points", "dimension", "edges"),
    [
        ([[2, 2, 2], [0, 0, 0], [1, 1, 1], [0, 0, 0]], 1, [[0, 2], [1, 2]]),
        ([[1, 2, 3], [1, 2, 3]], 0, []),
        (np.zeros((0, 3)), -1, []),
    ],
)
def test_few_places_have_a_chain_of_edges(points, dimension, edges):
    mesh = vorotool.delaunay(vorotool.VolumePoints(points))
    assert (mesh.dimension, mesh.edges.tolist(), len(mesh.triangles)) == (dimension, edges, 0)
    vorotool.verify_triangulation(mesh)


@pytest.mark.parametrize("function", ["delaunay", "alpha_shape", "alpha_complex", "voronoi_cells"])
def test_arrays_of_other_shapes_are_refused_with_both_shapes(function):
    for shape, instead in (
        ((5, 4), r"\)$"),
        ((3, 7), r": give points\.T$"),
        ((2, 7), r": give points\.T$"),
        ((5,), ""),
    ):
        words = rf"expected shape \(n, 2\) or, in space, \(n, 3\), but got an array of float64 .*{instead}"
        with pytest.raises(vorotool.InputError, match=words):
            getattr(vorotool, function)(np.zeros(shape))
    with pytest.raises(vorotool.InputError, match=r"an \(n, 2\) or, in space, \(n, 3\) array of numbers"):
        getattr(vorotool, function)([[1, 2], [3]])


def test_duplicates_are_counted_and_may_be_refused():
    points = np.vstack([CUBE, CUBE[:2]])
    with pytest.warns(vorotool.VorotoolWarning, match="2 of 10 points lie on an earlier point"):
        mesh = vorotool.delaunay(points)
    assert (mesh.duplicates, mesh.first.tolist()) == (2, [*range(8), 0, 1])
    with pytest.raises(vorotool.InputError, match="remove the duplicates"):
        vorotool.delaunay(points, strict=True)


def test_measures_of_flat_tetrahedra_are_exact():
    flat = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 2.0**-40]])
    mesh = vorotool.delaunay(flat)
    assert mesh.volumes[0] == 2.0**-40 / 6
    ways = flat - mesh.circumcenters[0]
    assert np.allclose(np.linalg.norm(ways, axis=1), mesh.circumradii[0], rtol=1e-9)


def test_a_fault_is_found():
    mesh = vorotool.delaunay(SETS["random"])
    arrays = {name: getattr(mesh, name).copy() for name in ("tetrahedra", "neighbors", "first")}
    turned = arrays["tetrahedra"][:, [1, 0, 2, 3]]
    for wrong in ({"tetrahedra": turned}, {"tetrahedra": arrays["tetrahedra"][:-1], "neighbors": mesh.neighbors[:-1]}):
        made = vorotool.Tetrahedralization(mesh.points, **{"planar": mesh.planar, **arrays, **wrong})
        with pytest.raises(vorotool.VerificationError):
            vorotool.verify_triangulation(made)


def test_faults_of_triangles_in_a_plane_are_found():
    square = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [5, 5, 0]], dtype=float)
    mesh = vorotool.delaunay(square)
    vorotool.verify_triangulation(mesh)
    for planar in (mesh.planar[:-1], mesh.planar[:, ::-1][:1], mesh.planar[:0], np.vstack([mesh.planar, [[0, 1, 2]]])):
        with pytest.raises(vorotool.VerificationError):
            vorotool.verify_triangulation(replace(mesh, planar=planar))
    other = {0: 3, 1: 0, 2: 1, 3: 2, 4: 4}  # the square is divided along its other diagonal
    turned = replace(mesh, planar=np.vectorize(other.get)(mesh.planar))
    with pytest.raises(vorotool.VerificationError):
        vorotool.verify_triangulation(turned)


LIMITED = """
import resource, numpy as np, vorotool
line = np.arange(2500.0)
points = np.concatenate([np.c_[line, 0 * line, 0 * line], np.c_[0 * line, line, 0 * line + 1]])
pages = int(open("/proc/self/statm").read().split()[0])
limit = pages * resource.getpagesize() + (96 << 20)
resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
try:
    vorotool.delaunay(points, threads=1)
except vorotool.LimitError as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits of addresses are those of Linux")
def test_more_tetrahedra_than_memory_holds_are_told_of():
    """Two skew lines of 2 500 points have 2 499 squared."""
    done = subprocess.run([sys.executable, "-c", LIMITED], capture_output=True, text=True, check=True)
    found = re.fullmatch(
        r"5000 points have more than (\d+) tetrahedra, and there is no memory .* parts of them\n", done.stdout
    )
    assert found, done.stdout
    assert 40000 < int(found[1]) < 2499**2 + 40000


# ---- the table -----------------------------------------------------------------------------------


def test_equally_near_points_are_told_apart_by_their_labels():
    table = space_table(vorotool.delaunay(vorotool.VolumePoints(GRID, np.arange(len(GRID), 0, -1))))
    columns = (table[name].tolist() for name in ("label", "x", "y", "z", "nearest_label"))
    for label, x, y, z, nearest in zip(*columns, strict=True):
        near = [p for p in range(len(GRID)) if np.abs(GRID[p] - (x, y, z)).sum() == 1]
        assert nearest == min(len(GRID) - p for p in near), label
    inside = (GRID > 0).all(axis=1) & (GRID.max(axis=0) > GRID).all(axis=1)
    assert np.ma.getmaskarray(table["cell_volume"]).tolist() == (~inside).tolist()
    assert np.allclose(table["cell_volume"].compressed(), 1)


def test_faces_are_those_of_two_tetrahedra_or_of_the_hull():
    mesh = vorotool.delaunay(SETS["random"])
    faces = [frozenset(face) for corners in mesh.tetrahedra.tolist() for face in combinations(corners, 3)]
    assert {frozenset(row) for row in mesh.triangles.tolist()} == set(faces)
    assert {frozenset(row) for row in mesh.hull.tolist()} == {face for face in set(faces) if faces.count(face) == 1}
    edges = {pair for corners in mesh.tetrahedra.tolist() for pair in combinations(sorted(corners), 2)}
    assert list(map(tuple, mesh.edges.tolist())) == sorted(edges)
