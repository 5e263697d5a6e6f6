"""``--spacing`` of triangulations, skeletons and Voronoi maps: what they are of outlines and sites in its unit."""

import json

import numpy as np
import pytest
import shapely
from PIL import Image

import vorotool
from vorotool.engines.label_images.outlines import outlines

MASK = np.zeros((24, 32), np.uint8)
MASK[3:9, 4:11] = MASK[12:20, 15:30] = 255
MASK[14:17, 18:22] = 0
STEPS = (20, 13)  # of 0.025, in 0.5 and 0.325


@pytest.fixture
def masks(tmp_path):
    Image.fromarray(MASK).save(tmp_path / "mask.png")
    (tmp_path / "dots.csv").write_text("x,y\n2,3\n9,4\n4,12\n15,9\n11,14\n")
    return tmp_path


def in_units(polygons):
    return polygons * (0.5, 0.325)


def shapes(path):
    features = json.loads(path.read_text())["features"]
    return shapely.from_geojson([json.dumps(each["geometry"]) for each in features])


@pytest.mark.parametrize("options", [["--prune", "length=0.3um"], ["--outline", "contour"]])
def test_exact_skeletons_are_those_of_outlines_in_the_unit(run, masks, options):
    args = ["--spacing", "0.5,0.325um", "--verify", *options]
    run("skeleton-exact mask.png -o a.geojson", *args)
    polygons = outlines(MASK, outline="contour" if "contour" in options else "crack")
    steps = shapely.transform(polygons.to_shapely(), lambda xy: xy * STEPS)
    skeleton = vorotool.skeleton_exact(steps)
    if "none" not in options:
        criterion = {"length": 0.3 / 0.025} if "length=0.3um" in options else {"scale": 1.5}
        skeleton = vorotool.prune(skeleton, **criterion)
    expected = shapely.transform(skeleton.to_shapely(), lambda xy: xy / 40)
    found = shapes(masks / "a.geojson")
    assert shapely.hausdorff_distance(shapely.union_all(found), shapely.union_all(expected)) < 0.01
    assert sum(shapely.length(found)) == pytest.approx(sum(shapely.length(expected)), rel=1e-3)


@pytest.mark.parametrize("distance", ["-0.3", "-300nm"])
def test_offsets_are_at_distances_in_the_unit(run, masks, distance):
    args = ["--what", "offset", "-d", distance, "--spacing", "0.5,0.325um"]
    run("skeleton-exact mask.png", *args, "-o", "a.geojson")
    first = shapes(masks / "a.geojson")[0]
    assert first.bounds == pytest.approx((3.5 * 0.5 + 0.3, 2.5 * 0.325 + 0.3, 10.5 * 0.5 - 0.3, 8.5 * 0.325 - 0.3))


def test_voronoi_maps(run, masks):
    args = ["--spacing", "0.5,0.325um", "--frame", "0,0,16,8", "--max-distance", "1.5", "--verify"]
    rows = run("voronoi mask.png --what table", *args).rows
    polygons = shapely.transform(outlines(MASK).to_shapely(), in_units)
    cells = vorotool.voronoi(polygons, frame=(0, 0, 16, 8), max_distance=1.5)
    assert [float(row["area"]) for row in rows] == pytest.approx(cells.areas.tolist(), rel=1e-5)


@pytest.mark.parametrize("method", ["exact", "digital-valid"])
def test_triangulations_are_of_places_in_the_unit(run, masks, method):
    args = ["--method", method, "--spacing", "0.5,0.325um", "--verify", "-q"]
    rows = run("delaunay dots.csv -f csv", *args).rows
    points = np.loadtxt(masks / "dots.csv", delimiter=",", skiprows=1)
    mesh = vorotool.delaunay(points * STEPS)
    assert [(int(row["label_a"]) - 1, int(row["label_b"]) - 1) for row in rows] == [
        tuple(e) for e in mesh.edges.tolist()
    ]
    assert [float(row["length"]) for row in rows] == pytest.approx((mesh.edge_lengths() / 40).tolist())
    assert {row["unit"] for row in rows} == {"um"}


def test_places_are_in_the_unit(run, masks):
    args = ["skeleton-exact", "mask.png", "--what", "centerline", "-f", "wkt", "--spacing", "0.5,0.325um", "--from"]
    assert (
        run(*args, "2,1.7875", "--to", "5,1.7875").out
        == "LINESTRING (2 1.7875, 2.725 1.7875, 4.275 1.7875, 5 1.7875)\n"
    )
    words = ["leads from (80, 80) to (560, 200)", "(coordinates in steps of 1/40 um)"]
    run(*args, "2,2", "--to", "14,5", code=3, says=words)
