"""Drawings in DXF, against shapely, what ezdxf flattens, and arcs by their angles."""

import io
import itertools
import math

import ezdxf
import numpy as np
import pytest
import shapely

import vorotool
from support.few import few
from support.processes.ended import ended_python
from support.refusals import refused
from vorotool.errors import InputError, LimitError
from vorotool.formats.drawing.curves import Curve, Line
from vorotool.formats.drawing.dxf_reader import read_dxf
from vorotool.formats.drawing.polygons import joined
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.types.polygons.shapely_geometry import to_shapely


@pytest.fixture
def drawing():
    return ezdxf.new("R2010")


def data_of(drawing):
    out = io.StringIO()
    drawing.write(out)
    return out.getvalue().encode(drawing.output_encoding)


def read(drawing, **options):
    """Read a drawing or its bytes; gives it, and what was noted."""
    notes = []
    data = drawing if isinstance(drawing, bytes) else data_of(drawing)
    return read_dxf(Source("a.dxf", data), ReadOptions(note=notes.append, **options)), notes


# ---- entities ------------------------------------------------------------------------------------
def test_areas(drawing):
    space = drawing.modelspace()
    space.add_circle((0, 0), 2)
    space.add_ellipse((20, 0), (3, 4), 0.5)
    space.add_lwpolyline([(40, 0, 0, 0, 1), (44, 0, 0, 0, 1)], close=True)
    space.add_lwpolyline([(60, 0, 0, 0, math.tan(math.pi / 8)), (62, 0, 0, 0, 0), (61, 5, 0, 0, 0)], close=True)
    space.add_polyline2d([(80, 0, -1), (84, 0, 0)], format="xyb", close=True)
    space.add_solid([(100, 0), (103, 0), (100, 4), (103, 4)])
    space.add_lwpolyline([(120, 0), (124, 0), (124, 3), (120, 0)])
    shapes, notes = read(drawing, flatten=1e-6)
    segment = math.pi / 2 - 1  # between a quarter of the circle with the radius sqrt(2) and its chord
    wanted = [4 * math.pi, 12.5 * math.pi, 4 * math.pi, 5 + segment, 2 * math.pi, 12, 6]
    assert shapely.area(to_shapely(shapes)) == pytest.approx(wanted, rel=1e-5)
    assert shapes.y_axis == "up"
    assert not notes
    assert not shapes.is_line.any()


@pytest.mark.parametrize("bulge", [0.01, 0.3, 1, 1.7, 50, -0.2, -1, -3])
def test_bulges_as_ezdxf_has_them(drawing, bulge):
    start, end = (1.0, 2.0), (4.0, -1.0)
    drawing.modelspace().add_lwpolyline([(*start, 0, 0, bulge), (*end, 0, 0, 0)])
    line = read(drawing, flatten=1e-4)[0].xy
    center, first, last, radius = ezdxf.math.bulge_to_arc(start, end, bulge)
    assert np.hypot(*(line - center).T) == pytest.approx(np.full(len(line), radius))
    assert line[0].tolist() == [*start]
    assert line[-1].tolist() == [*end]
    angles = np.unwrap(np.arctan2(*(line - center).T[::-1]))
    assert abs(angles[-1] - angles[0]) == pytest.approx((last - first) % (2 * math.pi))
    assert (np.diff(angles) * bulge > 0).all()
    middles = (line[1:] + line[:-1]) / 2
    assert (radius - np.hypot(*(middles - center).T) <= 1e-4).all()


@pytest.mark.parametrize("angles", [(0, 90), (90, 0), (-30, 200), (350, 10), (10, 370), (0, 180), (180, 0), (45, 44)])
def test_arcs(drawing, angles):
    drawing.modelspace().add_arc((3, 4), 2, *angles)
    shapes, _ = read(drawing, flatten=1e-4)
    way = (angles[1] - angles[0]) % 360 or 360
    assert bool(shapes.is_line[0]) == (way != 360)
    line = to_shapely(shapes)[0]
    length = (line if way != 360 else line.exterior).length
    assert length == pytest.approx(math.radians(way) * 2, rel=1e-3)
    if way != 360:
        ends = [[3 + 2 * math.cos(math.radians(angle)), 4 + 2 * math.sin(math.radians(angle))] for angle in angles]
        assert shapes.xy[[0, -1]] == pytest.approx(np.array(ends))


@pytest.mark.parametrize("params", [(0, 1), (1, 0), (3, 6), (5, 2)])
@pytest.mark.parametrize("extrusion", [(0, 0, 1), (0, 0, -1)])
def test_ellipses_as_ezdxf_has_them(drawing, params, extrusion):
    attributes = {"extrusion": extrusion}
    ellipse = drawing.modelspace().add_ellipse((1, 2), (3, 1), 0.4, *params, dxfattribs=attributes)
    theirs = shapely.LineString([(x, y) for x, y, _ in ellipse.vertices(ellipse.params(2001))])
    ours = shapely.LineString(read(drawing, flatten=1e-4)[0].xy)
    assert shapely.hausdorff_distance(theirs, ours) < 2e-4


