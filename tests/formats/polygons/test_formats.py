"""What an input is taken for, and reading and writing by the library."""

import json
import random

import pytest

import vorotool
from support.readers.polygon_reading import assert_same, error_of, read
from support.refusals import refused
from vorotool import InputError, PointSet, PolygonSet, UsageError, VorotoolError
from vorotool.formats.io.sources import STANDARD_INPUT

POLYGON = '{"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [0, 9], [0, 0]]]}'
POINT = '{"type": "Point", "coordinates": [1, 2]}'


def collected(*geometries):
    return f'{{"type": "GeometryCollection", "geometries": [{", ".join(geometries)}]}}'


@pytest.mark.parametrize(
    ("name", "text", "kind"),
    [
        ("a.geojson", POLYGON, PolygonSet),
        ("a.geojson", POINT, PointSet),
        ("a.geojson", collected('{"type": "GeometryCollection", "geometries": []}', POLYGON), PolygonSet),
        ("a.geojson", collected(POINT), PointSet),
        ("a.geojson", '{"type": "FeatureCollection", "features": []}', PointSet),
        ("a.geojson", f'{{"type": "Feature", "properties": {{"type": "Polygon"}}, "geometry": {POINT}}}', PointSet),
        ("a", POLYGON, PolygonSet),
        ("a.json", POLYGON, PolygonSet),
        ("a.json", POINT, PointSet),
        ("a.json", '{"polygons": []}', PolygonSet),
        ("a.json", "[[0, 0], [1, 0], [0, 1]]", PointSet),
        ("a.json", "[]", PointSet),
        ("a.json", "[[[0, 0], [1, 0], [0, 1]]]", PolygonSet),
        ("a.json", '[{"line": [[0, 0], [1, 0]]}]', PolygonSet),
        ("a.wkt", "# polygon\nPOINT (1 2)", PointSet),
        ("a", "polygon ((0 0, 1 0, 0 1, 0 0))", PolygonSet),
        ("a.wkt", "GEOMETRYCOLLECTION (LINESTRING (0 0, 1 1))", PolygonSet),
        ("a.poly", "2 2\n1 0 0\n2 1 1\n1\n1 1 2\n", PolygonSet),
        ("a.csv", "x,y\n1,2\n", PointSet),
    ],
)
def test_by_content(tmp_path, name, text, kind):
    (tmp_path / name).write_text(text)
    assert type(vorotool.read(tmp_path / name)) is kind


def test_the_caller_knows(tmp_path):
    path = tmp_path / "a.json"
    path.write_text("[[0, 0], [1, 0], [0, 1]]")
    assert len(vorotool.read(path, geometry="polygons").xy) == 3
    path.write_text(POLYGON)
    refused(InputError, "'Polygon' is not a point", vorotool.read, path, geometry="points")
    refused(UsageError, "invalid geometry 'lines'", vorotool.read, path, geometry="lines")
    refused(UsageError, "columns applies to lists of points", vorotool.read, path, geometry="polygons", columns="1,2")
    refused(UsageError, "columns applies to delimited text", vorotool.read, path, columns="1,2")


@pytest.mark.parametrize(
    ("data", "name", "message"),
    [
        (b"", "lakes.shp", "lakes.shp"),
        (b"", "lakes.gpkg", "lakes.gpkg"),
        (b"", "part.gml", "part.gml: .gml"),
        (b"", "part.dxf", "part.dxf"),
        (
            b"\0\0\x27\x0a\0",
            STANDARD_INPUT,
            "standard input is the .shp of a Shapefile, which is several files:",
        ),
        (b"SQLite format 3\0", "a", "a cannot be read as GeoPackage"),
        (b"1,2\n", "a.csv", "a.csv"),
        (b"\xff\xfea", "a.wkt", "a.wkt"),
        (b"\0", "a.wkt", "a.wkt is binary"),
    ],
)
def test_formats_that_are_not_read(data, name, message):
    assert error_of(data, name).startswith(message)
    refused(UsageError, "input_format 'node'", read, data, name, input_format="node")


@pytest.mark.parametrize("fmt", ["json", "geojson", "wkt", "poly"])
def test_writing(tmp_path, fmt):
    document = json.loads(collected(POLYGON, POLYGON.replace("9", "-9")))
    shapes = read(json.dumps(document), "a.geojson")
    vorotool.write(shapes, tmp_path / f"a.{fmt}")
    again = vorotool.read(tmp_path / f"a.{fmt}")
    assert again.xy.tolist() == shapes.xy.tolist()
    vorotool.write(again, tmp_path / "b", fmt=fmt)
    assert (tmp_path / "b").read_bytes() == (tmp_path / f"a.{fmt}").read_bytes()
    if fmt == "geojson":
        assert_same(again, shapes)


def test_what_cannot_be_written(tmp_path):
    shapes = read("[[0, 0], [1, 0], [0, 1]]")
    refused(UsageError, "'csv'", vorotool.write, shapes, tmp_path / "a.csv")
    refused(UsageError, "PointSet", vorotool.write, PointSet([[1, 2]]), tmp_path / "a.csv")
    assert list(tmp_path.iterdir()) == []
    refused(InputError, "these are polygons or lines", vorotool.delaunay, shapes)


WHOLE = {
    "json": (
        '{"polygons": [{"id": "a", "shell": [[0, 0], [4, 0], [0, 4]], "holes": [[[1, 1], [2, 1], [1, 2]]]}, '
        '{"part": 2, "line": [[0, 0], [1, 1]], "properties": {"n": 1}}, [[0, 0], [1, 0], [1, 1]]]}'
    ),
    "geojson": (
        f'{{"type": "FeatureCollection", "features": [{{"type": "Feature", "geometry": {POLYGON}}}, '
        '{"type": "Feature", "id": 3, "properties": {"n": 1}, "geometry": {"type": "MultiLineString", "coordinates": '
        "[[[0, 0, 1], [1.5, 1e3]]]}}]}"
    ),
    "wkt": "POLYGON ((0 0, 4 0, 0 4, 0 0), (1 1, 2 1, 1 2, 1 1))\nGEOMETRYCOLLECTION (LINESTRING Z (0 0 1, 1 1 2))",
    "poly": "6 2\n1 0 0\n2 8 0\n3 0 8\n4 1 1\n5 2 1\n6 1 2\n6\n1 1 2\n2 2 3\n3 3 1\n4 4 5\n5 5 6\n6 6 4\n1\n1 1.2 1.2",
}
SPLINTERS = ["", *'[]{},:"()#\0', "-1", "1e999", "1e308", "1e-320", "null", "EMPTY"]


@pytest.mark.parametrize("fmt", WHOLE)
def test_damaged_files_give_errors_in_words(fmt):
    """Each damaged at one or two places."""
    said = []
    for seed in range(400):
        rng = random.Random(seed)
        text = WHOLE[fmt]
        for _ in range(rng.randint(1, 2)):
            at = rng.randrange(len(text))
            text = text[:at] + rng.choice(SPLINTERS) + text[at + rng.randint(0, 4) :]
        try:
            read(text, f"a.{fmt}")
        except VorotoolError as error:  # anything else fails the test
            said.append(str(error))
    assert all(words.startswith(f"a.{fmt}") for words in said)
    assert 0 < len(said) < 400
