"""Files of points and of polygons that are damaged, or hold something else: each is named, and the place in it."""

import json
import math

import numpy as np
import pytest

from support.readers import point_reading, polygon_reading
from support.readers.point_reading import npy
from support.refusals import refused
from vorotool.errors import InputError

SHELL = [[0, 0], [9, 0], [0, 9], [0, 0]]


def feature(coordinates, kind="Point", **members):
    return {"type": "Feature", "geometry": {"type": kind, "coordinates": coordinates}, "properties": None, **members}


def collection(*features, **members):
    return json.dumps({"type": "FeatureCollection", "features": features, **members})


def header(text, version=b"\x01\x00", size=None):
    padded = text.encode() + b"\n"
    return b"\x93NUMPY" + version + (len(padded) if size is None else size).to_bytes(2, "little") + padded


SHAPE = "{{'descr': '<f8', 'fortran_order': False, 'shape': {}}}"

POINTS = {
    "a.json": [
        ("[[1, 2],\n [3, ]]", "line 2"),
        ("[[1, 2], [3, NaN]]", "line 1"),
        ('[[1, 2], ["3", 4]]', 'point 2: ["3", 4]'),
        ("[[1, 2], [true, 4]]", "point 2"),
        ("[[1, 2], [null, 4]]", "point 2"),
        ("[[1, 2], [3]]", "point 2: [3]"),
        ("[1, 2]", "point 1"),
        ("[[1, 2, 3]]", "point 1: [1, 2, 3]"),
        ('"seeds"', "'seeds'"),
        ("[" * 1000, "line 1"),
        ('{"points": []}', ""),
    ],
    "a.geojson": [
        (
            collection(feature([1, 2]), feature([SHELL], "Polygon")),
            "feature 2: 'Polygon' is not a point; replace it by",
        ),
        (collection(feature([1, 2]), feature([1, "2"])), 'feature 2: [1, "2"]'),
        (collection(feature(None)), "feature 1"),
        (collection(5), "feature 1"),
        (collection(feature([1, 2], properties=[])), "feature 1"),
        (collection({"type": "Feature", "geometry": "x"}), "feature 1"),
        ('{"type": "FeatureCollection"}', "FeatureCollection"),
        ('{"type": "Circle"}', "'Circle'"),
        ("[]", ""),
        ('{"a":' * 1000, "line 1"),
        ("", ""),
    ],
    "a.node": [
        ("", ".node"),
        ("1.5 2\n", "line 1: '1.5 2'"),
        ("#\n1 3 0 0\n1 0 0 0\n", "line 2"),
        ("2 2 0 0\n1 0 0\n", "line 1"),
        ("1 2 0 0\n1 0 0\n2 0 0\n", "line 1"),
        ("2 2 0 0\n1 0 0\n#\n3 0 0\n", "line 4: vertex 3"),
        ("1 2 0 0\n1 0 b\n", "line 2: 'b' in column 3"),
        ("1 2 1 0\n1 0 0\n", "line 2: 3 fields, but each vertex after the header (line"),
        ("1 2 0 2\n1 0 0 0 0\n", "line 1: 0 attributes and 2 boundary markers per vertex;"),
    ],
    "a.npy": [
        (npy(np.array([[1, "a"]], dtype=object), allow_pickle=True), "holds pickled objects, which are never loaded"),
        (npy(np.array([["1", "2"]])), "holds <U1, not numbers"),
        (npy(np.array([[1j, 2]])), "holds complex128, not numbers"),
        (npy(np.ones((3, 2), bool)), "holds truth values, not numbers; save an (n, 2)"),
        (npy(np.zeros((3, 4))), "(3, 4)"),
        (npy(np.zeros(4)), "holds an array of shape (4,)"),
        (npy(np.zeros((1, 2), dtype=[("x", "f8")])), "holds [('x', '<f8')], not numbers"),
        (npy(np.zeros((5, 2)))[:-1], "(5, 2)"),
        (b"\x93NUMPY\x01\x00", "version 1"),
        (b"", "version 1"),
        (header("{"), "version 1"),
        (header("(" * 5000), "version 1"),
        (header("{'descr': '<f8'}"), "version 1"),
        (header(SHAPE.format("(2, 2)"), size=65535), "version 1"),
        (header(SHAPE.format("(-1, 2)")), "(-1, 2)"),
        (header(SHAPE.format("(1, 2)"), b"\x03\x00"), "version 1"),
        (npy(np.array([[1, 2], [3, math.nan]])), "row 2"),
        (npy(np.array([[1.0, 2, 1], [3, 4, 0.5]])), "row 2"),
        (npy(np.array([[1, 2, -1]])), "row 1"),
        (npy(np.array([[1.0, 2, math.nan]])), "row 1"),
    ],
    "a.wkt": [
        ("POINT (1 2)\n\nPOINT (1 b)\n", "line 3: 'POINT (1 b)'"),
        ("1,2\n", "line 1: '1,2'"),
        ("POINT (1 2)\nLINESTRING (0 0, 1 1)\n", "line 2: a LineString is not a point; replace it by its"),
        ("GEOMETRYCOLLECTION (POLYGON EMPTY)", "line 1"),
        ("GEOMETRYCOLLECTION (" * 5000, "line 1"),
        ("POINT (1 2)\nPOINT (1 inf)", "line 2: 'POINT (1 inf)'"),
        ("POINT (nan 1)", "line 1: 'POINT (nan 1)'"),
        ("POINT (1 1e999)", "line 1: 'POINT (1 1e999)'"),
    ],
}

