from __future__ import annotations

import numpy as np
import pytest
import shapely

from vorotool import Box, CellSet, InputError

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
