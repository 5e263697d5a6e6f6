"""Statistics of cells beside closed forms, NumPy and shapely."""

from __future__ import annotations

import numpy as np
import pytest

import vorotool
from support.families.point_families import draw
from vorotool import LabelImage, UsageError, cell_statistics


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
