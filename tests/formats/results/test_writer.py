"""What is written of any value: rows as tables, features as GeoJSON and WKT."""

import json

import geopandas
import numpy as np
import pytest
import shapely

import vorotool
from support.families.values import example_values
from support.readers.written import rows_of, written
from vorotool import _core
from vorotool.convert.frames import to_geopandas
from vorotool.products.registry import parts_of

VALUES = example_values()
PARTS = [
    (name, what) for name, value in VALUES.items() for what, each in parts_of(value).items() if "geojson" in each.data
]


@pytest.mark.parametrize(("name", "what"), [part for part in PARTS if part[0] != "PolygonSet"])
def test_geojson_wkt_and_frames_have_the_same_geometry_and_columns(name, what):
    value = VALUES[name]
    features, frame = json.loads(written(value, "geojson", what))["features"], to_geopandas(value, what)
    shapes = [each["geometry"] and shapely.geometry.shape(each["geometry"]) for each in features]
    kinds = [None if shape.is_empty else shape for shape in frame.geometry]
    assert shapely.equals(shapes, kinds)[[shape is not None for shape in kinds]].all()
    assert [shape is None for shape in shapes] == [shape is None for shape in kinds]
    if "wkt" in parts_of(value)[what].data:
        lines = shapely.from_wkt(written(value, "wkt", what).decode().splitlines())
        assert shapely.equals(lines, frame.geometry.values).all()
    assert {column for feature in features for column in feature["properties"]} <= set(frame.columns)


def test_digits_are_those_of_properties_alone():
    skeleton = vorotool.skeleton_exact([[0, 0], [7, 0], [7, 3], [0, 3.1]])
    full, short = (json.loads(written(skeleton, "geojson", precision=digits))["features"] for digits in (None, 3))
    assert [each["geometry"] for each in full] == [each["geometry"] for each in short]
    assert [each["properties"]["length"] for each in short] == [
        float(f"{each['properties']['length']:.3g}") for each in full
    ]


def test_lines_that_rounding_leaves_no_length_are_no_geometry():
    lines = vorotool.skeleton_exact([[0, 0], [4, 0], [4, 0.1], [0, 0.1]])
    features = json.loads(written(lines, "geojson", decimals=0))["features"]
    texts = written(lines, "wkt", decimals=0).decode().splitlines()
    geometry = [None if each["geometry"] is None else shapely.geometry.shape(each["geometry"]) for each in features]
    assert geometry.count(None) == texts.count("LINESTRING EMPTY") == 4  # to the corners
    assert [each for each in geometry if each] == [shapely.from_wkt(text) for text in texts if "(" in text]


@pytest.mark.parametrize("style", ["wkt_lines", "geojson_lines"])
def test_lines_as_text(style):
    rng = np.random.default_rng(5)
    sizes = rng.integers(2, 5, 30)
    rings = np.append(0, np.cumsum(sizes))
    xy = rng.integers(0, 2, (rings[-1], 2)).astype(float)  # many have no length
    rows = np.sort(np.append(rng.integers(0, 31, 11), [0, 30]))
    every = np.arange(31)
    column = _core.text.PolygonTexts(xy, rings, every, rows, _core.text.PolygonStyle[style])
    texts = b"".join(_core.text.format_rows([column], [None], [0], 1, (("", "\n"), "", "none"), False)).decode()
    for text, first, last in zip(texts.splitlines(), rows[:-1], rows[1:], strict=True):
        own = [xy[rings[k] : rings[k + 1]] for k in range(first, last)]
        parts = [each for each in own if (each != each[0]).any()]
        if not parts:
            assert text == "none"
            continue
        made = shapely.from_wkt(text) if style == "wkt_lines" else shapely.from_geojson(text)
        expected = shapely.LineString(parts[0]) if len(parts) == 1 else shapely.MultiLineString(parts)
        assert shapely.equals_identical(made, expected)


def test_kinds_follow_each_other(tmp_path):
    shape = vorotool.alpha_shape([[0, 0], [4, 0], [0, 3], [9, 9], [10, 9], [30, 30]], r=3)
    features = json.loads(written(shape, "geojson", "general"))["features"]
    assert [each["geometry"]["type"] for each in features] == ["Polygon", "LineString", "Point"]
    assert [each["properties"]["class"] for each in features] == ["region", "singular", "isolated"]
    frame = to_geopandas(shape, "general")
    assert frame["class"].tolist() == ["region", "singular", "isolated"]
    assert frame["label"].tolist()[2] == 6
    assert frame["label_a"].isna().tolist() == [True, False, True]
    nothing = vorotool.alpha_shape([[0, 0], [30, 0]], r=1)
    assert len(json.loads(written(nothing, "geojson", "general"))["features"]) == 2
    vorotool.write(shape, tmp_path / "shape.gpkg", what="general")
    assert geopandas.read_file(tmp_path / "shape.gpkg")["class"].tolist() == ["region", "singular", "isolated"]


def test_cells_have_their_measures_in_every_format():
    cells = vorotool.voronoi_cells([[1, 1], [3, 1]], frame=(0, 0, 4, 2))
    for fmt in ("csv", "tsv"):
        assert [row["area"] for row in rows_of(written(cells, fmt), "," if fmt == "csv" else "\t")] == ["4", "4"]
    assert json.loads(written(cells, "json"))["polygons"][0]["properties"]["perimeter"] == 8
