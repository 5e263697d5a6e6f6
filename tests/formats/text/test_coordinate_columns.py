"""Columns and properties that are coordinates have the decimals of the file; other numbers have their digits."""

import csv
import json

import numpy as np
import pytest
import shapely

import vorotool

SHAPES = [shapely.Point(3.123456, 4.234567).buffer(2.345678, quad_segs=2), shapely.box(7.7123, 1.1, 9.3, 8.23456)]


def described(shape):
    return {"type": "Feature", "properties": {"x": 1.23456, "n": 2}, "geometry": shapely.geometry.mapping(shape)}


@pytest.mark.parametrize("fmt", ["geojson", "jsonl"])
def test_of_discs(fmt, tmp_path):
    discs = vorotool.largest_discs({"type": "FeatureCollection", "features": [described(each) for each in SHAPES]})
    vorotool.write(discs, tmp_path / f"a.{fmt}", decimals=1)
    text = (tmp_path / f"a.{fmt}").read_text()
    rows = json.loads(text)["features"] if fmt == "geojson" else list(map(json.loads, text.splitlines()))
    assert len(rows) == 2
    for row, center, radius in zip(rows, discs.xy.tolist(), discs.radius.tolist(), strict=True):
        own = row.get("properties", row)
        assert [own["voro_x"], own["y"]] == [pytest.approx(round(value, 1)) for value in center]
        assert (own["x"], own["r"]) == (1.23456, radius)
    assert vorotool.to_geojson(discs)["features"][0]["properties"]["y"] == discs.xy[0, 1]


@pytest.mark.parametrize(
    ("make", "what", "names"),
    [
        (lambda: vorotool.voronoi(SHAPES), "edges", ["x0", "y0", "cx", "cy", "x1", "y1"]),
        (lambda: vorotool.offset(SHAPES, 0.5), "offset", ["x0", "y0", "x1", "y1", "cx", "cy"]),
        (lambda: vorotool.alpha_shape(np.random.default_rng(1).random((30, 2)), r=0.2), "table", ["bbox_x", "bbox_y"]),
    ],
)
def test_of_tables_where_some_are_missing(make, what, names, tmp_path):
    vorotool.write(make(), tmp_path / "a.csv", what=what, decimals=1)
    with (tmp_path / "a.csv").open() as file:
        rows = list(csv.DictReader(file))
    found = [row[name] for row in rows for name in names if row.get(name)]
    assert found
    assert all(len(text.partition(".")[2]) <= 1 for text in found)
    others = [text for row in rows for name, text in row.items() if name not in names and "." in text]
    assert any(len(text.partition(".")[2]) > 3 for text in others)
