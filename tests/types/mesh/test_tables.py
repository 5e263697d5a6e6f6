"""Tables, lengths and hull of triangulations, against rationals and against the definitions."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from support.families.point_families import FAMILIES, draw
from vorotool import PointSet, delaunay, edge_table, point_table, triangle_table

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
