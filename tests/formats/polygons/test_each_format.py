"""Polygons and lines in GeoJSON, JSON, .poly files and well-known text."""

import json
from dataclasses import replace

import pytest

from support.readers.polygon_reading import assert_same, error_of, notes_of, read, rings, written
from vorotool.convert.polygons import as_polygons
from vorotool.errors import LimitError

SHELL = [[0, 0], [9, 0], [0, 9], [0, 0]]
HOLE = [[1, 1], [2, 1], [1, 2], [1, 1]]
CRS = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2056"}}


def feature(kind, coordinates, **members):
    return {"type": "Feature", "geometry": {"type": kind, "coordinates": coordinates}, "properties": None, **members}


def collection(*features, **members):
    return json.dumps({"type": "FeatureCollection", "features": features, **members})


def test_feature_collection():
    both = {
        "type": "GeometryCollection",
        "geometries": [
            {"type": "LineString", "coordinates": SHELL},
            {"type": "GeometryCollection", "geometries": [{"type": "Polygon", "coordinates": [SHELL]}]},
        ],
    }
    text = collection(
        feature("MultiPolygon", [[SHELL, HOLE, []], [], [SHELL]], id="a", properties={"name": "A"}),
        {"type": "Feature", "geometry": None, "properties": {}},
        feature("LineString", SHELL, properties={"n": 1.5}),
        feature("Polygon", [], id=3),
        {**feature("", None, id=0), "geometry": both},
        feature("MultiLineString", [SHELL, HOLE]),
        crs=CRS,
    )
    shapes = read(text, "a.geojson")
    assert [(kind, polygon, len(ring)) for kind, polygon, ring in rings(shapes)] == [
        (0, 0, 3), (1, 0, 3), (0, 1, 3), (2, 2, 4), (2, 3, 4), (0, 4, 3), (2, 5, 4), (2, 6, 4),
    ]  # fmt: skip
    assert shapes.part.tolist() == [1, 2, 1, 1, 2, 1, 2]
    assert shapes.ids == ["a", "a", None, 0, 0, None, None]
    assert shapes.properties == {
        "name": ["A", "A", None, None, None, None, None],
        "n": [None, None, 1.5, None, None, None, None],
    }
    assert (shapes.y_axis, shapes.crs) == ("up", CRS)
    assert notes_of(text, "a.geojson") == ["a.geojson: 2 features without geometry skipped"]
    back = written(shapes, "geojson")
    assert_same(read(back, "a.geojson"), shapes)
    kinds = [each["geometry"]["type"] for each in json.loads(back)["features"]]
    assert kinds == ["MultiPolygon", "LineString", "GeometryCollection", "MultiLineString"]
    bare = read(text, "a.geojson", properties=False)
    assert (bare.ids, bare.properties, bare.crs) == (None, {}, CRS)


def test_bare_geometry_and_feature():
    polygon = {"type": "Polygon", "coordinates": [SHELL]}
    for text in (polygon, feature("Polygon", [SHELL])):
        assert rings(read(json.dumps(text), "standard input")) == [(0, 0, SHELL[:3])]
    open_ring = {"type": "Polygon", "coordinates": [SHELL[:3]]}
    assert rings(read(json.dumps(open_ring), "a.geojson")) == [(0, 0, SHELL[:3])]
    assert len(read(collection(), "a.geojson")) == 0
    assert written(read(collection(), "a.geojson"), "geojson") == '{"type":"FeatureCollection","features":[]}\n'


def test_the_limits():
    text = collection(feature("Polygon", [SHELL]))
    assert "holds 4 vertices, more than the limit of 3" in error_of(text, "a.geojson", LimitError, max_sites=3)
    text = collection(*(feature("Polygon", [SHELL], properties={f"k{i}": i}) for i in range(10001)))
    assert "has 10001 different properties on 10001 polygons" in error_of(text, "a.geojson", LimitError)


# ---- Polygons and lines as plain JSON -------------------------------------------------------------------


def test_many():
    items = [
        {"id": "a", "part": 1, "shell": SHELL[:3], "holes": [HOLE[:3], HOLE[:3]], "properties": {"n": 1}},
        {"id": "a", "part": 2, "line": SHELL[:3]},
        {"id": 7, "shell": SHELL[:3], "holes": None, "properties": {"m": [1]}},
        {"shell": []},
        SHELL[:3],
    ]
    shapes = read(json.dumps({"polygons": items}))
    assert [kind for kind, _, _ in rings(shapes)] == [0, 1, 1, 2, 0, 0]
    assert shapes.part.tolist() == [1, 2, 1, 1]
    assert shapes.ids == ["a", "a", 7, None]
    assert shapes.properties == {"n": [1, None, None, None], "m": [None, None, [1], None]}
    assert notes_of(json.dumps({"polygons": items})) == ["shapes.json: 1 feature without geometry skipped"]
    assert_same(read(written(shapes, "json")), shapes)
    bare = read(json.dumps({"polygons": items}), properties=False)
    assert (bare.ids, bare.properties) == (None, {})


@pytest.mark.parametrize("text", ["[]", '{"polygons": []}', '{"polygons": [[]]}'])
def test_nothing(text):
    shapes = read(text)
    assert len(shapes) == 0
    assert written(shapes, "json") == '{"y_axis":"none","polygons":[]}\n'


