"""Points from JSON and GeoJSON."""

import json

import pytest

from support.readers.point_reading import error_of, notes_of, read
from vorotool.errors import LimitError


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[[1, 2],\n [3, ]]", "a.json, line 2"),
        ("[[1, 2], [3, NaN]]", "a.json, line 1"),
        ('[[1, 2], ["3", 4]]', "a.json, point 2: ['3', 4]"),
        ("[[1, 2], [true, 4]]", "a.json, point 2"),
        ("[[1, 2], [null, 4]]", "a.json, point 2"),
        ("[[1, 2], [3]]", "a.json, point 2: [3]"),
        ("[1, 2]", "a.json, point 1"),
        ("[[1, 2, 3]]", "a.json, point 1: [1, 2, 3]"),
        ('"seeds"', "a.json: 'seeds'"),
        ("[" * 1000, "a.json, line 1"),
        ('{"points": []}', "a.json"),
    ],
)
def test_bad_json(text, message):
    error = error_of(text, "a.json", input_format="json")
    assert error.startswith("a.json")
    assert message in error


def feature(coordinates, kind="Point", **members):
    return {
        "type": "Feature",
        "geometry": {"type": kind, "coordinates": coordinates},
        "properties": None,
        **members,
    }


def collection(*features, **members):
    return json.dumps({"type": "FeatureCollection", "features": features, **members})


def test_geojson():
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2056"}}
    text = collection(
        feature([1, 2], id="a", properties={"name": "A", "n": 1}),
        feature([3.5, 4], id=7, properties={"n": {"deep": [1]}, "id": "own"}),
        crs=crs,
    )
    points = read(text, "a.geojson")
    assert points.xy.tolist() == [[1, 2], [3.5, 4]]
    assert points.y_axis == "up"
    assert points.crs == crs
    assert points.properties == {
        "id": ["a", 7],
        "name": ["A", None],
        "n": [1, {"deep": [1]}],
        "property_id": [None, "own"],
    }
    assert read(text, "a.geojson", properties=False).properties == {}
    assert notes_of(text, "a.geojson") == []


def test_geojson_parts_share_properties():
    text = collection(
        feature([[1, 2], [3, 4]], "MultiPoint", id=5, properties={"part": "p"}),
        feature([5, 6], properties={}),
    )
    assert read(text, "a.geojson").properties == {
        "id": [5, 5, None],
        "part": ["p", "p", None],
        "voro_part": [1, 2, 1],
    }


def test_geojson_notes():
    empty = {"type": "Feature", "geometry": None, "properties": {}}
    text = collection(feature([7.5, 46.9, 500]), empty, feature([]))
    left_out, flattened, unnamed = notes_of(text, "a.geojson")
    assert all(note.startswith("a.geojson") for note in (left_out, flattened, unnamed))
    assert "2 features" in left_out
    assert 'crs="OGC:CRS84"' in unnamed
    assert len(read(text, "a.geojson")) == 1
    wgs84 = {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}
    [note] = notes_of(collection(feature([7, 46]), crs=wgs84), "a.geojson")
    assert 'to_crs="EPSG:32632"' in note
    assert len(read(collection(), "a.geojson")) == 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            collection(feature([1, 2]), feature([[[0, 0], [1, 0], [1, 1], [0, 0]]], "Polygon")),
            "a.geojson, feature 2: 'Polygon' is not a point; replace it by its centroid or its vertices "
            "(voronoi and skeleton_exact take polygons and lines, tessellate(..., cell_size=...) rasterizes them)",
        ),
        (collection(feature([1, 2]), feature([1, "2"])), "a.geojson, feature 2: [1, '2']"),
        (collection(feature(None)), "a.geojson, feature 1"),
        (collection(5), "a.geojson, feature 1"),
        (collection(feature([1, 2], properties=[])), "a.geojson, feature 1"),
        (collection({"type": "Feature", "geometry": "x"}), "a.geojson, feature 1"),
        ('{"type": "FeatureCollection"}', "FeatureCollection"),
        ('{"type": "Circle"}', "a.geojson: 'Circle'"),
        ("[]", "a.geojson"),
        ('{"a":' * 1000, "a.geojson, line 1"),
        ("", "a.geojson"),
    ],
)
def test_bad_geojson(text, message):
    error = error_of(text, "a.geojson")
    assert error.startswith("a.geojson")
    assert message in error


def test_the_limits_of_geojson():
    text = collection(feature([[1, 2]] * 3, "MultiPoint"))
    assert "holds 3 points, more than the limit of 2" in error_of(text, "a.geojson", LimitError, max_sites=2)
    text = collection(*(feature([1, 2], properties={f"k{i}": i}) for i in range(10001)))
    assert "has 10001 different properties on 10001 points" in error_of(text, "a.geojson", LimitError)
    assert len(read(text, "a.geojson", properties=False)) == 10001
