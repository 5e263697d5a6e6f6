"""DXF as ezdxf reads it: arcs, parabolas, depths, layers, units, and the same bytes each time."""

import io
import itertools
import subprocess
import sys
import time
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
import shapely

import vorotool
from support.few import few
from support.readers.written import bytes_of
from vorotool.convert.polygons import as_polygons
from vorotool.products.registry import PRODUCTS, parts_of, write_product
from vorotool.types.polygons.shapely_geometry import to_shapely

SHELL = [[0, 0], [40, 0], [40, 30], [22, 30], [20, 12], [18, 30], [0, 30]]
SHAPE = [{"shell": SHELL, "holes": [[[4, 4], [9, 4], [4, 9]]]}]


def up(shapes):
    """Polygons with y upwards."""
    return replace(as_polygons(shapes), y_axis="up")


def written(value, what):
    return bytes_of(write_product, value, parts_of(value)[what], "dxf")


def opened(data):
    drawing = ezdxf.read(io.StringIO(data.decode("cp1252")))
    audit = drawing.audit()
    assert not audit.errors
    assert not audit.fixes
    return drawing


# ---- skeletons -------------------------------------------------------------------------------------
def test_arcs_of_skeletons():
    skeleton = vorotool.skeleton_exact(up(SHAPE))
    space = opened(written(skeleton, "skeleton")).modelspace()
    assert {entity.dxftype() for entity in space} <= {"LINE", "LWPOLYLINE", "SPLINE"}
    assert {entity.dxf.layer for entity in space} == {"skeleton"}
    found = []
    for entity in space:
        if entity.dxftype() == "SPLINE":
            tool = entity.construction_tool()
            assert tool.degree == 2
            count = (len(tool.control_points) - 1) // 2
            found += [[(p.x, p.y) for p in tool.points(np.linspace(k, k + 1, 5))] for k in range(count)]
        elif entity.dxftype() == "LINE":
            found.append(np.linspace(entity.dxf.start, entity.dxf.end, 5)[:, :2])
        else:
            corners = np.array([(x, y) for x, y, *_ in entity])
            found += [np.linspace(a, b, 5) for a, b in itertools.pairwise(corners)]
    t = np.linspace(0, 1, 5)[:, None]
    wanted = []
    for (a, b), control, bent in zip(skeleton.arcs, skeleton.control, skeleton.is_parabola, strict=True):
        p, q = skeleton.vertices[a], skeleton.vertices[b]
        wanted.append((1 - t) ** 2 * p + 2 * t * (1 - t) * control + t**2 * q if bent else (1 - t) * p + t * q)

    def ordered(curves):
        return sorted(tuple(np.round(np.ravel(curve), 9) + 0.0) for curve in curves)

    assert skeleton.is_parabola.any()
    assert np.allclose(ordered(found), ordered(wanted), atol=1e-8)


@pytest.mark.parametrize("distance", [-2, 1, 5, 30])
def test_offsets_have_true_arcs(distance):
    offsets = vorotool.offset(up(SHAPE), distance)
    space = opened(written(offsets, "offset")).modelspace()
    area = 0.0
    for entity in space:
        assert entity.dxftype() == "LWPOLYLINE"
        assert entity.closed
        assert entity.dxf.layer == f"offset_{distance}"
        flat = [(v.x, v.y) for v in ezdxf.path.make_path(entity).flattening(1e-4)]
        ring = shapely.LinearRing(flat)
        area += shapely.Polygon(ring).area * (1 if ring.is_ccw else -1)
    assert area == pytest.approx(offsets.area.sum(), rel=1e-4)
    bulges = [bulge for entity in space for *_, bulge in entity]
    assert sum(bulge != 0 for bulge in bulges) == offsets.is_arc.sum()
    assert max(map(abs, bulges)) <= 1


def test_hulls_have_true_arcs():
    points = np.random.default_rng(3).uniform(0, 100, (60, 2))
    hull = vorotool.alpha_hull(vorotool.alpha_shape(points, r=12))
    drawing = opened(written(hull, "hull"))
    arcs = np.concatenate([hull.start, hull.end, hull.center], axis=1)
    found = []
    for entity in drawing.modelspace():
        if entity.dxftype() != "LWPOLYLINE":
            continue
        rows = [(x, y, bulge) for x, y, _, _, bulge in entity]
        for (x, y, bulge), (u, v, _) in zip(rows, [*rows[1:], rows[0]], strict=True):
            center = ezdxf.math.bulge_center((x, y), (u, v), bulge)
            found.append([x, y, u, v, center.x, center.y])
    assert len(arcs) > 20
    assert np.allclose(sorted(np.round(found, 6).tolist()), sorted(np.round(arcs, 6).tolist()), atol=1e-5)