@pytest.mark.parametrize("kind", ["control", "rational", "fit", "closed"])
@pytest.mark.parametrize("degree", few([2, 3, 5], 1))
def test_splines_as_ezdxf_has_them(drawing, kind, degree):
    space = drawing.modelspace()
    points = [(0, 0), (3, 9), (8, -4), (12, 7), (20, 1), (18, -9), (5, -12)]
    if kind == "control":
        spline = space.add_open_spline(points, degree)
    elif kind == "rational":
        spline = space.add_rational_spline(points, [1, 2, 0.5, 3, 1, 1, 2], degree)
    elif kind == "closed":
        spline = space.add_spline()
        spline.set_closed([(*point, 0) for point in points], degree)
    else:
        spline = space.add_spline(points, degree)
    tool = spline.construction_tool()
    curve = shapely.LineString([(x, y) for x, y, _ in tool.approximate(5000)])
    shapes, _ = read(drawing, flatten=0.01)
    line = to_shapely(shapes)[0]
    assert shapely.hausdorff_distance(line if shapes.is_line[0] else line.exterior, curve) < 0.011
    assert len(shapes.xy) < 400


def test_what_is_seen_from_below_is_mirrored(drawing):
    space = drawing.modelspace()
    below = {"extrusion": (0, 0, -1)}
    arc = space.add_arc((3, 4), 2, 10, 60, dxfattribs=below)
    space.add_lwpolyline([(10, 0, 0, 0, 0.5), (12, 3, 0, 0, 0)], dxfattribs=below)
    shapes, _ = read(drawing)
    ends = sorted([[end.x, end.y] for end in (arc.start_point, arc.end_point)])
    assert sorted(shapes.ring(0)[[0, -1]].tolist()) == [pytest.approx(end) for end in ends]
    assert shapes.ring(1)[[0, -1]].tolist() == [[-10, 0], [-12, 3]]


# ---- joining, nesting ------------------------------------------------------------------------------
def test_lines_and_arcs_are_joined(drawing):
    space = drawing.modelspace()
    space.add_line((0, 0), (10, 0))
    space.add_line((0, 0), (0, 10))
    space.add_arc((10, 5), 5, -90, 90)
    space.add_line((10, 10.000001), (0, 10))
    space.add_line((50, 0), (60, 0))
    shapes, _ = read(drawing, flatten=1e-4)
    assert shapes.is_line.tolist() == [False, True]
    assert to_shapely(shapes)[0].area == pytest.approx(100 + 12.5 * math.pi, rel=1e-4)
    assert read(drawing, join_tolerance=1e-9)[0].is_line.tolist() == [True, True]
    assert len(np.unique(shapes.ring(0), axis=0)) == len(shapes.ring(0))


def test_outlines_on_several_layers_stay_open_with_a_note(drawing):
    space, corners = drawing.modelspace(), [(0, 0), (9, 0), (9, 9), (0, 9), (0, 0)]
    space.add_circle((30, 0), 2, dxfattribs={"layer": "a"})
    for layer, (a, b) in zip("aabb", itertools.pairwise(corners), strict=True):
        space.add_line(a, b, dxfattribs={"layer": layer})
    space.add_line((20, 0), (25, 0), dxfattribs={"layer": "b"})
    shapes, notes = read(drawing)
    assert shapes.is_line.sum() == 3
    assert [each for each in notes if "several layers" in each] == [
        "a.dxf: 1 outline whose lines are on several layers stays open: only lines of one layer are joined"
    ]


def with_gaps(drawing, units, *gaps, size=100.0):
    """Squares in a row, each with a gap at one corner; the first with a hole."""
    drawing.header["$INSUNITS"] = units
    space = drawing.modelspace()
    space.add_circle((size / 2, size / 2), size / 5, dxfattribs={"layer": "cut"})
    for k, gap in enumerate(gaps):
        x = 2 * size * k
        places = [(x, 0), (x + size, 0), (x + size, size), (x, size), (x, gap)]
        for a, b in itertools.pairwise(places):
            space.add_line(a, b, dxfattribs={"layer": "cut"})


