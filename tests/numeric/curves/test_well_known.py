"""Kinds of geometry that shapely does not know, in text, in binary, and in collections of shapely."""

import struct

import numpy as np
import pytest
import shapely

import vorotool
from vorotool.errors import InputError, VorotoolWarning
from vorotool.numeric.curves.well_known import flattened_arcs, geometry_of_binary, geometry_of_texts, without_curves

RING = "CIRCULARSTRING (0 0, 4 0, 4 4, 0 4, 0 0)"
SQUARE = "((0 0, 1 0, 1 1, 0 1, 0 0))"
TEXTS = {
    "CIRCULARSTRING (0 0, 1 1, 2 0)": "LineString",
    "CircularString Z (0 0 1, 1 1 2, 2 0 3)": "LineString",
    "CIRCULARSTRINGZM(0 0 1 9, 1 1 2 9, 2 0 3 9)": "LineString",
    "COMPOUNDCURVE ((0 0, 1 0), CIRCULARSTRING (1 0, 2 1, 3 0), (3 0, 4 4))": "LineString",
    f"CURVEPOLYGON ({RING}, (1 1, 3 3, 3 1, 1 1))": "Polygon",
    "CURVEPOLYGON M (COMPOUNDCURVE M ((0 0 1, 1 0 1), CIRCULARSTRING M (1 0 1, 1 1 1, 0 0 1)))": "Polygon",
    f"MULTICURVE ((0 0, 1 1), {RING})": "MultiLineString",
    f"MULTISURFACE ({SQUARE}, CURVEPOLYGON ({RING}))": "MultiPolygon",
    f"POLYHEDRALSURFACE ({SQUARE}, ((1 0, 2 0, 1 1, 1 0)))": "MultiPolygon",
    "TIN (((0 0, 1 0, 1 1, 0 0)), ((0 0, 1 1, 0 1, 0 0)))": "MultiPolygon",
    "TIN Z (((0 0 1, 1 0 1, 1 1 1, 0 0 1)))": "MultiPolygon",
    "TRIANGLE ((0 0, 1 0, 1 1, 0 0))": "Polygon",
    "CURVEPOLYGON EMPTY": "Polygon",
    "COMPOUNDCURVE EMPTY": "LineString",
    f"GEOMETRYCOLLECTION (POINT (1 2), MULTIPOINT (1 2, 3 4), MULTIPOINT (EMPTY, (5 6)), CURVEPOLYGON ({RING}))": (
        "GeometryCollection"
    ),
}
BAD = [
    *("CIRCULARSTRING (0 0, 1 1)", "CIRCULARSTRING (0 0, 1 1, 2 0, 3 3)", "CIRCULARSTRING (0 0, 1 1, 2 0", "TIN"),
    *(
        "CURVEPOLYGON (1 2)",
        "MULTISURFACE (POINT (1 2))",
        "CURVEPOLYGON ((0 0, 1 0, 1 1))",
        "TRIANGLE ((0 0, 1 1, 0 0))",
    ),
    *("COMPOUNDCURVE ((0 0, 1 0), (2 0, 3 0))", "CIRCULARSTRING (0 0, 1_0 1, 2 0)", "CIRCULARSTRING Z (0 0, 1 1, 2 0)"),
    *(
        "CURVEPOLYGON (CURVEPOLYGON EMPTY, (0 0, 1 0, 1 1, 0 0))x",
        "NURBSCURVE (0 0, 1 1)",
        "GEOMETRYCOLLECTION ((1 2), TIN",
    ),
]


@pytest.mark.parametrize(("text", "kind"), TEXTS.items())
def test_every_kind_in_text(text, kind):
    (made,), curves = geometry_of_texts([text])
    assert made.geom_type == kind
    assert curves == text.upper().count("CIRCULARSTRING")
    assert shapely.has_z(made) == ("Z" in text.upper().replace("(", " ").split()[0] or " Z" in text)
    assert made.is_empty == ("EMPTY" in text and "MULTIPOINT" not in text)


