"""Polygons from shapely geometry and nested lists, and back."""

import numpy as np
import pytest
import shapely

from vorotool import InputError, PointSet, PolygonSet
from vorotool.geometry.polygons.conversion import as_polygons, to_shapely
from vorotool.geometry.polygons.polygon_set import HOLE, LINE, SHELL

TRIANGLE = [[0, 0], [9, 0], [0, 9]]
HOLED = shapely.Polygon(TRIANGLE, [[[1, 1], [2, 1], [1, 2]]])
PATH = shapely.LineString([(0, 0), (1, 1), (2, 0)])


def test_one_shell():
    for source in (TRIANGLE, np.array(TRIANGLE), [*TRIANGLE, [0, 0]], [tuple(p) for p in TRIANGLE], [TRIANGLE]):
        shapes = as_polygons(source)
        assert shapes.xy.tolist() == TRIANGLE
        assert shapes.ring_kind.tolist() == [SHELL]
    assert as_polygons(shapes) is shapes


def test_shapely():
    collection = shapely.GeometryCollection([HOLED, PATH, shapely.MultiPolygon([HOLED, shapely.box(20, 20, 30, 30)])])
    shapes = as_polygons([PATH, collection, shapely.Polygon(), shapely.MultiLineString([PATH, PATH])])
    assert shapes.ring_polygon.tolist() == [0, 1, 1, 2, 3, 3, 4, 5, 6]
    assert shapes.ring_kind.tolist() == [LINE, SHELL, HOLE, LINE, SHELL, HOLE, SHELL, LINE, LINE]
    assert shapes.feature.tolist() == [0, 1, 1, 1, 1, 3, 3]
    assert shapes.part.tolist() == [1, 1, 2, 3, 4, 1, 2]
    back = to_shapely(shapes)
    expected = [PATH, HOLED, PATH, HOLED, shapely.box(20, 20, 30, 30), PATH, PATH]
    assert [each.wkt for each in back] == [each.wkt for each in expected]


def test_lists_of_anything():
    shapes = as_polygons([HOLED, TRIANGLE, {"shell": TRIANGLE, "holes": [TRIANGLE, []]}, {"line": TRIANGLE}, []])
    assert shapes.ring_kind.tolist() == [SHELL, HOLE, SHELL, SHELL, HOLE, LINE]
    assert shapes.feature.tolist() == [0, 1, 2, 3]
    assert len(as_polygons([])) == len(as_polygons(shapely.Polygon())) == 0
    assert as_polygons({"shell": TRIANGLE}).ring_start.tolist() == [0, 3]
    assert as_polygons(shapely.LinearRing(TRIANGLE)).ring_kind.tolist() == [SHELL]


def test_rings_too_small_for_shapely():
    shapes = as_polygons([{"shell": [[1, 2]]}, {"shell": [[1, 2], [3, 4]]}, {"line": [[5, 6]]}])
    assert [each.area for each in to_shapely(shapes)] == [0, 0, 0]
    assert len(to_shapely(PolygonSet([], [0], [], []))) == 0


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("a.geojson", "polygons must be shapely geometry"),
        (5, "polygons must be shapely geometry"),
        (np.array(5.0), "polygons must be shapely geometry"),
        (PointSet([[1, 2]]), "polygons must be shapely geometry"),
        (None, "polygons must be shapely geometry"),
        (shapely.Point(1, 1), "item 1 is or holds a Point"),
        ([HOLED, shapely.MultiPoint([(1, 1)])], "item 2 is or holds a MultiPoint"),
        ([HOLED, 7], "item 2 must have shape"),
        ([HOLED, [[1, 2], [3]]], r"item 2 is no \(n, 2\) array"),
        ([[0, 0, 0], [1, 1, 1], [2, 0, 0]], r"item 1 must have shape \(n, 2\), but has shape \(3, 3\)"),
        ({"hull": TRIANGLE}, "item 1 has neither shell nor line"),
        ({"shell": TRIANGLE, "holes": [TRIANGLE, [[1]]]}, "hole 2 of item 1 must have shape"),
        ([[0, 0], [1, 0], [float("inf"), 1]], r"polygon 1, shell, vertex 3 is \(inf, 1.0\)"),
    ],
)
def test_what_is_refused(source, message):
    with pytest.raises(InputError, match=message):
        as_polygons(source)
