"""Cells, tables and circles of triangulations, against rationals and definitions."""

import math
from fractions import Fraction

import numpy as np
import pytest
import shapely

from support.families.point_families import FAMILIES, draw
from support.few import few
from support.oracles.delaunay_oracle import circle, cross
from vorotool import Box, CellSet, InputError, PointSet, delaunay, edge_table, point_table, triangle_table

SQUARES = [[0, 0], [2, 0], [2, 2], [0, 2], [2, 0], [4, 0], [4, 2], [2, 2]]


def test_polygons_with_holes_and_parts():
    hole = [[1, 1], [1, 3], [3, 3], [3, 1]]
    shell = [[0, 0], [4, 0], [4, 4], [0, 4]]
    far = [[5, 0], [6, 0], [6, 1]]
    cells = CellSet([[0, 0]], [*shell, *hole, *far], [0, 4, 8, 11], Box(0, 0, 9, 9), [0, 2, 3], [0, 2])
    assert cells.areas.tolist() == [12.5]
    assert cells.perimeters[0] == pytest.approx(16 + 8 + 2 + np.sqrt(2))
    (shape,) = cells.to_shapely()
    assert shape.geom_type == "MultiPolygon"
    assert shape.area == 12.5
    assert shapely.get_num_interior_rings(shapely.get_parts([shape])).tolist() == [1, 0]


def test_polygon_and_cell_starts_go_together():
    with pytest.raises(InputError, match="together"):
        CellSet([[0, 0]], SQUARES, [0, 8], Box(0, 0, 1, 1), polygon_starts=[0, 1])


def test_boxes_around_points_of_any_range():
    largest = np.finfo(float).max
    for points in ([[-largest, 0], [largest, 0]], [[largest, largest]], [[5e-324, 0], [0, 0]], [[1e300, 1e-300]]):
        box = Box.around(np.array(points))
        assert box.left < box.right
        assert box.bottom < box.top
        assert (np.array(points) >= [box.left, box.bottom]).all()
        assert (np.array(points) <= [box.right, box.top]).all()


pytestmark = pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")
LARGEST = Fraction(np.finfo(float).max)


@pytest.mark.parametrize("name", FAMILIES)
def test_lengths_against_rationals(name):
    mesh = delaunay(draw(name, 60, 3))
    points = mesh.points.tolist()
    for (a, b), length in zip(mesh.edges.tolist(), mesh.edge_lengths().tolist(), strict=True):
        square = sum((Fraction(p) - Fraction(q)) ** 2 for p, q in zip(points[a], points[b], strict=True))
        if np.isinf(length):
            assert square * Fraction(1001, 1000) > LARGEST**2
            continue
        error = Fraction(length) * Fraction(10) ** -15 + Fraction(5e-324)
        assert (Fraction(length) - error) ** 2 <= square <= (Fraction(length) + error) ** 2


def test_lengths_beyond_the_largest_double_are_infinite():
    mesh = delaunay([[-1.7e308, -1.7e308], [1.7e308, 1.7e308], [1.7e308, 0.5e308]])
    assert np.isinf(mesh.edge_lengths()).sum() == 2


def test_tables_speak_the_labels_of_the_input():
    points = PointSet([[0, 0], [4, 0], [4, 0], [0, 3]], labels=[70, 5, 6, 9], properties={"name": ["a", "b", "c", "d"]})
    mesh = delaunay(points)
    edges = edge_table(mesh)
    assert list(edges) == ["label_a", "label_b", "x_a", "y_a", "x_b", "y_b", "length"]
    rows = {frozenset(row[:2]): row[2:] for row in zip(*(column.tolist() for column in edges.values()), strict=True)}
    assert rows[frozenset((5, 9))] in [(4, 0, 0, 3, 5), (0, 3, 4, 0, 5)]
    assert set(rows) == {frozenset(pair) for pair in [(70, 5), (5, 9), (9, 70)]}
    (triangle,) = zip(*(column.tolist() for column in triangle_table(mesh).values()), strict=True)
    assert triangle in [(70, 5, 9), (5, 9, 70), (9, 70, 5)]
    table = point_table(mesh)
    assert table["neighbors"].tolist() == [2, 2, None, 2]
    assert table["duplicate_of_label"].tolist() == [None, None, 5, None]
    assert table["on_hull"].tolist() == [True, True, None, True]
    assert list(table["name"]) == ["a", "b", "c", "d"]


def square_root(value):
    """To 120 bits."""
    shift = 240 - value.numerator.bit_length() + value.denominator.bit_length()
    shift += shift % 2
    return Fraction(math.isqrt(int(value * Fraction(2) ** shift))) / Fraction(2) ** (shift // 2)


def within(value, right, error):
    """Whether a double is right up to the error, its own rounding, and overflow."""
    if math.isinf(value):
        return abs(right) * 2 > Fraction(np.finfo(float).max)
    return abs(Fraction(value) - right) <= error + abs(right) * Fraction(2) ** -50 + Fraction(5e-324)


@pytest.mark.parametrize("name", few(FAMILIES, 10))
def test_circles_and_areas_against_rationals(name):
    mesh = delaunay(draw(name, 60, 1))
    centers, radii, areas = mesh.circumcenters, mesh.circumradii, mesh.areas
    for t, corners in enumerate(mesh.points[mesh.triangles].tolist()):
        a, b, c = ((Fraction(x), Fraction(y)) for x, y in corners)
        (x, y), square = circle(a, b, c)
        radius = square_root(square)
        assert within(radii[t], radius, radius / 10**9)
        assert within(centers[t, 0], x, radius / 10**9)
        assert within(centers[t, 1], y, radius / 10**9)
        assert within(areas[t], cross(a, b, c) / 2, cross(a, b, c) / 10**9)
        assert areas[t] >= 0
