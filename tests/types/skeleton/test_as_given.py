"""Corners and feet of what is written of skeletons: the doubles of the input, read back with other readers."""

import json
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
import shapely

import vorotool
from support.few import few
from vorotool import extend_ends, prune, read, skeleton_exact, smooth, verify_skeleton, voronoi, write
from vorotool.numeric.arrays import with_length
from vorotool.types.skeleton.tables import polygon_table

ROOM = [[0.1, 0.1], [0.7, 0.1], [0.7, 0.3], [0.1, 0.3]]
ARROW = [[1.3, 0.1], [2.9, 0.7], [1.3, 2.3], [1.7, 0.9]]
TENTHS = {"separate": [ROOM, ARROW], "crossed": [ROOM, [[0.2, -0.1], [0.4, -0.1], [0.4, 0.5], [0.2, 0.5]]]}


def given(polygons):
    return {tuple(place) for polygon in polygons for place in polygon}


def ends(shapes):
    return {place for line in shapes for place in (line.coords[0], line.coords[-1])}


def convex_corners(polygons):
    """Corners where the inner angle is less than two right ones: the skeleton inside ends there."""
    corners = set()
    for ring in polygons:
        before, behind = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
        (ux, uy), (vx, vy) = (np.array(ring) - before).T, (behind - ring).T
        corners |= {tuple(place) for place, turn in zip(ring, ux * vy - uy * vx, strict=True) if turn > 0}
    return corners


@pytest.mark.parametrize("fmt", ["geojson", "csv", "json", "npz", "graphml"])
@pytest.mark.parametrize("features", ["separate", "together"])
def test_skeletons_end_at_the_corners_of_the_input(fmt, features, tmp_path):
    polygons = TENTHS["separate"]
    skeleton = skeleton_exact(polygons, features=features)
    assert not convex_corners(polygons) <= {tuple(place) for place in skeleton.vertices.tolist()}
    path = tmp_path / f"skeleton.{fmt}"
    write(skeleton, path)
    assert convex_corners(polygons) <= read_ends(path, fmt)


def read_ends(path, fmt):
    if fmt == "geojson":
        return ends(shapely.from_geojson(path.read_text()).geoms)
    if fmt == "csv":
        rows = np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding=None)
        return set(zip(rows["x0"], rows["y0"], strict=True)) | set(zip(rows["x1"], rows["y1"], strict=True))
    if fmt == "json":
        return {(node["x"], node["y"]) for node in json.loads(path.read_text())["vertices"]}
    if fmt == "npz":
        arrays = np.load(path)
        return set(zip(arrays["vertex_x"], arrays["vertex_y"], strict=True))
    networkx = pytest.importorskip("networkx")
    return {(node["x"], node["y"]) for _, node in networkx.read_graphml(path).nodes(data=True)}


@pytest.mark.filterwarnings("ignore::vorotool.errors.RepairWarning")
@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("polygons", TENTHS.values(), ids=TENTHS)
@pytest.mark.parametrize("fmt", ["json", "npz"])
def test_what_is_read_back_is_the_skeleton(fmt, polygons, features, tmp_path):
    for side in ("interior", "exterior"):
        skeleton = skeleton_exact(polygons, features=features, side=side)
        write(skeleton, tmp_path / f"skeleton.{fmt}")
        again = vorotool.read(tmp_path / f"skeleton.{fmt}")
        np.testing.assert_array_equal(again.vertices, skeleton.vertices)
        np.testing.assert_array_equal(again.as_given.vertices, skeleton.as_given.vertices)


def test_integers_are_their_own_given():
    skeleton = skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])
    assert skeleton.as_given is skeleton


def test_feet_are_on_the_edges_of_the_input(tmp_path):
    points = vorotool.points_along(skeleton_exact([ROOM]), every=0.05)
    table = points.table()
    on_corner = table["r"] == 0
    assert set(zip(table["x"][on_corner], table["y"][on_corner], strict=True)) == given([ROOM])
    for x, y in (("x_a", "y_a"), ("x_b", "y_b")):
        assert (np.isin(table[x], [0.1, 0.7]) | np.isin(table[y], [0.1, 0.3])).all()
    write(points, tmp_path / "t.wkt", what="transects")
    feet = shapely.get_coordinates(shapely.from_wkt((tmp_path / "t.wkt").read_text().splitlines()))
    assert (np.isin(feet[:, 0], [0.1, 0.7]) | np.isin(feet[:, 1], [0.1, 0.3])).all()