def test_writing():
    shapes = read("[[0, 0.1], [1e-9, 1e300], [0.30000000000000004, 2]]")
    assert written(shapes, "json").replace("e+", "e") == (  # which versions of orjson write or not
        '{"y_axis":"none","polygons":[\n{"shell":[[0.0,0.1],[1e-9,1e300],[0.30000000000000004,2.0]],"holes":[]}\n]}\n'
    )
    assert "[0.3,2.0]" in written(read("[[0, 0.1], [1, 3], [0.32, 2]]"), "json", decimals=1)
    assert_same(read(written(shapes, "json")), shapes)


# ---- Polygons and lines in Triangle's .poly files -------------------------------------------------------
SQUARE = [[0, 0], [9, 0], [9, 9], [0, 9]]
CORNER = [[1, 1], [7, 1], [1, 7]]
ISLAND = [[2, 2], [3, 2], [2, 3]]


@pytest.mark.parametrize("base", [0, 1])
def test_poly(base):
    vertices = [*SQUARE, *CORNER, [20, 0], [21, 1], [20, 2]]
    lines = [f"{i} {x} {y} 1 # vertex" for i, (x, y) in enumerate(vertices, base)]
    ends = [(0, 1), (2, 1), (2, 3), (3, 0), (4, 5), (6, 5), (4, 6), (8, 9), (8, 7)]
    segments = [f"{i} {a + base} {b + base} 0" for i, (a, b) in enumerate(ends, base)]
    text = "\n".join(["# box", f"{len(vertices)} 2 0 1", *lines, "", f"{len(ends)} 1", *segments, "1", "1 1.5 1.5"])
    shapes = read(text, "a.poly")
    assert rings(shapes) == [(0, 0, SQUARE), (1, 0, CORNER), (2, 1, [[20, 0], [21, 1], [20, 2]])]
    assert notes_of(text, "a.poly") == ["a.poly: attributes and boundary markers are ignored"]


def test_round_trip():
    line = {"line": [[20, 0], [21, 1.5], [20, 0]]}
    shapes = as_polygons([line, {"shell": SQUARE, "holes": [CORNER]}, ISLAND, {"line": [[30, 1e-7], [31, 1]]}])
    text = written(shapes, "poly")
    assert rings(read(text, "a.poly")) == rings(shapes)
    assert text.splitlines()[:2] == ["15 2 0 0", "1 20 0"]
    assert len(read("1 2\n1 0 0\n0\n0\n", "a.poly")) == 0


# ---- Polygons and lines in well-known text --------------------------------------------------------------
TEXT = """# shapes
POLYGON ((0 0, 9 0, 0 9, 0 0), (1 1, 2 1, 1 2, 1 1))
SRID=4326;MULTIPOLYGON (((0 0, 9 0, 0 9, 0 0)),
  ((20 20, 30 20.5, 20 30, 20 20)))

LINESTRING (0 0, 1e-7 1)
MULTILINESTRING ((0 0, 1 1), (2 2, 3 3))
GEOMETRYCOLLECTION (LINESTRING (0 0, 1 1), POLYGON ((0 0, 9 0, 0 9, 0 0)))
"""


def test_wkt():
    shapes = read(TEXT, "a.wkt")
    assert [(kind, polygon, len(ring)) for kind, polygon, ring in rings(shapes)] == [
        (0, 0, 3), (1, 0, 3), (0, 1, 3), (0, 2, 3), (2, 3, 2), (2, 4, 2), (2, 5, 2), (2, 6, 2), (0, 7, 3),
    ]  # fmt: skip
    assert shapes.part.tolist() == [1, 1, 2, 1, 1, 2, 1, 2]
    assert shapes.y_axis == "up"
    assert shapes.crs == {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::4326"}}
    assert_same(read(written(shapes, "wkt"), "a.wkt"), replace(shapes, crs=None))
    assert read("LINESTRING (0 0, 1 1)", "a.wkt").crs is None
    assert "line 2: the geometry is in EPSG:3857, but that of line 1 in EPSG:4326" in error_of(
        "SRID=4326;LINESTRING (0 0, 1 1)\nsrid = 3857 ; LINESTRING (0 0, 1 1)", "a.wkt"
    )
    assert written(shapes, "wkt").splitlines() == [
        "POLYGON ((0 0, 9 0, 0 9, 0 0), (1 1, 2 1, 1 2, 1 1))",
        "MULTIPOLYGON (((0 0, 9 0, 0 9, 0 0)), ((20 20, 30 20.5, 20 30, 20 20)))",
        "LINESTRING (0 0, 1e-07 1)",
        "MULTILINESTRING ((0 0, 1 1), (2 2, 3 3))",
        "GEOMETRYCOLLECTION (LINESTRING (0 0, 1 1), POLYGON ((0 0, 9 0, 0 9, 0 0)))",
    ]
    assert written(shapes, "wkt", decimals=0).splitlines()[2] == "LINESTRING (0 0, 0 1)"


def test_nothing_and_too_little():
    assert len(read("", "a.wkt")) == 0
    assert notes_of("POLYGON EMPTY\nLINESTRING Z (0 0 1, 1 1 2)", "a.wkt") == [
        "a.wkt: 1 feature without geometry skipped",
        "a.wkt: only x and y are used; z is ignored",
    ]
    small = as_polygons([{"shell": [[1, 2]]}, {"shell": [[1, 2], [3, 4]]}, {"line": [[5, 6]]}])
    assert written(small, "wkt").splitlines() == [
        "POLYGON ((1 2, 1 2, 1 2, 1 2))",
        "POLYGON ((1 2, 3 4, 1 2, 1 2))",
        "LINESTRING (5 6, 5 6)",
    ]
    assert len(read(written(small, "wkt"), "a.wkt")) == 3
