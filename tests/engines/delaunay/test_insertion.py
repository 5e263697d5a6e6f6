from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

from support.families.point_families import draw
from support.readers.written import assert_same
from vorotool import InputError, PointSet, VorotoolWarning, _core, delaunay, insert_points, verify_triangulation
from vorotool.engines.delaunay import delaunay as insertion

ARRAYS = ("triangles", "neighbors", "edges", "hull", "first")


@pytest.fixture(autouse=True)
def duplicates_are_expected():
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        yield


def check(points, count, **options):
    """Insert all but the first `count` points; compare with the triangulation of all."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    before = delaunay(points[:count])
    made = insert_points(before, points[count:], **options)
    verify_triangulation(made)
    right = delaunay(points)
    np.testing.assert_array_equal(made.points, right.points)
    assert_same(ARRAYS, made, right)
    return before, made


def outermost_first(points):
    """The same points; those on the bounds come first, so that others are inserted within them."""
    places = {int(each) for axis in (0, 1) for each in (points[:, axis].argmin(), points[:, axis].argmax())}
    order = [*places, *(i for i in range(len(points)) if i not in places)]
    return points[order]


@pytest.fixture
def always_local(monkeypatch):
    """Insert however many points there are, and count how often that was done."""
    done = []
    kernel = _core.delaunay.insert_points

    def counted(*arguments, **run):
        result = kernel(*arguments, **run)
        done.append(result is not None)
        return result

    monkeypatch.setattr(insertion, "MANY", 1000.0)
    monkeypatch.setattr(insertion._core.delaunay, "insert_points", counted)
    return done


@pytest.mark.parametrize("name", ["uniform", "small_lattice", "collinear", "any_double"])
def test_points_are_inserted_anywhere(name):
    points = draw(name, 20, 0)
    for count in (0, 1, 4, 10, 19, 20):
        check(points, count)


def test_hints_change_nothing(always_local):
    points = outermost_first(draw("uniform", 500, 2))
    rng = np.random.default_rng(0)
    for hint in (0, 399, rng.integers(0, 400, 100), [3] * 100):
        check(points, 400, hint=hint)
    doubled = np.concatenate([points[:400], points[:1], points[400:]])
    check(doubled, 401, hint=400)
    assert all(always_local)


def test_threads_change_nothing(always_local):
    points = outermost_first(draw("uniform", 40_000, 2))
    for threads in (1, 2, 5):
        check(points, 39_500, threads=threads)
    assert all(always_local)


def test_what_points_bring():
    old = PointSet(
        [[0, 0], [4, 0], [0, 3]], labels=[7, 3, 9], properties={"name": ["a", "b", "c"]}, y_axis="up", crs="x"
    )
    mesh = insert_points(delaunay(old), PointSet([[1, 1], [2, 1]], properties={"size": [1, 2]}))
    assert mesh.label_array.tolist() == [7, 3, 9, 10, 11]
    assert mesh.properties == {"name": ["a", "b", "c", None, None], "size": [None, None, None, 1, 2]}
    assert (mesh.y_axis, mesh.crs) == ("up", "x")
    assert insert_points(delaunay(old.xy), [[1, 1]]).labels is None
    own = insert_points(delaunay(old.xy), PointSet([[1, 1]], labels=[70]))
    assert own.label_array.tolist() == [1, 2, 3, 70]


def test_duplicates_are_counted_or_refused():
    mesh = delaunay([[0, 0], [4, 0], [0, 3], [4, 3], [1, 1]])
    with pytest.warns(VorotoolWarning, match=r"^1 of 6 points lie on an earlier point"):
        insert_points(mesh, [[1, 1]])
    with pytest.raises(InputError, match="1 of 6"):
        insert_points(mesh, [[1, 1]], strict=True)


@pytest.mark.parametrize(
    ("hint", "message"),
    [(5, "hint 1 is 5"), (-1, "hint 1 is -1"), ([0, 9], "hint 2 is 9"), ([0], "has shape"), (0.5, "integer")],
)
def test_bad_hints(hint, message):
    mesh = delaunay([[0, 0], [4, 0], [0, 3], [4, 3], [1, 1]])
    with pytest.raises(InputError, match=message):
        insert_points(mesh, [[1, 2], [2, 2]], hint=hint)


@pytest.mark.parametrize(
    "change",
    [
        {"triangles": [[0, 1, 9], [1, 3, 2]]},
        {"neighbors": [[0, -1, -1], [-1, -1, 0]]},
        {"neighbors": [[7, -1, -1], [-1, -1, 0]]},
        {"neighbors": [[-1, -1, -1], [-1, -1, -1]]},
        {"hull": [0, 1, 77, 2]},
        {"first": [0, 1, 2, 77]},
        {"edges": [[0, 99]]},
        {"triangles": [[0, 2, 1], [1, 2, 3]]},
    ],
)
def test_arrays_that_are_no_triangulation(change, always_local):
    mesh = replace(delaunay([[0, 0], [4, 0], [0, 3], [4, 3]]), **change)
    with pytest.raises(InputError, match="triangulation"):
        insert_points(mesh, [[1.5, 0.5]])