def test_lines_end_at_the_corners_of_the_input():
    skeleton = skeleton_exact([ARROW])
    spike = {(1.3, 0.1), (1.3, 2.3)}
    for lines in (vorotool.extend_ends(skeleton), vorotool.centerline(skeleton), vorotool.smooth(skeleton, 0.01)):
        assert ends(lines.to_shapely()) >= spike
        columns = lines.to_pandas()
        last = 3 if "x3" in columns else 1
        found = {place for k in (0, last) for place in zip(columns[f"x{k}"], columns[f"y{k}"], strict=True)}
        assert found >= spike


HOUSE = [[7.1489466, 50.9653194], [7.1489765, 50.9652408], [7.1491593, 50.9652698], [7.1491291, 50.9653486]]
FAR = [[-170, -10], [-169, -10], [-169, -9]]
LONG_ROOM = [[0.1, 0.1], [5.9, 0.1], [5.9, 1.9], [0.1, 1.9]]
HOLED = {"shell": [[0, 0], [9.9, 0], [9.9, 9.9], [0, 9.9]], "holes": [[[1.1, 1.1], [1.1, 2.2], [2.2, 1.1]]]}
CASES = {"house": HOUSE, "room": LONG_ROOM, "hole": HOLED}


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


@pytest.mark.parametrize(
    "others", few([[], [FAR], [FAR, [[20, 20], [30, 20], [30, 30], [25, 30], [25, 40], [25, 30]]]], 2)
)
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


ROUND, LONG = shapely.Point(3, 4).buffer(2, quad_segs=6), shapely.box(10, 0, 18, 2)
SETS = {"first": [ROUND, LONG], "last": [LONG, ROUND], "between": [LONG, ROUND, LONG], "alone": [ROUND, ROUND]}


@pytest.fixture(params=SETS)
def skeleton(request):
    return prune(skeleton_exact(SETS[request.param]), scale=1.5)


def test_lines_are_empty_where_there_is_one_place(skeleton):
    is_round = skeleton.length == 0
    assert is_round.any()
    for value in (skeleton, smooth(skeleton, 0.1)):
        shapes = value.to_shapely()
        assert shapely.is_empty(shapes).tolist() == is_round.tolist()
        assert shapely.is_valid(shapes).all()
    assert (shapely.length(extend_ends(skeleton).to_shapely()) > 0).sum() == (~is_round).sum()


@pytest.mark.parametrize("fmt", few(["geojson", "gpkg", "graphml", "jsonl", "wkt", "shp", "fgb"], 3))
def test_files_have_every_branch(skeleton, fmt, tmp_path):
    path, is_round = tmp_path / f"skeleton.{fmt}", skeleton.length == 0
    write(skeleton, path)
    if fmt == "wkt":
        found = shapely.is_empty(shapely.from_wkt(path.read_text().splitlines()))
    elif fmt == "jsonl":
        found = [json.loads(line)["geometry"] is None for line in path.read_text().splitlines()]
    elif fmt == "graphml":
        networkx = pytest.importorskip("networkx")
        edges = networkx.read_graphml(path, force_multigraph=True).edges(data="geometry")
        found = [shapely.from_wkt(text).is_empty for _, _, text in edges]
    else:
        found = [shape is None for shape in pytest.importorskip("geopandas").read_file(path).geometry]
    assert sorted(found) == sorted(is_round.tolist())
    if fmt != "graphml":
        assert list(found) == is_round.tolist()


@pytest.mark.parametrize("fmt", ["json", "npz", "csv"])
def test_arrays_have_the_place(skeleton, fmt, tmp_path):
    write(skeleton, tmp_path / f"skeleton.{fmt}")
    if fmt == "csv":
        rows = np.genfromtxt(tmp_path / "skeleton.csv", delimiter=",", names=True, dtype=None, encoding=None)
        assert (np.atleast_1d(rows["x0"] == rows["x1"]) == (skeleton.length == 0)).all()
    else:
        again = read(tmp_path / f"skeleton.{fmt}")
        np.testing.assert_array_equal(again.vertices, skeleton.vertices)


@pytest.mark.parametrize("seed", range(4))
def test_what_has_a_length_is_what_brute_force_says(seed):
    random = np.random.default_rng(seed)
    lines = [random.integers(0, 2, (random.integers(1, 5), 2)).astype(float) for _ in range(60)]
    start = np.concatenate([[0], np.cumsum([len(line) for line in lines])])
    points, left, has_length = with_length(np.concatenate(lines), start)
    expected = [len(np.unique(line, axis=0)) > 1 for line in lines]
    assert has_length.tolist() == expected
    kept = [line for line, is_kept in zip(lines, expected, strict=True) if is_kept]
    assert [points[a:b].tolist() for a, b in pairwise(left)] == [line.tolist() for line in kept]
