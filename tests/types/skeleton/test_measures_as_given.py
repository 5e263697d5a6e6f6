"""Areas and perimeters of what was given, alone and beside what is far away, against exact fractions."""

from fractions import Fraction

import numpy as np
import pytest
import shapely

from vorotool import read, skeleton_exact, verify_skeleton, voronoi, write
from vorotool.types.skeleton.tables import polygon_table

HOUSE = [[7.1489466, 50.9653194], [7.1489765, 50.9652408], [7.1491593, 50.9652698], [7.1491291, 50.9653486]]
FAR = [[-170, -10], [-169, -10], [-169, -9]]
ROOM = [[0.1, 0.1], [5.9, 0.1], [5.9, 1.9], [0.1, 1.9]]
HOLED = {"shell": [[0, 0], [9.9, 0], [9.9, 9.9], [0, 9.9]], "holes": [[[1.1, 1.1], [1.1, 2.2], [2.2, 1.1]]]}
CASES = {"house": HOUSE, "room": ROOM, "hole": HOLED}


def exact_area(polygon):
    rings = [polygon["shell"], *polygon["holes"]] if isinstance(polygon, dict) else [polygon]
    areas = []
    for ring in rings:
        places = [(Fraction(x), Fraction(y)) for x, y in ring]
        pairs = zip(places, places[1:] + places[:1], strict=True)
        areas.append(abs(sum(ax * by - ay * bx for (ax, ay), (bx, by) in pairs)) / 2)
    return float(areas[0] - sum(areas[1:]))


def perimeter(polygon):
    rings = (polygon["shell"], polygon["holes"]) if isinstance(polygon, dict) else (polygon,)
    return shapely.Polygon(*rings).length


@pytest.mark.parametrize("others", [[], [FAR], [FAR, [[20, 20], [30, 20], [30, 30], [25, 30], [25, 40], [25, 30]]]])
@pytest.mark.parametrize("name", CASES)
@pytest.mark.filterwarnings("ignore::vorotool.errors.RepairWarning")
def test_measures_are_those_of_the_input(name, others, tmp_path):
    polygon = CASES[name]
    for features in ("separate", "together"):
        skeleton = skeleton_exact([polygon, *others], features=features)
        write(skeleton, tmp_path / "skeleton.json")
        again = read(tmp_path / "skeleton.json")
        np.testing.assert_array_equal(again.polygons.xy, skeleton.polygons.xy)
        write(skeleton, tmp_path / "skeleton.npz")
        of_arrays = read(tmp_path / "skeleton.npz")
        np.testing.assert_array_equal(of_arrays.polygons.xy, skeleton.polygons.xy)
        verify_skeleton(of_arrays)
        for each in (skeleton, again):
            verify_skeleton(each)
            table = polygon_table(each)
            assert float(table["area"][0]) == pytest.approx(exact_area(polygon), rel=1e-12)
            assert float(table["perimeter"][0]) == pytest.approx(perimeter(polygon), rel=1e-13)
    cells = voronoi([polygon, *others])
    assert cells.own_areas[0] == pytest.approx(exact_area(polygon), rel=1e-12)
