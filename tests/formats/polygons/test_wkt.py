"""Polygons and lines in well-known text."""

from dataclasses import replace

import pytest

from support.readers.polygon_reading import assert_same, error_of, notes_of, read, rings, written
from vorotool.convert.polygons import as_polygons

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


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "LINESTRING (0 0, 1 1)\n\nPOLYGON ((0 0, 1 0, 0 1))",
            "a.wkt, line 3: 'POLYGON ((0 0, 1 0, 0 1))' is not WKT; write for example POINT (3 4) or POLYGON ((0 0, "
            "4 0, 0 3, 0 0)), each ring closed",
        ),
        ("LINESTRING (0 0, 1 1)\nPOINT (1 2)", "a.wkt, line 2"),
        ("GEOMETRYCOLLECTION (MULTIPOINT (1 2))", "a.wkt, line 1"),
        ("LINESTRING (0 0, 1 1)\nLINESTRING (0 0, 1 inf)", "'LINESTRING (0 0, 1 inf)'"),
        ("POLYGON ((0 0, nan 0, 1 1, 0 0))", "a.wkt, line 1: 'POLYGON ((0 0, nan 0, 1 1, 0 0))': vertex 2"),
        ("LINESTRING (0 0, 1 1e999)", "a.wkt, line 1: 'LINESTRING (0 0, 1 1e999)': vertex 2"),
        ("GEOMETRYCOLLECTION (" * 5000, "a.wkt, line 1"),
    ],
)
def test_bad_wkt(text, message):
    error = error_of(text, "a.wkt")
    assert error.startswith("a.wkt")
    assert message in error