@pytest.mark.parametrize("text", BAD)
def test_what_is_none(text, tmp_path):
    assert geometry_of_texts([text]).geometry.tolist() == [None]
    with pytest.raises(InputError, match="well-known text"):
        vorotool.skeleton_exact(text)
    (tmp_path / "a.wkt").write_text(text)
    with pytest.raises(InputError, match=r"a\.wkt"):
        vorotool.read(tmp_path / "a.wkt", geometry="polygons")


def arcs(count=200):
    """Arcs of all sizes and extents, by their circles, and where they begin, pass and end."""
    random = np.random.default_rng(5)
    for _ in range(count):
        center, radius = random.normal(size=2) * 10.0 ** random.uniform(-3, 6), 10.0 ** random.uniform(-3, 6)
        begin, extent = random.uniform(0, 7), random.choice([-1, 1]) * random.uniform(0.01, 6.2)
        angles = begin + extent * np.array([0, random.uniform(0.1, 0.9), 1])
        yield center, radius, center + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def test_arcs_stay_near_their_circles():
    for center, radius, points in arcs():
        made = flattened_arcs(points)
        middle = (made[1:] + made[:-1]) / 2
        rounding = 1e-9 * (radius + np.abs(center).max())
        assert all(point in made.tolist() for point in points.tolist())
        assert np.abs(np.hypot(*(made - center).T) - radius).max() < rounding + radius / 1e6
        diagonal = np.hypot(*np.ptp(made, axis=0)) * 1.001 + rounding
        assert (radius - np.hypot(*(middle - center).T)).max() <= diagonal / 2000 + rounding
        # it passes the points in order: its length is that of the arc
        turn = np.unwrap(np.arctan2(*(points - center).T[::-1]))
        length = np.hypot(*np.diff(made, axis=0).T).sum()
        assert length <= radius * 6.2833 + rounding
        assert len(made) < 300, turn


def test_whole_circles_and_straight_arcs():
    circle = flattened_arcs(np.array([[1.0, 0, 0], [-1, 0, 5], [1, 0, 10]]))
    assert shapely.Polygon(circle[:, :2]).area == pytest.approx(np.pi, rel=1e-2)
    assert shapely.LinearRing(circle[:, :2]).is_ccw
    assert (np.diff(circle[:, 2]) > 0).all()
    straight = [[0.0, 0], [1, 1], [3, 3], [3, 3], [4, 4], [4, 4], [9, 9], [1e200, 0], [0, 1e200]]
    assert flattened_arcs(np.array(straight)).tolist() == straight
    assert np.isnan(flattened_arcs(np.array([[0.0, 0], [np.nan, 1], [2, 0]]))[1, 0])
    assert flattened_arcs(np.array([[0.0, 0], [1, 1], [2, 0]]), flatten=10).tolist() == [[0, 0], [1, 1], [2, 0]]


def nested(kind, *parts, order="<", number=None):
    head = struct.pack(order + "BI", order == "<", kind | (1 << 29 if number else 0))
    return (
        head
        + (struct.pack(order + "I", number) if number else b"")
        + struct.pack(order + "I", len(parts))
        + b"".join(parts)
    )


def string(kind, points, order="<"):
    return struct.pack(order + "BII", order == "<", kind, len(points)) + np.array(points, order + "f8").tobytes()