def test_points_are_as_deep_as_they_are_far_from_the_border():
    points = vorotool.points_along(vorotool.skeleton_exact(up(SHAPE)), every=1.5)
    space = opened(written(points, "points")).modelspace()
    places = np.array([entity.dxf.location for entity in space.query("POINT")])
    assert np.array_equal(places, np.column_stack([points.xy, -points.radius]))
    border = to_shapely(up(SHAPE))[0].boundary
    skeleton = points.skeleton
    length = 0.0
    for entity in space.query("POLYLINE"):
        assert entity.dxf.layer == "depth"
        path = np.array([vertex.dxf.location for vertex in entity.vertices])
        assert -path[:, 2] == pytest.approx(shapely.distance(shapely.points(path[:, :2]), border), abs=1e-7)
        assert (np.abs(np.diff(path, axis=0)).sum(axis=1) > 0).all()
        length += np.hypot(*np.diff(path[:, :2], axis=0).T).sum()
    assert length == pytest.approx(skeleton.length.sum(), rel=2e-3)
    every = np.concatenate([[v.dxf.location for v in e.vertices] for e in space.query("POLYLINE")])
    nodes = np.column_stack([skeleton.vertices, -skeleton.radius])
    assert {tuple(row) for row in (nodes + 0.0).tolist()} <= {tuple(row) for row in (every + 0.0).tolist()}


# ---- what has no curves ----------------------------------------------------------------------------


def test_layers_and_units_return(tmp_path):
    drawing = ezdxf.new()
    drawing.units = 1
    for layer in ("cut", "engrave"):
        drawing.modelspace().add_circle((0, 0), len(layer), dxfattribs={"layer": layer})
    drawing.saveas(tmp_path / "a.dxf")
    shapes = vorotool.read(tmp_path / "a.dxf")
    vorotool.write(vorotool.rebuild(vorotool.skeleton_exact(shapes)), tmp_path / "b.dxf")
    again = vorotool.read(tmp_path / "b.dxf")
    assert again.properties["layer"] == ["cut", "engrave"]
    assert again.unit == "in"


def test_only_what_has_places_is_written():
    along = "skeleton diagram centerline offset shape discs points transects"
    for command, expected in {
        "skeleton-exact": f"{along} necks parts",
        "skeleton-approx": along.replace("offset ", "").replace("discs ", ""),
        "distance": "distances hausdorff smallest",
        "delaunay": "edges triangles cells",
        "alphashape": "edges polygons complex general hull",
        "tessellate": "",
        "draw": "",
    }.items():
        assert " ".join(what for what, each in PRODUCTS[command].items() if "dxf" in each.written) == expected


@pytest.mark.parametrize("name", few(["a<b>c", "", "\x07", "Ü", "x" * 400, "0", "Defpoints"], 3))
def test_names_of_layers(name, tmp_path):
    shapes = replace(up([[[0, 0], [4, 0], [0, 3]]]), properties={"layer": [name]})
    assert len(opened(written(shapes, "shape")).modelspace()) == 1
    vorotool.write(shapes, tmp_path / "a.dxf")
    again = vorotool.read(tmp_path / "a.dxf")
    assert again.y_axis == "up"
    assert shapely.equals(to_shapely(again)[0], to_shapely(shapes)[0])


# ---- bytes -----------------------------------------------------------------------------------------
def test_the_same_bytes_each_time(tmp_path):
    script = (
        "import sys, vorotool\n"
        "s = vorotool.skeleton_exact([[0, 0], [40, 0], [40, 30], [20, 12], [0, 30]])\n"
        "vorotool.write(s, sys.argv[1])\nvorotool.write(s, sys.argv[1] + '.dxf')\n"
    )
    started = {}
    for number, folder in enumerate((tmp_path / "a", tmp_path / "b")):
        folder.mkdir()
        if number:
            (folder / "ezdxf.ini").write_text("[core]\nwrite_fixed_meta_data_for_testing = false\n[x")
            time.sleep(1.1)
        command = [sys.executable, "-c", script, "o.dxf"]
        started[folder] = subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)
    made = []
    for folder, child in started.items():
        errors = child.communicate()[1]
        assert child.returncode == 0, errors
        made += [(folder / name).read_bytes() for name in ("o.dxf", "o.dxf.dxf")]
    assert len(set(made)) == 1
    assert ezdxf.__version__.encode() not in made[0]
    assert ezdxf.options.write_fixed_meta_data_for_testing is False
