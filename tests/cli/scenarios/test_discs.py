"""`--what discs` of skeletons and Voronoi diagrams: tables, GeoJSON, pictures, units, refusals."""

import csv
import io
import json

import numpy as np
import pytest
import shapely
from PIL import Image

SHAPES = [("pool", 3, shapely.box(0, 0, 10, 2)), ("pond", 5, shapely.box(0, 5, 4, 9))]


@pytest.fixture
def shapes(tmp_path):
    path = tmp_path / "shapes.geojson"
    features = [
        {"type": "Feature", "id": name, "properties": {"depth": depth}, "geometry": shapely.geometry.mapping(shape)}
        for name, depth, shape in SHAPES
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return path


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_a_row_a_feature(run, shapes):
    rows = rows_of(run(f"skeleton-exact {shapes} -q --what discs --verify").out)
    assert [(row["id"], row["x"], row["y"], row["r"], row["feet"]) for row in rows] == [
        ("pool", "5", "1", "1", "2"),
        ("pond", "2", "7", "2", "4"),
    ]
    assert (rows[0]["x_1"], rows[0]["y_2"], rows[0]["x_3"]) == ("5", "0", "")


def test_masks_in_units(run, tmp_path):
    mask = np.zeros((12, 20), dtype=np.uint8)
    mask[2:10, 3:17] = 255
    Image.fromarray(mask).save(tmp_path / "mask.png")
    command = ("skeleton-exact", tmp_path / "mask.png", "--what", "discs", "--verify", "--pixel-size", "0.5um")
    (row,) = rows_of(run(*command).out)
    assert (row["r"], row["unit"]) == ("2", "um")
    run(*command[:4], "--local", "--stats", tmp_path / "stats", "-o", tmp_path / "d.csv")
    stats = json.loads((tmp_path / "stats").read_text())
    assert (stats["discs"], stats["largest_radius"]) == (1, 4)


def test_empty_discs_in_a_frame_and_a_clip(run, tmp_path):
    (tmp_path / "points.csv").write_text("x,y\n0,0\n4,0\n4,4\n0,4\n")
    (tmp_path / "clip.wkt").write_text("POLYGON ((1 0, 3 0, 2 3, 1 0))\n")
    points = tmp_path / "points.csv"
    (row,) = rows_of(run(f"voronoi {points} --what discs --frame 0,0,4,4 --verify").out)
    assert (row["x"], row["y"], row["feet"], row["label_3"]) == ("2", "2", "4", "4")
    assert "label" not in row
    clip = tmp_path / "clip.wkt"
    (row,) = rows_of(run(f"voronoi {points} --what discs --clip {clip} --verify").out)
    assert (row["x"], row["y"]) == ("2", "2")
    both = run(f"voronoi {points} --what discs --clip {clip} --frame 0,0,4,1 --verify --count 2")
    assert (rows_of(both.out)[0]["x"], rows_of(both.out)[0]["y"]) == ("2", "1")
    run(f"voronoi {points} --what discs -o {tmp_path}/empty.svg")
    assert "<circle" in (tmp_path / "empty.svg").read_text()
