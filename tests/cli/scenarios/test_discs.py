"""`--what discs` of skeletons and Voronoi diagrams: tables, GeoJSON, pictures, units, refusals."""

import csv
import io
import json
import re

import numpy as np
import pytest
import shapely
from PIL import Image

SHAPES = json.dumps(
    {
        "type": "FeatureCollection",
        "features": [
            {
                "type": "Feature",
                "id": "pool",
                "properties": {"depth": 3},
                "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [10, 0], [10, 2], [0, 2], [0, 0]]]},
            },
            {
                "type": "Feature",
                "id": "pond",
                "properties": {"depth": 5},
                "geometry": {"type": "Polygon", "coordinates": [[[0, 5], [4, 5], [4, 9], [0, 9], [0, 5]]]},
            },
        ],
    }
)


@pytest.fixture
def shapes(tmp_path):
    path = tmp_path / "shapes.geojson"
    path.write_text(SHAPES)
    return path


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_a_row_a_feature(run, shapes):
    rows = rows_of(run("skeleton-exact", shapes, "-q", "--what", "discs", "--verify").out)
    assert [(row["id"], row["x"], row["y"], row["r"], row["feet"]) for row in rows] == [
        ("pool", "5", "1", "1", "2"),
        ("pond", "2", "7", "2", "4"),
    ]
    assert (rows[0]["x_1"], rows[0]["y_2"], rows[0]["x_3"]) == ("5", "2", "")


def test_count_and_local(run, shapes):
    several = rows_of(run("skeleton-exact", shapes, "-q", "--what", "discs", "--count", "3").out)
    assert [row["x"] for row in several[:3]] == ["5", "1", "3"]
    assert [row["rank"] for row in several] == ["1", "2", "3"] * 2
    local = rows_of(run("skeleton-exact", shapes, "-q", "--what", "discs", "--local").out)
    assert [row["r"] for row in local] == ["1", "2"]


def test_formats(run, shapes, tmp_path):
    run("skeleton-exact", shapes, "-q", "--what", "discs", "--flatten", "0.01", "-o", tmp_path / "discs.geojson")
    made = json.loads((tmp_path / "discs.geojson").read_text())["features"]
    assert [feature["id"] for feature in made] == ["pool", "pond"]
    assert made[1]["properties"] == {"label": 2, "depth": 5, "rank": 1, "x": 2, "y": 7, "r": 2, "feet": 4}
    circle = shapely.geometry.shape(made[1]["geometry"])
    assert shapely.hausdorff_distance(circle.exterior, shapely.Point(2, 7).buffer(2, 64).exterior) < 0.02
    run("skeleton-exact", shapes, "-q", "--what", "discs", "--layers", "discs,feet", "-o", tmp_path / "discs.svg")
    picture = (tmp_path / "discs.svg").read_text()
    radii = [float(r) for r in re.findall(r'<circle [^>]*r="([0-9.]+)" vector', picture)]
    assert len(radii) == 2
    assert radii[1] == pytest.approx(2 * radii[0], abs=0.01)
    run("skeleton-exact", shapes, "-q", "--what", "discs", "-o", tmp_path / "discs.png", "--width", "200")
    with Image.open(tmp_path / "discs.png") as drawn:
        assert drawn.width == 200
    found = json.loads(run("skeleton-exact", shapes, "-q", "--what", "discs", "-f", "json").out)
    assert [row["r"] for row in found] == [1, 2]


def test_masks_in_units(run, tmp_path):
    mask = np.zeros((12, 20), dtype=np.uint8)
    mask[2:10, 3:17] = 255
    Image.fromarray(mask).save(tmp_path / "mask.png")
    command = ("skeleton-exact", tmp_path / "mask.png", "--what", "discs", "--verify", "--pixel-size", "0.5um")
    (row,) = rows_of(run(*command).out)
    assert (row["r"], row["unit"]) == ("2", "um")
    run(
        "skeleton-exact",
        tmp_path / "mask.png",
        "--what",
        "discs",
        "--stats",
        tmp_path / "stats",
        "-o",
        tmp_path / "d.csv",
    )
    stats = json.loads((tmp_path / "stats").read_text())
    assert (stats["discs"], stats["largest_radius"]) == (1, 4)


def test_empty_discs_in_a_frame_and_a_clip(run, tmp_path):
    (tmp_path / "points.csv").write_text("x,y\n0,0\n4,0\n4,4\n0,4\n")
    (tmp_path / "clip.wkt").write_text("POLYGON ((1 0, 3 0, 2 3, 1 0))\n")
    points = tmp_path / "points.csv"
    (row,) = rows_of(run("voronoi", points, "--what", "discs", "--frame", "0,0,4,4", "--verify").out)
    assert (row["x"], row["y"], row["feet"], row["label_3"]) == ("2", "2", "4", "4")
    assert "label" not in row
    clip = tmp_path / "clip.wkt"
    (row,) = rows_of(run("voronoi", points, "--what", "discs", "--clip", clip, "--verify").out)
    assert (row["x"], row["y"]) == ("2", "2")
    both = run("voronoi", points, "--what", "discs", "--clip", clip, "--frame", "0,0,4,1", "--verify", "--count", "2")
    assert (rows_of(both.out)[0]["x"], rows_of(both.out)[0]["y"]) == ("2", "1")
    run("voronoi", points, "--what", "discs", "-o", tmp_path / "empty.svg")
    assert "<circle" in (tmp_path / "empty.svg").read_text()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("skeleton-exact", "--count", "2"), "--count"),
        (("skeleton-exact", "--local"), "--local"),
        (("skeleton-exact", "--what", "discs", "--side", "exterior"), "inside polygons"),
        (("skeleton-exact", "--what", "discs", "--prune", "angle=90"), "--prune"),
        (("skeleton-exact", "--what", "discs", "--count", "0"), "--count"),
        (("voronoi", "--count", "2"), "--count"),
        (("voronoi", "--what", "discs", "--max-distance", "1"), "--max-distance"),
    ],
)
def test_refusals(run, shapes, arguments, said):
    command, *options = arguments
    ended = run(command, shapes, *options)
    assert ended.code == 2
    assert said in ended.err