@pytest.mark.parametrize(("units", "mm", "name"), [(4, 1, "mm"), (6, 1000, "m"), (1, 25.4, "in"), (5, 10, "cm")])
def test_ends_nearer_than_some_micrometres_are_joined(drawing, units, mm, name):
    with_gaps(drawing, units, 0.0049 / mm, 0.0001 / mm, 0, 0.0051 / mm, 0.049 / mm, 0.051 / mm, size=100 / mm)
    shapes, notes = read(drawing, flatten=0.001 / mm)
    assert shapes.is_line.tolist() == [False] * 3 + [True] * 3
    assert to_shapely(shapes)[0].area * mm**2 == pytest.approx(10000 - math.pi * 400, rel=1e-4)
    near, width = f"{0.005 / mm:.3g} {name}", f"{0.049 / mm:.3g} {name}"
    x = f"{800 / mm:.9g}"
    (note,) = (note.typed for note in notes if "gap" in note)
    assert note.startswith("a.dxf: 2 gaps between ends of lines stay open, ")
    assert f"{near} that --join-tolerance allows: the widest is {width}, at ({x}, 0) on layer cut" in note


def test_ends_are_joined_by_the_extent_where_no_unit_is_known(drawing):
    with_gaps(drawing, 0, 0.005, 0.01, 0.0)
    shapes, notes = read(drawing)
    assert shapes.is_line.tolist() == [False, False, True]
    (note,) = (note for note in notes if "gap" in note)
    assert "1 gap between ends of lines stays open, wider than the 0.005 that join_tolerance allows" in note
    assert read(drawing, join_tolerance=0.02)[1] == []


@pytest.mark.parametrize("seed", few(range(20)))
def test_chains_whatever_the_order_and_direction(seed):
    rng = np.random.default_rng(seed)
    ring = rng.integers(0, 1000, (8, 2)).astype(float)
    sides = [(tuple(a), tuple(b)) for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True)]
    if seed % 2:
        sides = sides[:-1]
    order = rng.permutation(len(sides))
    curves = []
    for k in order:
        a, b = sides[k][:: rng.choice([-1, 1])]
        curves.append(Curve(a, [Line(b)]))
    made = joined(curves, 0.0)
    assert len(made) == 1
    assert made[0].is_closed == (seed % 2 == 0)
    flat = made[0].flattened(1.0)
    assert shapely.equals(shapely.LineString(flat if seed % 2 else [*flat, flat[0]]).normalize(),
                          shapely.LineString(ring if seed % 2 else [*ring, ring[0]]).normalize())  # fmt: skip
    assert len(flat) == 8


def test_rings_in_rings_are_holes(drawing):
    space = drawing.modelspace()
    for radius in (1, 5, 3, 2):
        space.add_circle((0, 0), radius)
    space.add_circle((0, 0), 4, dxfattribs={"layer": "other"})
    shapes, _ = read(drawing, flatten=1e-5)
    areas = sorted(shapely.area(to_shapely(shapes)))
    assert areas == pytest.approx([3 * math.pi, 16 * math.pi, 16 * math.pi], rel=1e-4)
    assert shapes.properties["layer"] == ["0", "0", "other"]
    assert shapes.feature.tolist() == [0, 1, 2]


# ---- blocks, layers, what is left out --------------------------------------------------------------
def test_blocks(drawing):
    inner, outer = drawing.blocks.new("inner"), drawing.blocks.new("outer", base_point=(1, 1))
    inner.add_circle((0, 0), 1)
    inner.add_circle((0, 0), 0.5, dxfattribs={"layer": "own"})
    outer.add_blockref("INNER", (1, 1))
    drawing.modelspace().add_blockref("outer", (10, 5), {"xscale": 3, "yscale": 2, "rotation": 90, "layer": "l"})
    shapes, _ = read(drawing, flatten=1e-5)
    assert shapes.properties["layer"] == ["l", "own"]
    assert shapely.bounds(to_shapely(shapes)[0]).tolist() == pytest.approx([8, 2, 12, 8])


def test_insertions_are_counted_before_they_are_made(drawing):
    drawing.blocks.new("b0").add_circle((0, 0), 1)
    for k in range(40):
        block = drawing.blocks.new(f"b{k + 1}")
        block.add_blockref(f"b{k}", (0, 0))
        block.add_blockref(f"b{k}", (1, 0))
    drawing.modelspace().add_blockref("b40", (0, 0))
    refused(LimitError, "more than 131072 entities are drawn, as blocks are inserted many times", read, drawing)


def test_blocks_in_themselves(drawing):
    drawing.blocks.new("a").add_blockref("b", (0, 0))
    drawing.blocks.new("b").add_blockref("A", (0, 0))
    drawing.modelspace().add_blockref("a", (0, 0))
    refused(InputError, "'A'", read, drawing)


def test_deep_blocks(drawing):
    for k in range(300):
        drawing.blocks.new(f"b{k}").add_blockref(f"b{k + 1}", (0, 0))
    drawing.blocks.new("b300")
    drawing.modelspace().add_blockref("b0", (0, 0))
    refused(InputError, "blocks are nested more than 100 deep", read, drawing)


