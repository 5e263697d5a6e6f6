"""The index of the input goes to everything that is made of its points and polygons."""

import dataclasses

import numpy as np
import pandas as pd
import pytest
from numpy.random import default_rng

import vorotool as v
from vorotool.errors import InputError
from vorotool.numeric.checks import index_of_rows, joined_index
from vorotool.types.polygons.polygon_set import set_of_rings

NAMES = pd.Index(["d", "a", "c", "b"], name="place")
SITES = [[0, 0], [9, 1], [4, 7], [5, 2]]


def rectangles(index, *, crossing=False):
    """Three polygons; the middle one may cross itself, and be repaired to two."""
    own = [[0, 0], [4, 0], [4, 3], [0, 3]]
    middle = [[10, 0], [14, 4], [14, 0], [10, 4]] if crossing else [[10, 0], [14, 0], [14, 4], [10, 4]]
    xy = np.array([own, middle, [[20, 0], [26, 0], [26, 2], [20, 2]]], dtype=float).reshape(-1, 2)
    return set_of_rings(xy, [4, 4, 4], [0, 0, 0], [0, 1, 2], index=index)


def test_an_index_needs_one_entry_for_each():
    for made in (
        lambda: v.PointSet(SITES, index=[1, 2]),
        lambda: rectangles([1, 2]),
        lambda: v.SeedSet([0, 1, 2], [0, 1, 2], [1, 2, 3], index=[1, 2]),
        lambda: dataclasses.replace(v.delaunay(SITES), index=[1, 2]),
        lambda: dataclasses.replace(v.voronoi_cells(SITES), index=[1, 2]),
        lambda: dataclasses.replace(v.digital_triangulation(SITES), index=[1, 2]),
    ):
        with pytest.raises(InputError, match=r"^index must hold one entry a (point|polygon|site), [34], but holds 2$"):
            made()


def test_the_index_follows_the_order_of_labels():
    points = v.PointSet(SITES, labels=[4, 2, 3, 1], index=NAMES)
    image = v.tessellate(points)
    assert image.seeds.index.tolist() == ["b", "a", "c", "d"]
    assert image.seeds.index.name == "place"
    assert v.digital_delaunay(points).index.tolist() == ["b", "a", "c", "d"]
    assert v.digital_triangulation(points).index.tolist() == ["b", "a", "c", "d"]
    assert v.delaunay(image.seeds).index.tolist() == ["b", "a", "c", "d"]


def test_points_that_are_inserted_bring_their_index():
    first, more = v.PointSet(SITES, index=NAMES), v.PointSet([[3, 3]], index=pd.Index(["new"], name="place"))
    both = v.insert_points(v.delaunay(first), more).index
    assert isinstance(both, pd.Index)
    assert (both.tolist(), both.name) == ([*NAMES, "new"], "place")
    assert v.insert_points(v.delaunay(first), [[3, 3]]).index.tolist() == [*NAMES, None]
    assert v.insert_points(v.delaunay(SITES), more).index.tolist() == [None] * 4 + ["new"]
    assert v.insert_points(v.delaunay(SITES), [[3, 3]]).index is None


def test_the_index_of_polygons_goes_to_skeletons_and_offsets():
    index = pd.MultiIndex.from_tuples([("x", 1), ("x", 2), ("y", 1)])
    given = rectangles(index)
    assert v.skeleton_exact(given).polygons.index is index
    assert v.skeleton_approx(given, step=1).polygons.index.tolist() == index.tolist()
    assert v.centerline(v.skeleton_exact(given)).path.polygons.index.tolist() == index.tolist()
    shapes = v.offset(given, [-0.5, 0.25]).flattened(0.01)
    assert shapes.index.tolist() == [*index, *index]
    around = v.offset(given, 4.0).flattened(0.01)  # they join: what is around several polygons comes from none
    assert around.index.tolist() == [None]


@pytest.mark.parametrize("make", [list, np.array, pd.Index, lambda values: pd.Index(values, name="n").astype("Int64")])
def test_entries_of_chosen_rows(make):
    random = default_rng(5)
    values = random.integers(0, 1000, 40).tolist()
    rows = random.integers(-1, 40, 100)
    assert list(index_of_rows(make(values), rows)) == [values[row] if row >= 0 else None for row in rows]
    assert list(index_of_rows(make(values), rows[rows >= 0])) == [values[row] for row in rows if row >= 0]
    assert list(joined_index(make(values), 40, make(values[:3]), 3)) == [*values, *values[:3]]
    assert len(index_of_rows(make(values), np.empty(0, int))) == 0
