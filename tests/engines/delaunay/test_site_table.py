from __future__ import annotations

import numpy as np
import pytest

from support.families.point_families import draw
from support.oracles.whole_numbers import in_units
from vorotool import Box, InputError, PointSet, delaunay, site_table, voronoi_cells

NAMES = [
    "label",
    "x",
    "y",
    "area",
    "perimeter",
    "neighbors",
    "nearest_label",
    "nearest_distance",
    "touches_frame",
    "max_distance",
    "on_hull",
    "duplicate_of_label",
]


def nearest_by_definition(points, labels):
    """Label of the nearest other point, exactly; ties to the smallest label."""
    found, (points, _) = [], in_units(points)
    for p in points:
        others = [
            ((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2, label) for q, label in zip(points, labels, strict=True) if q != p
        ]
        found.append(min(others)[1] if others else None)
    return found


@pytest.mark.parametrize(
    "name", ["uniform", "small_lattice", "grid", "exact_circle", "collinear", "kettner", "any_double"]
)
def test_nearest_labels(name):
    points = np.unique(draw(name, 60, 3), axis=0)
    labels = np.random.default_rng(1).permutation(len(points)) + 5
    table = site_table(delaunay(PointSet(points, labels=labels)))
    assert table["nearest_label"].tolist() == nearest_by_definition(points.tolist(), labels.tolist())


def test_columns_agree_with_the_cells_and_the_mesh():
    mesh = delaunay(draw("uniform", 400, 2))
    cells = voronoi_cells(mesh)
    table = site_table(mesh, cells)
    assert list(table) == NAMES
    shapes = cells.to_shapely()
    np.testing.assert_allclose(table["area"], [s.area for s in shapes])
    np.testing.assert_allclose(table["perimeter"], [s.length for s in shapes])
    assert table["neighbors"].sum() == 2 * len(mesh.edges)
    assert table["on_hull"].sum() == len(mesh.hull)
    corners = [np.array(s.exterior.coords) for s in shapes]
    farthest = [np.hypot(*(c - p).T).max() for c, p in zip(corners, mesh.points, strict=True)]
    np.testing.assert_allclose(table["max_distance"], farthest)
    left, bottom, right, top = cells.frame.sides
    touching = [bool(((c == [left, bottom]) | (c == [right, top])).any()) for c in corners]
    assert table["touches_frame"].tolist() == touching
    near = [np.sort(np.hypot(*(mesh.points - p).T))[1] for p in mesh.points]
    np.testing.assert_allclose(table["nearest_distance"], near)


def test_duplicates_and_empty_cells():
    points = PointSet([[0, 0], [50, 0], [0, 0]], labels=[4, 9, 2], properties={"area": ["a", "b", "c"]})
    with pytest.warns(UserWarning, match="1 of 3"):
        mesh = delaunay(points)
    table = site_table(mesh, frame=Box(-1, -1, 1, 1))
    assert [name for name in table if name.startswith("voro_")] == ["voro_area"]
    assert table["voro_area"].tolist() == [4.0, 0.0, None]
    assert table["touches_frame"].tolist() == [1, None, None]
    assert table["nearest_label"].tolist() == [9, 4, None]
    assert table["neighbors"].tolist() == [1, 1, None]
    assert table["duplicate_of_label"].tolist() == [None, None, 4]
    assert table["area"].tolist() == ["a", "b", "c"]
    assert "voro_area" not in site_table(mesh, properties=False)


def test_cells_of_other_points():
    mesh = delaunay([[0, 0], [1, 1]])
    with pytest.raises(InputError, match="computed from this triangulation"):
        site_table(mesh, voronoi_cells([[0, 0], [1, 2]]))
