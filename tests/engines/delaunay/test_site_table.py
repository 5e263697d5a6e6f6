"""Tables and statistics of sites beside closed forms, NumPy and shapely."""

import numpy as np
import pytest

import vorotool
from support.families.point_families import draw
from support.oracles.whole_numbers import in_units
from vorotool import (
    Box,
    InputError,
    LabelImage,
    PointSet,
    UsageError,
    cell_statistics,
    delaunay,
    site_table,
    voronoi_cells,
)

NAMES = "label x y area perimeter neighbors "
NAMES += "nearest_label nearest_distance touches_frame max_distance on_hull duplicate_of_label"


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
    assert list(table) == NAMES.split()
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


def row(found, measure):
    table = found.summary
    return {name: column[table["measure"].index(measure)] for name, column in table.items()}


def hexagons(side=6):
    """Places of a triangular lattice, whose cells are regular hexagons but for the rounding of √3."""
    j, i = np.mgrid[:side, :side]
    return np.stack([i + j / 2, j * np.sqrt(3) / 2], axis=-1).reshape(-1, 2)


def test_hexagons():
    found = cell_statistics(hexagons())
    assert row(found, "neighbors")["mean"] == 6
    assert row(found, "area")["mean"] == pytest.approx(np.sqrt(3) / 2)
    assert row(found, "roundness")["mean"] == pytest.approx(np.pi / (2 * np.sqrt(3)))
    assert row(found, "area")["disorder"] == pytest.approx(0, abs=1e-12)
    assert row(found, "roundness")["homogeneity"] == pytest.approx(1)
    tree = row(found, "tree_length")
    assert tree["count"] == 35
    assert tree["mean"] == pytest.approx(1)
    assert row(found, "tree_normalized")["mean"] == pytest.approx(35 / np.sqrt(36 * 25 * np.sqrt(3) / 2))


def test_beside_numpy_and_shapely():
    points = draw("uniform", 300, 4)
    frame = (0, 0, 1, 1)
    found = cell_statistics(points, frame=frame)
    shapes = vorotool.voronoi_cells(points, frame=frame).to_shapely()
    whole = np.array([not shape.boundary.intersects(vorotool_frame()) for shape in shapes])
    assert found.cells["whole"].tolist() == whole.tolist()
    area, around = (np.array([getattr(shape, name) for shape in shapes])[whole] for name in ("area", "length"))
    for name, values in (("area", area), ("perimeter", around), ("roundness", 4 * np.pi * area / around**2)):
        found_row = row(found, name)
        assert found_row["count"] == whole.sum()
        assert found_row["mean"] == pytest.approx(values.mean())
        assert found_row["sd"] == pytest.approx(values.std())
        assert found_row["cv"] == pytest.approx(values.std() / values.mean())
        assert found_row["disorder"] == pytest.approx(1 - 1 / (1 + values.std() / values.mean()))
        assert found_row["upper_quartile"] == pytest.approx(np.quantile(values, 0.75))
    assert found.area == pytest.approx(1)


def vorotool_frame():
    import shapely

    return shapely.box(0, 0, 1, 1).boundary


def test_polygons_cut_cells():
    points = draw("uniform", 300, 4)
    frame, clip = (0, 0, 1, 1), "POLYGON ((0.2 0.2, 0.8 0.2, 0.5 0.9, 0.2 0.2))"
    free, cut = cell_statistics(points, frame=frame), cell_statistics(points, frame=frame, clip=[clip])
    inside = cut.cells["whole"]
    assert 0 < inside.sum() < free.cells["whole"].sum()
    assert (free.cells["area"][inside] == cut.cells["area"][inside]).all()
    assert cut.area == pytest.approx(0.6 * 0.7 / 2)


def test_points_on_the_hull_are_left_out_whatever_the_frame():
    points = draw("uniform", 50, 1)
    found = cell_statistics(points, frame=(-1000, -1000, 2000, 2000))
    assert not found.cells["whole"][vorotool.delaunay(points).hull].any()


def test_label_images():
    labels = np.array([[1, 1, 1, 1, 1], [1, 2, 2, 3, 1], [1, 2, 2, 3, 1], [1, 1, 1, 1, 4]], dtype=np.uint8)
    found = cell_statistics(LabelImage(labels))
    assert found.cells["whole"].tolist() == [False, True, True, False]
    assert found.cells["roundness"].tolist()[1:3] == pytest.approx([np.pi / 4, 4 * np.pi * 2 / 36])
    assert row(found, "area")["mean"] == 3
    assert found.area == 20
    with pytest.raises(UsageError, match="leave them out with a label image"):
        cell_statistics(LabelImage(labels), frame=(0, 0, 5, 4))


@pytest.mark.filterwarnings("ignore:.*earlier")
@pytest.mark.parametrize("points", [np.zeros((0, 2)), [[1, 2]], [[0, 0], [3, 4]], [[0, 0], [1, 1], [2, 2], [1, 1]]])
def test_too_few_points(points):
    found = cell_statistics(points)
    assert row(found, "area")["count"] == 0
    assert row(found, "area")["mean"] is np.ma.masked
    assert row(found, "tree_length")["count"] == max(0, len(np.unique(points, axis=0)) - 1)
