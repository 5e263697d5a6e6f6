"""What is written of any value: rows as tables, features as GeoJSON and WKT."""

import json

import numpy as np
import pytest
import shapely

import vorotool
from support.families.values import example_values
from support.readers.written import rows_of, written
from support.refusals import refused
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


def test_cells_have_their_measures_in_every_format():
    cells = vorotool.voronoi_cells([[1, 1], [3, 1]], frame=(0, 0, 4, 2))
    for fmt in ("csv", "tsv"):
        assert [row["area"] for row in rows_of(written(cells, fmt), "," if fmt == "csv" else "\t")] == ["4", "4"]
    assert json.loads(written(cells, "json"))["polygons"][0]["properties"]["perimeter"] == 8


def test_a_path_without_an_extension_is_named(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = vorotool.delaunay([[0, 0], [4, 0], [0, 3]])
    refused(vorotool.UsageError, "'edges' has no extension", vorotool.write, mesh, "edges")
    vorotool.write(mesh, "edges", fmt="csv")
    assert (tmp_path / "edges").read_text().startswith("label_a,")
