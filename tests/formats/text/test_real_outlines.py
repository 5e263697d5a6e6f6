"""Land and lakes: what is written of them has their areas, their perimeters and the doubles of their vertices."""

import json
import math
from fractions import Fraction

import numpy as np
import pytest
import shapely

import vorotool
from support.documents import DATA
from support.few import few
from vorotool.types.skeleton.tables import polygon_table

NAMES = [
    "great-lakes",
    "ne_110m_lakes",
    "ne_110m_land",
    pytest.param("ne_50m_lakes", marks=pytest.mark.slow),
    pytest.param("ne_50m_land", marks=pytest.mark.slow),
]
CLIP = shapely.Polygon([(-170.1, -80.1), (170.3, -81.7), (165.1, 80.9), (-160.7, 79.3)])
WALL = shapely.LineString([(-30.1, -95.3), (10.7, 95.1)])
pytestmark = pytest.mark.filterwarnings("ignore::vorotool.errors.RepairWarning")


def shapes_of(path):
    found = [each["geometry"] for each in json.loads(path.read_text())["features"]]
    return [shapely.geometry.shape(each) for each in found if each is not None]


def rings_of(polygon):
    return [np.asarray(ring.coords) for ring in (polygon.exterior, *polygon.interiors)]


def exact_measures(polygon):
    """Area and perimeter, correctly rounded but for the roots."""
    areas = []
    for ring in rings_of(polygon):
        x, y = ([Fraction(value) for value in column] for column in ring.T.tolist())
        areas.append(abs(sum(x[k] * y[k + 1] - x[k + 1] * y[k] for k in range(len(x) - 1))) / 2)
    ways = np.concatenate([np.diff(ring, axis=0) for ring in rings_of(polygon)])
    return float(areas[0] - sum(areas[1:])), math.fsum(math.hypot(*way) for way in ways.tolist())


def assert_as_given(shapes, given, step):
    """Corners within two steps of the lattice from vertices of the input are such vertices; gives how many."""
    places = np.unique(shapely.get_coordinates(shapes), axis=0)
    tree, doubles = shapely.STRtree(shapely.points(given)), set(map(tuple, given.tolist()))
    near = np.unique(tree.query(shapely.points(places), predicate="dwithin", distance=2 * step)[0])
    assert shapely.is_valid(shapes).all()
    assert all(tuple(place) in doubles for place in places[near].tolist())
    return len(near)


@pytest.mark.parametrize("name", NAMES)
def test_of_skeletons(name, tmp_path):
    path = DATA / f"{name}.geojson"
    polygons = np.concatenate([shapely.get_parts(shape) for shape in shapes_of(path)])
    given = shapely.get_coordinates(polygons)
    skeleton = vorotool.skeleton_exact(vorotool.read(path, geometry="polygons"))
    table = polygon_table(skeleton)
    vertices = [set(map(tuple, np.concatenate(rings_of(polygon)).tolist())) for polygon in polygons]
    whole = 0
    assert len(polygons) == len(table["area"])
    for k, used in enumerate(skeleton.polygons.as_given.to_shapely()):
        if set(map(tuple, shapely.get_coordinates(used).tolist())) == vertices[k]:  # else it was repaired
            area, perimeter = exact_measures(polygons[k])
            assert float(table["area"][k]) == pytest.approx(area, rel=1e-13)
            assert float(table["perimeter"][k]) == pytest.approx(perimeter, rel=1e-14)
            whole += 1
    assert whole >= 0.99 * len(polygons)
    least = len(np.unique(given, axis=0)) * 0.99
    for made in (vorotool.parts(skeleton), vorotool.rebuild(skeleton)):
        vorotool.write(made, tmp_path / "a.geojson")
        assert assert_as_given(shapes_of(tmp_path / "a.geojson"), given, skeleton.scale) >= least


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("cuts", few([{}, {"clip": [CLIP]}, {"enclosures": [WALL, CLIP.exterior]}], 2))
def test_of_cells(name, cuts, tmp_path):
    path = DATA / f"{name}.geojson"
    shapes = shapes_of(path)
    cells = vorotool.voronoi(vorotool.read(path, geometry="polygons"), **cuts)
    vorotool.write(cells, tmp_path / "a.geojson")
    given = shapely.get_coordinates([*shapes, *(each for cut in cuts.values() for each in cut)])
    found = assert_as_given(shapes_of(tmp_path / "a.geojson"), given, 360 * 2.0**-30)
    assert found >= (4 if "clip" in cuts and name != "great-lakes" else 0)
    if not cuts:
        assert cells.own_areas.tolist() == pytest.approx(shapely.area(shapes).tolist(), rel=1e-12)
