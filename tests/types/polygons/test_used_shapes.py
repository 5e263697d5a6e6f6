"""The one definition of what polygons bound, against exact fractions and each engine."""

from fractions import Fraction

import numpy as np
import pytest
import shapely

from vorotool import distance, hausdorff, skeleton_exact, verify_distances, verify_voronoi, voronoi
from vorotool.convert.polygons import as_polygons
from vorotool.types.polygons.shapely_geometry import to_shapely, used_shapes, with_used_rings

SQUARE = [[0, 0], [10, 0], [10, 10], [0, 10]]
SPIKE = [[0, 0], [10, 0], [10, 10], [5, 10], [5, 30], [5, 10], [0, 10]]
FAR = [[40, 0], [50, 0], [50, 10], [40, 10]]
ABOVE = [[0, 40], [10, 40], [10, 50], [0, 50]]


def holed(*holes):
    return {"shell": SQUARE, "holes": [list(hole) for hole in holes]}


STRANGE = {
    "spike": (SPIKE, 100),
    "spike inwards": ([[0, 0], [10, 0], [10, 10], [5, 10], [5, 3], [5, 10], [0, 10]], 100),
    "hole outside": (holed([[19, 4], [21, 4], [21, 9], [19, 9]]), 100),
    "hole half outside": (holed([[9, 4], [11, 4], [11, 9], [9, 9]]), 95),
    "hole around": (holed([[-1, -1], [11, -1], [11, 4], [-1, 4]]), 60),
    "holes that overlap": (holed([[1, 1], [5, 1], [5, 5], [1, 5]], [[3, 3], [7, 3], [7, 7], [3, 7]]), 72),
    "hole with a spike": (holed([[1, 1], [5, 1], [5, 5], [5, 30], [5, 5], [1, 5]]), 84),
    "segment outside": (holed([[20, 20], [30, 30]]), 100),
    "twice around": ([*SQUARE, [0, 0], [4, 0], [4, 4], [0, 4]], 84),
    "bow": ([[0, 0], [10, 0], [0, 10], [10, 10]], 50),
}


@pytest.fixture(params=STRANGE.values(), ids=STRANGE)
def strange(request):
    return request.param


@pytest.mark.filterwarnings("ignore::vorotool.errors.RepairWarning")
def test_every_engine_uses_the_same_polygon(strange):
    polygon, area = strange
    shape = used_shapes(as_polygons([polygon]))[0]
    assert shape.area == pytest.approx(area, rel=1e-15)
    cells = voronoi([polygon, FAR])
    verify_voronoi(cells)
    assert cells.own_areas.tolist() == pytest.approx([area, 100], rel=1e-9)
    assert sum(each.area for each in to_shapely(skeleton_exact([polygon]).polygons)) == pytest.approx(area, rel=1e-9)
    found = distance([polygon], [ABOVE])
    verify_distances(found)
    assert found.smallest.distance == pytest.approx(shapely.distance(shape, shapely.Polygon(ABOVE)), rel=1e-15)
    verify_distances(hausdorff([polygon], [ABOVE]))
    assert voronoi([polygon, FAR]).neighbors["distance"].tolist() == [
        pytest.approx(shapely.distance(shape, shapely.Polygon(FAR)), rel=1e-15)
    ]


def test_places_are_used_where_the_definition_has_them():
    random = np.random.default_rng(3)
    for _ in range(60):
        shell, *holes = (
            random.integers(0, 9, (random.integers(3, 8), 2)).tolist() for _ in range(random.integers(1, 4))
        )
        given = as_polygons([{"shell": shell, "holes": holes}])
        shape = used_shapes(given)[0]
        for x, y in random.integers(0, 900, (40, 2)):
            place = Fraction(int(x), 100) + Fraction(1, 7000), Fraction(int(y), 100) + Fraction(1, 9000)
            expected = _is_within(shell, place) and not any(_is_within(hole, place) for hole in holes)
            point = shapely.Point(*map(float, place))
            assert shapely.contains(shape, point) == expected or shapely.distance(shape.boundary, point) < 1e-9


def _is_within(ring, place):
    x, y = place
    passed = 0
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1], strict=True):
        if (ay <= y) != (by <= y):
            passed += ax + (y - ay) * Fraction(bx - ax, by - ay) > x
    return passed % 2 == 1


def test_valid_polygons_keep_their_rings():
    given = as_polygons([SQUARE, SPIKE, {"line": [[0, 0], [3, 3]]}, [[1, 2]], [[0, 0], [5, 5]]])
    used, invalid = with_used_rings(given)
    assert invalid.tolist() == [1, 3, 4]
    assert used.feature.tolist() == [0, 1, 2, 3, 4]
    assert used.ring(0).tolist() == SQUARE
    assert used.is_line.tolist() == [False, False, True, True, True]
    assert with_used_rings(as_polygons([SQUARE, FAR]))[0].xy.tolist() == SQUARE + FAR
