"""Points from well-known text."""

import pytest

from support.readers.point_reading import error_of, notes_of, read, rows
from vorotool.formats.io.sources import STANDARD_INPUT


def test_wkt():
    text = (
        "POINT (1 2)\n# comment\n\nSRID=4326;MULTIPOINT ((3 4), (5 6.5))\n"
        "GEOMETRYCOLLECTION (POINT (7 8), POINT EMPTY)\n"
    )
    points = read(text, "a.wkt")
    assert points.xy.tolist() == [[1, 2], [3, 4], [5, 6.5], [7, 8]]
    assert points.y_axis == "up"
    assert points.crs == {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::4326"}}
    assert read("POINT (1 2)\nSRID=0;POINT (2 3)", "a.wkt").crs is None
    degrees = (
        'a.wkt: longitude and latitude are treated as planar, lengths are in degrees; to_crs="EPSG:32631" works in '
        "meters (UTM)"
    )
    assert notes_of("SRID=4258;POINT (1 2)", "a.wkt") == [degrees]
    assert notes_of("SRID=2056;POINT (1 2)", "a.wkt") == []
    assert "line 3: the geometry is in EPSG:2" in error_of("SRID=1;POINT (1 2)\n\nSRID=2;POINT (1 2)", "a.wkt")
    assert points.properties == {"part": [1, 1, 2, 1]}
    assert read("POINT (1 2)", STANDARD_INPUT).properties == {}
    assert rows("# (see below\nPOINT (1 2)", "a.wkt") == [[1, 2]]
    assert rows("MULTIPOINT\n (\n 1 2,\n 3 4)\nPOINT(5 6)", "a.wkt") == [[1, 2], [3, 4], [5, 6]]
    assert notes_of("POINT Z (1 2 3)", "a.wkt") == ["a.wkt: only x and y are used; z is ignored"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("POINT (1 2)\n\nPOINT (1 b)\n", "a.wkt, line 3: 'POINT (1 b)'"),
        ("1,2\n", "a.wkt, line 1: '1,2'"),
        (
            "POINT (1 2)\nLINESTRING (0 0, 1 1)\n",
            "a.wkt, line 2: a LineString is not a point; replace it by its centroid or its vertices "
            "(voronoi and skeleton_exact take polygons and lines",
        ),
        ("GEOMETRYCOLLECTION (POLYGON EMPTY)", "a.wkt, line 1"),
        ("GEOMETRYCOLLECTION (" * 5000, "a.wkt, line 1"),
        ("POINT (1 2)\nPOINT (1 inf)", "a.wkt, line 2: 'POINT (1 inf)'"),
        ("POINT (nan 1)", "a.wkt, line 1: 'POINT (nan 1)'"),
        ("POINT (1 1e999)", "a.wkt, line 1: 'POINT (1 1e999)'"),
    ],
)
def test_bad_wkt(text, message):
    error = error_of(text, "a.wkt")
    assert error.startswith("a.wkt")
    assert message in error
