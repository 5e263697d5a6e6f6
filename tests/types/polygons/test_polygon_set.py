"""Polygon sets: their invariants, and what they say of places."""

import numpy as np
import pytest

from vorotool import InputError, PolygonSet
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, set_of_rings

XY = [[0, 0], [9, 0], [0, 9], [1, 1], [2, 1], [1, 2], [5, 5], [6, 6]]
STARTS, KINDS, POLYGONS = [0, 3, 6, 8], [SHELL, HOLE, LINE], [0, 0, 1]


def test_arrays():
    shapes = PolygonSet(XY, STARTS, KINDS, POLYGONS)
    assert len(shapes) == 2
    assert shapes.is_line.tolist() == [False, True]
    assert shapes.polygon_starts.tolist() == [0, 2, 3]
    assert shapes.feature.tolist() == [0, 1]
    assert [ring.tolist() for ring in shapes.rings_of(0)] == [XY[:3], XY[3:6]]
    assert [shapes.place(i) for i in (0, 2, 3, 7)] == [
        "polygon 1, shell, vertex 1",
        "polygon 1, shell, vertex 3",
        "polygon 1, hole 1, vertex 1",
        "polygon 2, line, vertex 2",
    ]
    assert PolygonSet(XY, STARTS, KINDS, POLYGONS, feature=[3, 3]).part.tolist() == [1, 2]


def test_no_polygons():
    empty = PolygonSet([], [0], [], [])
    assert len(empty) == 0
    assert empty.xy.shape == (0, 2)
    assert empty.part.tolist() == empty.is_line.tolist() == []
    assert empty.polygon_starts.tolist() == [0]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"xy": [[0, 0, 0]] * 8}, r"vertices must have shape \(n, 2\)"),
        ({"xy": [["a", "b"]] * 8}, "array of numbers"),
        ({"xy": XY[:7]}, "ring_starts"),
        ({"ring_starts": [0, 3, 3, 8]}, "without empty rings"),
        ({"ring_starts": [1, 3, 6, 8]}, "ring_starts"),
        ({"ring_starts": [0, 3, 8]}, "for r rings give"),
        ({"ring_starts": [[0, 3, 6, 8]]}, "ring_starts"),
        ({"ring_polygon": [0, 0, 2]}, "without gaps"),
        ({"ring_polygon": [0, 0, -1]}, "without gaps"),
        ({"ring_polygon": [1, 1, 2]}, "from 0"),
        ({"ring_polygon": [0, 1, 1]}, "a shell and then holes"),
        ({"ring_polygon": [0, 0, 0]}, "a shell and then holes"),
        ({"ring_kind": [LINE, HOLE, SHELL]}, "or one line"),
        ({"ring_kind": [SHELL, HOLE, 3]}, "ring_kind must be"),
        ({"ids": [1]}, "ids"),
        ({"properties": {"name": "abc"}}, "name must hold one value per polygon"),
        ({"feature": [0]}, "feature must hold one value per polygon"),
        ({"feature": [1, 0]}, "feature must not decrease"),
        ({"xy": [*XY[:4], [np.nan, 1], *XY[5:]]}, r"^polygon 1, hole 1, vertex 2"),
    ],
)
def test_what_is_refused(changed, message):
    arrays = {"xy": XY, "ring_starts": STARTS, "ring_kind": KINDS, "ring_polygon": POLYGONS}
    with pytest.raises(InputError, match=message):
        PolygonSet(**{**arrays, **changed})


def test_rings_that_repeat_their_first_vertex():
    xy = [[0, 0], [1, 0], [0, 1], [0, 0], [0, 0], [5, 5], [5, 5], [7, 7], [8, 8], [7, 7], [3, 3]]
    shapes = set_of_rings(xy, [5, 2, 3, 1], [SHELL, SHELL, LINE, SHELL], [0, 1, 2, 3])
    assert shapes.ring_starts.tolist() == [0, 3, 4, 7, 8]
    assert shapes.xy.tolist() == [[0, 0], [1, 0], [0, 1], [5, 5], [7, 7], [8, 8], [7, 7], [3, 3]]