def test_what_is_left_out_is_said(drawing):
    space = drawing.modelspace()
    space.add_text("a")
    space.add_mtext("b")
    space.add_point((1, 2))
    space.add_3dface([(0, 0), (1, 0), (1, 1)])
    space.add_hatch()
    space.add_circle((0, 0), 1, dxfattribs={"extrusion": (1, 0, 0)})
    space.add_polymesh((2, 2))
    space.add_linear_dim((0, 0), (0, 0), (1, 0))
    drawing.layers.add("off").off()
    drawing.layers.add("frozen").freeze()
    for layer in ("off", "frozen"):
        space.add_circle((0, 0), 1, dxfattribs={"layer": layer})
    shapes, notes = read(drawing)
    assert not len(shapes)
    said = "1 3DFACE, 1 CIRCLE, 1 DIMENSION, 1 HATCH, 1 MTEXT, 1 POINT, 1 POLYLINE, 1 TEXT"
    assert any(note.endswith(f"skipped: {said}") for note in notes)
    assert any("2 entities on layers that are off or frozen" in note for note in notes)


@pytest.mark.parametrize(("number", "unit"), [(0, None), (1, "in"), (4, "mm"), (6, "m"), (13, "um"), (20, None)])
def test_units(drawing, number, unit):
    drawing.units = number
    drawing.modelspace().add_circle((0, 0), 1)
    assert read(drawing)[0].unit == unit


@pytest.mark.parametrize("version", ["R12", "R2000", "R2004", "R2007", "R2018"])
@pytest.mark.parametrize("fmt", ["asc", "bin"])
def test_versions(version, fmt, tmp_path):
    drawing = ezdxf.new(version)
    drawing.modelspace().add_circle((1, 2), 3, dxfattribs={"layer": "Überhöhung"})
    drawing.saveas(tmp_path / "drawing", fmt=fmt)
    shapes = vorotool.read(tmp_path / "drawing")
    assert len(shapes) == 1
    assert shapes.properties["layer"] == ["Überhöhung"]


# ---- damage ------------------------------------------------------------------------------------------
def test_damaged_files():
    damaged = b"0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n40\nx\n0\nENDSEC\n0\nEOF\n"
    binary = b"AutoCAD Binary DXF\r\n\x1a\0"
    for data in (b"", b"0\nSECTION\n", damaged, b"x" * 99, binary, binary + b"\0\0\0SEC", b"\xff\xfe" * 9):
        refused(InputError, "DXF", read, data)


def test_places_beyond_numbers(drawing):
    drawing.modelspace().add_circle((1e308, 0), 1e308)
    refused(InputError, "layer 0: a coordinate is too large", read, drawing)


def test_no_settings_are_read_and_what_ezdxf_ignores_is_not_printed(drawing, tmp_path):
    drawing.modelspace().add_circle((0, 0), 2)
    entry = b"  0\nVPORT\n  5\n"
    for number, kind in enumerate((b"VPORT", b"NOTHING", b"@\x8f", b"VIEW")):
        data = data_of(drawing).replace(entry, entry.replace(b"VPORT", kind), 1)
        assert number == 0 or data != data_of(drawing)
        (tmp_path / f"{number}.dxf").write_bytes(data)
    (tmp_path / "ezdxf.ini").write_text("this is no file of settings")
    script = "import vorotool\nfor k in range(4):\n    print(len(vorotool.read(f'{k}.dxf')))"
    done = ended_python("-c", script, cwd=tmp_path)
    assert (done.stdout, done.stderr) == ("1\n1\n1\n1\n", "")


@pytest.mark.parametrize("filling", ["empty", "nested", "circle"])
def test_large_arrays_are_refused(drawing, filling):
    block = drawing.blocks.new("b")
    if filling == "circle":
        block.add_circle((0, 0), 1)
    if filling == "nested":
        drawing.blocks.new("c")
        block.add_blockref("c", (0, 0))
    array = {"column_count": 32767, "row_count": 32767, "column_spacing": 1, "row_spacing": 1}
    drawing.modelspace().add_blockref("b", (0, 0), array)
    refused(LimitError, "entities are drawn", read, drawing)


def test_long_lines_are_not_repeated_without_end(drawing):
    drawing.blocks.new("b").add_lwpolyline([(k, k % 7) for k in range(5000)])
    array = drawing.modelspace().add_blockref("b", (0, 0), {"column_count": 100, "column_spacing": 9000})
    refused(LimitError, "pieces of curves are drawn", read, drawing)
    array.dxf.column_count = 3
    assert len(read(drawing)[0]) == 3