POLYGONS = {
    "a.geojson": [
        (collection(feature([SHELL], "Polygon"), feature([1, 2], "Point")), "feature 2: 'Point'"),
        (collection(feature([], "Circle")), "feature 1: 'Circle'"),
        (collection(feature([], None)), "feature 1: None"),
        (collection(feature(None, "Polygon")), "feature 1"),
        (collection(feature([5], "Polygon")), "feature 1"),
        (collection(feature([[1, 2]], "Polygon")), "feature 1, vertex 1"),
        (collection(feature([5], "MultiPolygon")), "feature 1"),
        (collection(feature([SHELL], "MultiPolygon")), "feature 1, vertex 1"),
        (collection(feature([5], "MultiLineString")), "feature 1"),
        (
            collection(feature(SHELL, "LineString"), feature([[SHELL], [SHELL, [[1], [1]]]], "MultiPolygon")),
            "feature 2",
        ),
        (collection({"type": "Feature", "geometry": {"type": "GeometryCollection", "geometries": [5]}}), "feature 1"),
        (collection(5), "feature 1"),
        (collection(feature([SHELL], "Polygon", properties=[])), "feature 1"),
        ("[]", ""),
        ('{"a":' * 1000, "line 1"),
    ],
    "a.json": [
        ("[[0, 0], [1, ]]", "line 1"),
        ("5", "5 is not a polygon; write [[x, y], …], or {"),
        ("{}", "the object has no list of polygons; write {"),
        ("[[0, 0], [1, 0], [1]]", "polygon 1, vertex 3: [1]"),
        ("[[0, 0], [1, true]]", "polygon 1, vertex 2: [1"),
        ("[[0, 0], [1, 0, 7]]", "polygon 1, vertex 2: [1, 0, 7]"),
        ("[[[0, 0]], 5]", "polygon 2"),
        ('{"polygons": [{"shell": [[0, 0]], "line": []}]}', "polygon 1"),
        ('{"polygons": [{"holes": []}]}', "polygon 1"),
        ('{"polygons": [{"shell": [[0, 0]], "holes": [3]}]}', "polygon 1"),
        ('{"polygons": [{"shell": [[0, 0]], "holes": [[], [[1, 1], ["a", 2]]]}]}', "hole 1, vertex 2"),
        ('{"polygons": [{"shell": [[0, 0]], "properties": 3}]}', "polygon 1"),
        ('{"polygons": [{"shell": [[0, 0]], "part": 2}]}', "polygon 1"),
        ("[" * 1000, "line 1"),
    ],
    "a.poly": [
        ("", ": the file ends before a header; write <vertices> 2"),
        ("x 2\n", "line 1: 'x 2'"),
        ("0 2 0 0\n", ": the vertices are in a separate .node file; copy its lines"),
        ("1 3\n1 0 0 0\n", "line 1"),
        ("2 2\n1 0 0\n", "line 1"),
        ("1 2\n1 0\n", "line 2"),
        ("1 2\n1 0 a\n", "line 2: '1 0 a'"),
        ("1 2\n1 0 inf\n", "line 2: '1 0 inf'"),
        ("2 2\n1 0 0\n3 0 0\n", "line 3: vertex 3"),
        ("1 2\n1 0 0\n", ": the file ends before a header; write <segments> <0 or 1"),
        ("1 2\n1 0 0\n1\n1 1 2\n", "vertex 2"),
        ("1 2\n1 0 0\n1\n1 1 0.5\n", "line 4"),
        ("3 2\n1 0 0\n2 1 0\n3 0 1\n3\n1 1 2\n2 2 3\n3 3 1\n1\n1 5 5\n", "hole 1, (5, 5)"),
        ("3 2\n1 0 0\n2 4 0\n3 0 4\n3\n1 1 2\n2 2 3\n3 3 1\n1\n1 1 1\n", "hole 1, (1, 1)"),
    ],
    "a.wkt": [
        ("LINESTRING (0 0, 1 1)\n\nPOLYGON ((0 0, 1 0, 0 1))", "line 3: 'POLYGON ((0 0, 1 0, 0 1))' is not WKT; write"),
        ("LINESTRING (0 0, 1 1)\nPOINT (1 2)", "line 2"),
        ("GEOMETRYCOLLECTION (MULTIPOINT (1 2))", "line 1"),
        ("LINESTRING (0 0, 1 1)\nLINESTRING (0 0, 1 inf)", "'LINESTRING (0 0, 1 inf)'"),
        ("POLYGON ((0 0, nan 0, 1 1, 0 0))", "line 1: 'POLYGON ((0 0, nan 0, 1 1, 0 0))': vertex 2"),
        ("LINESTRING (0 0, 1 1e999)", "line 1: 'LINESTRING (0 0, 1 1e999)': vertex 2"),
        ("GEOMETRYCOLLECTION (" * 5000, "line 1"),
    ],
}


@pytest.mark.parametrize(
    ("read", "name", "data", "words"),
    [
        (module.read, name, *row)
        for module, table in ((point_reading, POINTS), (polygon_reading, POLYGONS))
        for name, rows in table.items()
        for row in rows
    ],
)
def test_what_is_wrong_is_told_with_its_place(read, name, data, words):
    options = {"input_format": "json"} if name == "a.json" else {}
    message = refused(InputError, "", read, data, name, **options)
    assert message.startswith(name)
    assert words in message
    assert ";" in message or name != "a.npy"  # what to do
