from __future__ import annotations

import warnings

import numpy as np
import pytest
import shapely
from scipy.spatial import Delaunay

import vorotool
from support.families.point_families import QUICK, SLOW_LAST, draw
from support.few import few
from support.processes.heard_signals import stop
from support.readers.written import assert_same
from vorotool import InputError, PointSet, VorotoolWarning, delaunay, verify_triangulation

ARRAYS = ("triangles", "neighbors", "edges", "hull", "first")
quick_families = pytest.mark.parametrize("name", few(SLOW_LAST, QUICK))


def quietly(points, **options):
    """The triangulation, checked; duplicates are expected."""
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        mesh = delaunay(points, **options)
    verify_triangulation(mesh)
    return mesh


def edge_set(edges):
    return {tuple(sorted(edge)) for edge in edges.tolist()}


def test_against_scipy():
    for seed in range(3):
        points = draw("uniform", 2000, seed)
        peer = Delaunay(points).simplices
        assert edge_set(delaunay(points).edges) == edge_set(
            np.concatenate([peer[:, [0, 1]], peer[:, 1:], peer[:, ::2]])
        )


@quick_families
def test_threads_change_nothing(name):
    points = draw(name, 2100, 4)  # several parts of 1024 points
    one, *others = (quietly(points, threads=threads) for threads in (1, 2, 5))
    for other in others:
        assert_same(ARRAYS, one, other)


@pytest.mark.parametrize(
    ("points", "edges", "hull"),
    [
        ([], [], []),
        ([[5, 5]], [], [0]),
        ([[5, 5], [1, 2]], [[0, 1]], [1, 0]),
        ([[2, 2], [0, 0], [1, 1], [3, 3]], [[1, 2], [0, 2], [0, 3]], [1, 2, 0, 3]),
    ],
)
def test_chains(points, edges, hull):
    mesh = delaunay(points)
    verify_triangulation(mesh)
    assert mesh.triangles.shape == mesh.neighbors.shape == (0, 3)
    assert edge_set(mesh.edges) == set(map(tuple, edges))
    assert mesh.edges.shape == (len(edges), 2)
    assert mesh.hull.tolist() == hull
    assert mesh.circumcenters.shape == (0, 2)
    assert mesh.circumradii.shape == mesh.areas.shape == (0,)


def test_arrays_and_their_types():
    mesh = delaunay([[0, 0], [2, 0], [2, 1], [0, 1], [1, 3]])
    for array in ARRAYS:
        assert getattr(mesh, array).dtype == np.int32
    assert (mesh.edges[:, 0] < mesh.edges[:, 1]).all()
    assert edge_set(mesh.edges) == {(0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (2, 4), (3, 4)}
    assert mesh.hull.tolist() == [0, 1, 2, 4, 3]


def test_what_is_accepted():
    points = [(0.0, 0.0), (4.0, 1.0), (1.0, 3.0), (2.0, 7.0)]
    mesh = delaunay(points)
    shapes = [shapely.Point(p) for p in points]
    fortran = np.asfortranarray(points)
    for source in (
        np.array(points, np.float32),
        fortran,
        shapes,
        shapely.MultiPoint(points),
        np.array(shapes),
        iter(points),
    ):
        np.testing.assert_array_equal(delaunay(source).triangles, mesh.triangles)
    given = PointSet(points, labels=[3, 1, 4, 2], properties={"name": list("abcd")}, y_axis="up", crs="x")
    told = delaunay(given)
    assert (told.labels.tolist(), told.properties, told.y_axis, told.crs) == ([3, 1, 4, 2], given.properties, "up", "x")
    assert told.label_array.tolist() == [3, 1, 4, 2]
    assert mesh.label_array.tolist() == [1, 2, 3, 4]
    seeds = vorotool.seeds_from_points(given)
    assert delaunay(seeds).label_array.tolist() == [1, 2, 3, 4]
    assert delaunay(seeds).points.tolist() == [list(points[i]) for i in (1, 3, 0, 2)]


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_not_finite_is_refused_naming_the_row(bad):
    with pytest.raises(InputError, match=r"^invalid points: point 3 is \(1\.0, "):
        delaunay([[0, 0], [1, 0], [1, bad]])


@pytest.mark.parametrize("bad", [5, [[1, 2, 3, 4]], [["a", "b"]], [1, 2, 3]])
def test_no_points(bad):
    with pytest.raises(InputError, match=r"^invalid points: expected "):
        delaunay(bad)


def test_duplicates_are_counted():
    points = [[0, 0], [1, 0], [0, 0], [0, 1], [1, 0], [0.0, -0.0]]
    with pytest.warns(VorotoolWarning, match="^3 of 6 points lie on an earlier point"):
        mesh = delaunay(points)
    assert mesh.first.tolist() == [0, 1, 0, 3, 1, 0]
    assert mesh.duplicates == 3
    with pytest.raises(InputError, match="3 of 6 points lie on an earlier point: remove the duplicates"):
        delaunay(points, strict=True)


def test_progress_can_stop_it():
    points = draw("uniform", 1_000_000, 0)
    with pytest.raises(KeyboardInterrupt):
        delaunay(points, threads=1, progress=stop)
