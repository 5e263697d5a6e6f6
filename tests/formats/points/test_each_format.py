"""Points from JSON, GeoJSON, .node files, NPY and well-known text."""

import json

import numpy as np
import pytest

from support.few import few
from support.readers.point_reading import error_of, notes_of, npy, read, rows
from vorotool.errors import LimitError
from vorotool.formats.io.sources import STANDARD_INPUT


def feature(coordinates, kind="Point", **members):
    return {"type": "Feature", "geometry": {"type": kind, "coordinates": coordinates}, "properties": None, **members}


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
    rows = {"id": ["a", 7], "name": ["A", None], "n": [1, {"deep": [1]}], "property_id": [None, "own"]}
    assert points.properties == rows
    assert read(text, "a.geojson", properties=False).properties == {}
    assert notes_of(text, "a.geojson") == []


def test_geojson_parts_share_properties():
    both = feature([[1, 2], [3, 4]], "MultiPoint", id=5, properties={"part": "p"})
    text = collection(both, feature([5, 6], properties={}))
    rows = {"id": [5, 5, None], "part": ["p", "p", None], "voro_part": [1, 2, 1]}
    assert read(text, "a.geojson").properties == rows


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


def test_the_limits_of_geojson():
    text = collection(feature([[1, 2]] * 3, "MultiPoint"))
    assert "holds 3 points, more than the limit of 2" in error_of(text, "a.geojson", LimitError, max_sites=2)
    text = collection(*(feature([1, 2], properties={f"k{i}": i}) for i in range(10001)))
    assert "has 10001 different properties on 10001 points" in error_of(text, "a.geojson", LimitError)
    assert len(read(text, "a.geojson", properties=False)) == 10001


# ---- Points from Triangle's .node files -----------------------------------------------------------------
@pytest.mark.parametrize("base", [0, 1])
def test_node(base):
    text = f"# box\n3 2 1 1 # header\n{base} 0 0 1.50 1\n{base + 1} 4 0.5 2 0\n\n{base + 2} -4 1e1 x 7 # last\n"
    points = read(text, "box.node")
    assert points.xy.tolist() == [[0, 0], [4, 0.5], [-4, 10]]
    assert points.labels is None
    assert points.properties == {"attribute_1": ["1.50", "2", "x"], "boundary_marker": ["1", "0", "7"]}
    assert read(text, "box.node", properties=False).properties == {}


# ---- Points from NPY files ------------------------------------------------------------------------------
@pytest.mark.parametrize("dtype", few(["f8", ">i8", ">f8", "f4", "i2", "u1"], 2))
@pytest.mark.parametrize("order", ["C", "F"])
def test_npy(dtype, order):
    array = np.array([[1, 2, 7], [3, 4, 9]], dtype=dtype, order=order)
    points = read(npy(array), "a.npy")
    assert points.xy.tolist() == [[1, 2], [3, 4]]
    assert points.labels.tolist() == [7, 9]
    assert read(npy(array[:, :2]), "a.npy").labels is None
    assert len(read(npy(array[:0]), "a.npy")) == 0


def header(text, version=b"\x01\x00", size=None):
    padded = text.encode() + b"\n"
    return b"\x93NUMPY" + version + (len(padded) if size is None else size).to_bytes(2, "little") + padded


SHAPE = "{{'descr': '<f8', 'fortran_order': False, 'shape': {}}}"


def test_the_limit_of_npy():
    data = header(SHAPE.format("(100000000000, 2)"))
    assert "holds 100000000000 points, more than the limit of 4294967295" in error_of(data, "a.npy", LimitError)
    error = error_of(npy(np.zeros((6, 2))), "a.npy", LimitError, max_sites=5)
    assert "more than the limit of 5: raise max_sites" in error


# ---- Points from well-known text ------------------------------------------------------------------------
def test_wkt():
    text = "POINT (1 2)\n# comment\n\nSRID=4326;MULTIPOINT ((3 4), (5 6.5))\n"
    text += "GEOMETRYCOLLECTION (POINT (7 8), POINT EMPTY)\n"
    points = read(text, "a.wkt")
    assert points.xy.tolist() == [[1, 2], [3, 4], [5, 6.5], [7, 8]]
    assert points.y_axis == "up"
    assert points.crs == {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::4326"}}
    assert read("POINT (1 2)\nSRID=0;POINT (2 3)", "a.wkt").crs is None
    (note,) = notes_of("SRID=4258;POINT (1 2)", "a.wkt")
    assert note.startswith("a.wkt: ")
    assert 'to_crs="EPSG:32631"' in note
    assert notes_of("SRID=2056;POINT (1 2)", "a.wkt") == []
    assert "line 3: the geometry is in EPSG:2" in error_of("SRID=1;POINT (1 2)\n\nSRID=2;POINT (1 2)", "a.wkt")
    assert points.properties == {"part": [1, 1, 2, 1]}
    assert read("POINT (1 2)", STANDARD_INPUT).properties == {}
    assert rows("# (see below\nPOINT (1 2)", "a.wkt") == [[1, 2]]
    assert rows("MULTIPOINT\n (\n 1 2,\n 3 4)\nPOINT(5 6)", "a.wkt") == [[1, 2], [3, 4], [5, 6]]
    assert notes_of("POINT Z (1 2 3)", "a.wkt") == ["a.wkt: only x and y are used; z is ignored"]