def test_binary_of_both_orders_with_all_that_it_may_carry():
    arc = [[0, 0], [1, 1], [2, 0]]
    for order in "<>":
        compound = nested(9, string(8, arc, order), string(2, [[2, 0], [0, 0]], order), order=order)
        polygon = nested(10, compound, order=order, number=3057)
        for item in (polygon, polygon.hex(), polygon.hex().upper()):
            (made,), curves = geometry_of_binary([item])
            assert (made.geom_type, curves, shapely.get_srid(made)) == ("Polygon", 1, 3057)
            assert made.area == pytest.approx(np.pi / 2, rel=1e-2)
    for kind in (1008, 8 | 1 << 31):
        (made,), _ = geometry_of_binary([string(kind, [[*point, 7] for point in arc])])
        assert shapely.get_coordinates(made, include_z=True)[:, 2].tolist() == [7] * len(made.coords)
    (made,), _ = geometry_of_binary([string(2008, [[*point, 7] for point in arc])])
    assert not shapely.has_z(made)
    collection = nested(7, shapely.to_wkb(shapely.Point(5, 6)), nested(11, string(8, arc), string(2, arc[:2])))
    (made,), curves = geometry_of_binary([collection])
    assert ([part.geom_type for part in made.geoms], curves) == (["Point", "MultiLineString"], 1)
    for cut in range(len(collection)):
        assert geometry_of_binary([collection[:cut]]).geometry.tolist() == [None]
    assert geometry_of_binary([b"\1" + struct.pack("<II", 8, 2**31) + bytes(50), None]).geometry.tolist() == [
        None,
        None,
    ]


@pytest.mark.parametrize("kind", [4, 5, 6, 7, 9, 10, 12])
@pytest.mark.parametrize("count", [1, 2])
def test_binary_that_is_nested_too_deep(kind, count):
    """GEOS overflows the stack at some thousand levels."""
    point = shapely.to_wkb(shapely.Point(5, 6))
    deep = (struct.pack("<BII", 1, kind, count) + (count - 1) * point) * 200_000 + point
    assert geometry_of_binary([deep, point]).geometry.tolist() == [None, shapely.Point(5, 6)]


def test_collections_of_shapely():
    plain = shapely.Point(1, 2)
    held = shapely.from_wkt(f"GEOMETRYCOLLECTION (POINT (1 2), {RING})")
    made, curves = without_curves(np.array([plain, held, None], dtype=object))
    assert made[0] is plain
    assert (made[1].geoms[1].geom_type, made[2], curves) == ("LineString", None, 1)
    with pytest.warns(VorotoolWarning, match="3 curves") as said:
        vorotool.voronoi([held, f"CURVEPOLYGON ({RING})", shapely.from_wkt(f"GEOMETRYCOLLECTION ({RING})")])
    assert len(said) == 1


def test_curves_in_files_are_counted_once(tmp_path):
    binary = nested(10, string(8, [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]))
    files = {
        "a.wkt": f"# two\nCURVEPOLYGON ({RING})\nSRID=0;MULTISURFACE (CURVEPOLYGON ({RING}))\n".encode(),
        "a.wkb": binary.hex().encode() + b"\n" + binary.hex().encode(),
        "a.csv": f'id,wkt\n1,"CURVEPOLYGON ({RING})"\n2,"CURVEPOLYGON ({RING})"\n'.encode(),
        "b.csv": b"id,wkb\n1," + binary.hex().encode() + b"\n2," + binary.hex().encode(),
    }
    sizes = set()
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
        notes = []
        shapes = vorotool.read(tmp_path / name, note=notes.append)
        assert [note for note in notes if "curve" in note] == notes
        assert len(notes) == 1
        assert notes[0].startswith(f"{tmp_path / name}: 2 curves")
        sizes.add(len(shapes.xy))
        coarse = vorotool.read(tmp_path / name, flatten=1e-1)
        assert len(coarse.xy) < len(shapes.xy)
        assert vorotool.skeleton_exact(shapes).polygons.feature.tolist() == [0, 1]
    assert len(sizes) == 1
    (tmp_path / "unnamed").write_bytes(files["a.wkt"][6:])
    assert len(vorotool.read(tmp_path / "unnamed")) == 2


def test_a_curve_where_none_should_be_is_damage():
    """A polygon inside a multipolygon that says that it is a circular string."""
    data = bytearray(shapely.to_wkb(shapely.MultiPolygon([shapely.box(0, 0, 1, 1)])))
    data[10:14] = (8).to_bytes(4, "little")
    found = geometry_of_binary([bytes(data), shapely.to_wkb(shapely.Point(1, 2))]).geometry
    assert found[0] is None or found[0].is_empty
    assert found[1] == shapely.Point(1, 2)
