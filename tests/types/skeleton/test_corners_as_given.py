"""Corners and feet of what is written of skeletons: the doubles of the input, read back with other readers."""

import json

import ezdxf
import numpy as np
import pytest
import shapely

import vorotool
from vorotool import skeleton_exact, write

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


@pytest.mark.parametrize("fmt", ["geojson", "wkt", "gpkg", "csv", "json", "npz", "dxf", "graphml"])
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
    if fmt == "wkt":
        return ends(shapely.from_wkt(path.read_text().splitlines()))
    if fmt == "gpkg":
        geopandas = pytest.importorskip("geopandas")
        return ends(geopandas.read_file(path).geometry)
    if fmt == "csv":
        rows = np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding=None)
        return set(zip(rows["x0"], rows["y0"], strict=True)) | set(zip(rows["x1"], rows["y1"], strict=True))
    if fmt == "json":
        return {(node["x"], node["y"]) for node in json.loads(path.read_text())["vertices"]}
    if fmt == "npz":
        arrays = np.load(path)
        return set(zip(arrays["vertex_x"], arrays["vertex_y"], strict=True))
    if fmt == "graphml":
        networkx = pytest.importorskip("networkx")
        return {(node["x"], node["y"]) for _, node in networkx.read_graphml(path).nodes(data=True)}
    drawn = ezdxf.readfile(path).modelspace()
    return {(x, y) for line in drawn.query("LINE") for x, y, _ in (line.dxf.start, line.dxf.end)}


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
