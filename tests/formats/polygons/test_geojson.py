"""Polygons and lines in GeoJSON."""

import json

import pytest

from support.readers.polygon_reading import assert_same, error_of, notes_of, read, rings, written
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


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (collection(feature("Polygon", [SHELL]), feature("Point", [1, 2])), "a.geojson, feature 2: 'Point'"),
        (collection(feature("Circle", [])), "a.geojson, feature 1: 'Circle'"),
        (collection(feature(None, [])), "a.geojson, feature 1: None"),
        (collection(feature("Polygon", None)), "a.geojson, feature 1"),
        (collection(feature("Polygon", [5])), "a.geojson, feature 1"),
        (collection(feature("Polygon", [[1, 2]])), "a.geojson, feature 1, vertex 1"),
        (collection(feature("MultiPolygon", [5])), "a.geojson, feature 1"),
        (collection(feature("MultiPolygon", [SHELL])), "a.geojson, feature 1, vertex 1"),
        (collection(feature("MultiLineString", [5])), "a.geojson, feature 1"),
        (
            collection(feature("LineString", SHELL), feature("MultiPolygon", [[SHELL], [SHELL, HOLE, [[1, 2], [1]]]])),
            "a.geojson, feature 2",
        ),
        (
            collection({"type": "Feature", "geometry": {"type": "GeometryCollection", "geometries": [5]}}),
            "a.geojson, feature 1",
        ),
        (collection(5), "a.geojson, feature 1"),
        (collection(feature("Polygon", [SHELL], properties=[])), "a.geojson, feature 1"),
        ("[]", "a.geojson"),
        ('{"a":' * 1000, "a.geojson, line 1"),
    ],
)
def test_bad_geojson(text, message):
    error = error_of(text, "a.geojson")
    assert error.startswith("a.geojson")
    assert message in error


def test_the_limits():
    text = collection(feature("Polygon", [SHELL]))
    assert "holds 4 vertices, more than the limit of 3" in error_of(text, "a.geojson", LimitError, max_sites=3)
    text = collection(*(feature("Polygon", [SHELL], properties={f"k{i}": i}) for i in range(10001)))
    assert "has 10001 different properties on 10001 polygons" in error_of(text, "a.geojson", LimitError)
