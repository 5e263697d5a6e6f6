"""``vorotool voronoi``: what holds points, lines and polygons, every option, and what is said when it goes wrong."""

import json
import warnings
from pathlib import Path

import geopandas
import numpy as np
import pytest
import shapely
from PIL import Image

import vorotool
from support.documents import DATA
from support.families.vector_files import save

SHAPES = [
    shapely.Point(0, 0),
    None,
    shapely.MultiPoint([(20, 0), (22, 1)]),
    shapely.LineString([(5, 5), (9, 6), (12, 3)]),
    shapely.GeometryCollection([shapely.Point(0, 14), shapely.box(4, 10, 9, 13) - shapely.box(5, 11, 6, 12)]),
    shapely.MultiPolygon([shapely.box(14, 8, 18, 12), shapely.box(19, 8, 21, 12)]),
]
SVG = '<svg xmlns="http://www.w3.org/2000/svg">'
COLUMNS = {"kind": ["tree", "tree", "tree", "wall", "house", "house"], "code": ["007", "8", "9", "10", "11", "12"]}
MIXED = geopandas.GeoDataFrame(COLUMNS, geometry=SHAPES, crs="EPSG:2056")


@pytest.fixture(scope="module")
def right():
    with warnings.catch_warnings(action="ignore"):
        return vorotool.voronoi(MIXED)


@pytest.fixture
def mixed(folder):
    document = {**MIXED.to_geo_dict(drop_id=True), "crs": {"type": "name", "properties": {"name": "EPSG:2056"}}}
    (folder / "mixed.geojson").write_text(json.dumps(document))
    return folder / "mixed.geojson"


def shapes_of(text):
    """Shapes of features; None is an empty one."""
    features = json.loads(text)["features"]
    return [shapely.geometry.shape(each["geometry"] or {"type": "Polygon", "coordinates": []}) for each in features]


# ---- what is read ------------------------------------------------------------------------------------
def test_a_limit_of_distance_widens_the_default_frame(run):
    rooms = "\n".join(shapely.box(*bounds).wkt for bounds in ((0, 0, 10, 10), (13, 0, 20, 7), (0, 14, 9, 20)))
    done = run("voronoi - --max-distance 4 --what table --verify", data=rooms.encode())
    assert sum(float(row["area"]) for row in done.rows) == pytest.approx(623.6222, abs=1e-4)


@pytest.mark.parametrize("name", ["a.gpkg", "a.fgb", "a.parquet", "a.wkt", "a.csv", "a.jsonl", "a.geojson"])
def test_points_lines_and_polygons_of_each_format(run, folder, right, name):
    path, texts = folder / name, ["POINT EMPTY" if shape is None else shape.wkt for shape in SHAPES]
    if path.suffix == ".wkt":
        path.write_text("\n".join(texts))
    elif path.suffix == ".csv":
        path.write_text("code,wkt\n" + "".join(f'{code},"{text}"\n' for code, text in zip(COLUMNS["code"], texts)))  # noqa: B905
    elif path.suffix == ".jsonl":
        path.write_text("\n".join(json.dumps(each) for each in json.loads(MIXED.to_json())["features"]))
    elif path.suffix == ".geojson":
        path.write_text(MIXED.to_json())
    else:
        save(MIXED, path)
    run(f"voronoi {path} -f npz -o cells.npz")
    cells = vorotool.read(folder / "cells.npz")
    assert len(cells) == 6
    np.testing.assert_allclose(cells.areas, right.areas)
    if path.suffix != ".wkt":
        assert [str(code) for code in cells.properties["code"]] == COLUMNS["code"]


@pytest.mark.parametrize(
    ("name", "text", "count"),
    [
        ("a.csv", "x,y,name\n2,1,a\n7,5,b\n1,6,c\n", 3),
        ("a.txt", "2 1\n7 5\n", 2),
        ("a.json", "[[2, 1], [7, 5], [1, 6], [9, 9]]", 4),
        ("a.json", '{"polygons": [{"shell": [[0, 0], [4, 0], [0, 3]]}, {"line": [[5, 5], [9, 5]]}]}', 2),
        ("a.json", "[[[0, 0], [4, 0], [0, 3]], [[10, 0], [14, 0], [10, 3]]]", 2),
        ("a.node", "2 2 0 0\n1 2 1\n2 7 5\n", 2),
        ("a.poly", "3 2 0 0\n1 0 0\n2 4 0\n3 0 3\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n", 1),
        ("a.geojson", '{"type": "MultiPoint", "coordinates": [[0, 0], [5, 5]]}', 1),
        ("a.wkt", "POINT (0 0)\nPOINT (3 4)\n", 2),
        ("a.svg", f'{SVG}<rect width="4" height="3"/><path d="M9,0 L12,5" fill="none" stroke="red"/></svg>', 2),
    ],
)
def test_each_kind_of_text(run, folder, name, text, count):
    (folder / name).write_text(text)
    assert len(run(f"voronoi {name} --what table -q --verify").rows) == count


def test_maps_and_skeletons_are_read_for_what_they_are_made_of(run, folder, mixed):
    run(f"voronoi {mixed} -q --by kind -o a.json")
    run(f"voronoi {mixed} -q --by kind -o a.npz")
    for name in ("a.json", "a.npz"):
        done = run(f"voronoi {name} -f json", says=name)
        assert done.out == (folder / "a.json").read_text()
    run(f"skeleton-exact {DATA}/two-shapes.json -o s.json")
    done = run("voronoi s.json --what table")
    assert len(done.rows) == 2
    assert "holds a skeleton" in done.err


# ---- images ------------------------------------------------------------------------------------------
LABELS = np.zeros((40, 60), dtype=np.uint8)
LABELS[5:15, 5:15], LABELS[25:35, 8:20], LABELS[10:30, 40:50], LABELS[38, 58] = 7, 3, 9, 7


@pytest.fixture
def labels(folder):
    Image.fromarray(LABELS).save(folder / "labels.png")
    return folder / "labels.png"


def test_masks_have_a_site_a_component(run, labels):
    run(f"voronoi {labels} --threshold 0 --what table --stats s.json -o a.csv")
    stats = json.loads(Path("s.json").read_text())
    assert (stats["sites"], stats["outline"], stats["connectivity"]) == (4, "crack", 8)
    by_contour = run(f"voronoi {labels} --outline contour --seeds labels --what table")
    assert float(by_contour.rows[0]["own_area"]) < 120
    assert len(run(f"voronoi {labels} --threshold 0 --min-area 2 --what table -q").rows) == 3


# ---- what is computed --------------------------------------------------------------------------------


def test_the_frame(run, mixed, folder):
    run(f"voronoi {mixed} --frame -5,-5,40,30.5 --stats s.json -o a.geojson")
    shapes = shapes_of((folder / "a.geojson").read_text())
    assert shapely.union_all(shapes).bounds == (-5, -5, 35, 25.5)
    assert shapely.coverage_is_valid(shapes)
    stats = json.loads((folder / "s.json").read_text())
    assert stats["frame"] == [-5, -5, 40, 30.5]
    assert (stats["features"], stats["sites"], stats["empty_cells"], stats["sites_without_geometry"]) == (6, 6, 1, 1)
    assert stats["parabolas"] > 0
    assert {"shared_points", "shared_segments", "overlaps"} <= set(stats)
    assert set(stats["seconds"]) >= {"read", "voronoi", "write cells"}


def test_a_limit_of_distance(run, mixed, folder):
    frame = ["--frame", "-50,-50,120,120"]
    run(f"voronoi {mixed} -q --max-distance 1.5", *frame, "--flatten", "1e-4", "-o", "a.geojson")
    shapes = shapes_of((folder / "a.geojson").read_text())
    near = shapely.union_all([shape.buffer(1.5, quad_segs=256) for shape in SHAPES if shape is not None])
    covered = shapely.union_all(shapes)
    assert covered.symmetric_difference(near).area < 1e-3 * near.area
    run(f"voronoi {mixed} -q --max-distance 1.5", *frame, "-o", "b.geojson")
    flatten = ("--flatten", "1e-4", "--flatten", "auto")  # the last holds
    run(f"voronoi {mixed} -q --max-distance 1.5", *frame, *flatten, "-o", "c.geojson")
    assert (folder / "b.geojson").read_bytes() == (folder / "c.geojson").read_bytes()
    assert (folder / "b.geojson").read_bytes() != (folder / "a.geojson").read_bytes()
    run(f"voronoi {mixed} -q --max-distance 1.5 -o a.json")
    assert vorotool.read(folder / "a.json").max_distance == 1.5
    assert {arc["kind"] for arc in json.loads((folder / "a.json").read_text())["arcs"]} >= {"circle", "line"}


@pytest.fixture
def cuts(folder):
    (folder / "clip.wkt").write_text("POLYGON ((-4 -4, 24 -4, 24 9, 10 16, -4 9, -4 -4), (1 1, 2 1, 2 2, 1 1))")
    (folder / "streets.wkt").write_text("LINESTRING (-9 7, 30 7)\nLINESTRING (13 -9, 13 30)")
    return folder


def test_a_clip(run, mixed, cuts):
    run(f"voronoi {mixed} --clip clip.wkt --verify --stats s.json -o a.geojson", says="clip.wkt")
    clip = shapely.from_wkt((cuts / "clip.wkt").read_text())
    shapes = shapes_of((cuts / "a.geojson").read_text())
    assert shapely.union_all(shapes).symmetric_difference(clip).area < 1e-9
    assert json.loads((cuts / "s.json").read_text())["frame"] == [-4, -4, 28, 20]
    both = run(f"voronoi {mixed} -q --clip clip.wkt --frame 0,0,9,9")
    assert (
        shapely.union_all(shapes_of(both.out)).symmetric_difference(clip.intersection(shapely.box(0, 0, 9, 9))).area
        < 1e-9
    )


def test_enclosures(run, mixed, cuts):
    options = ["--enclosures", "streets.wkt", "--frame", "-5,-5,30,30", "-q"]
    run(f"voronoi {mixed}", *options, "--verify", "-o", "a.geojson")
    shapes = shapes_of((cuts / "a.geojson").read_text())
    right = vorotool.voronoi(MIXED, enclosures=vorotool.read(cuts / "streets.wkt"), frame=(-5, -5, 30, 30))
    assert shapely.equals_exact(shapes, right.to_shapely()).all()
    above = shapely.box(-9, 7, 30, 30)
    assert [round(shapes[k].intersection(above).area / shapes[k].area, 9) for k in (0, 3, 5)] == [0, 0, 1]
    rows = run(f"voronoi {mixed}", *options, "--what", "edges").rows
    assert {row["r0"] == "" for row in rows} == {True, False}  # along an enclosure there is no one distance


def test_all_cuts_together_are_kept_with_the_map(run, mixed, cuts):
    options = ["--clip", "clip.wkt", "--enclosures", "streets.wkt", "--max-distance", "2.5", "-q", "--verify"]
    for fmt in ("json", "npz"):
        run(f"voronoi {mixed}", *options, "-o", f"a.{fmt}")
    cells = vorotool.read(cuts / "a.json")
    assert cells == vorotool.read(cuts / "a.npz")
    assert (cells.max_distance, len(cells.clip), len(cells.enclosures)) == (2.5, 1, 2)
    run("draw a.json -o a.svg")


def test_cuts_of_images_on_maps_are_on_the_map(run, folder, labels):
    (folder / "labels.pgw").write_text("2\n0\n0\n-2\n1001\n4999\n")
    (folder / "clip.wkt").write_text("POLYGON ((1010 4950, 1100 4950, 1100 4990, 1010 4990, 1010 4950))")
    done = run(f"voronoi {labels} --clip clip.wkt -q --verify")
    clip = shapely.from_wkt((folder / "clip.wkt").read_text())
    assert shapely.union_all(shapes_of(done.out)).symmetric_difference(clip).area < 1e-6
    limited = run(f"voronoi {labels} -q --max-distance 3m --pixel-size 2m --what table")
    assert max(float(row["max_distance"]) for row in limited.rows) == pytest.approx(3)


# ---- few sites ---------------------------------------------------------------------------------------
def test_nothing_to_share_out(run, folder):
    (folder / "none.geojson").write_text('{"type": "FeatureCollection", "features": []}')
    assert json.loads(run("voronoi none.geojson").out)["features"] == []
    assert run("voronoi none.geojson --what table").out.count("\n") == 1
    (folder / "one.wkt").write_text("POINT (3 4)")
    done = run("voronoi one.wkt --what edges")
    assert done.rows == []
    assert "no edges: the input has 1 site" in done.err


# ---- what is refused ---------------------------------------------------------------------------------


def test_repairs_are_refused_when_asked(run, folder):
    (folder / "twice.wkt").write_text("POLYGON ((0 0, 4 0, 4 0, 4 4, 0 0))\nPOINT (9 9)")
    run("voronoi twice.wkt --what table", says="1 repeated vertex")
    run("voronoi twice.wkt --strict", code=3, says="leave out --strict")


@pytest.mark.parametrize(("what", "frame"), [("cells", "0,0,2,2"), ("edges", "8,8,1,2"), ("discs", "0,0,2,2")])
def test_a_clip_outside_of_the_frame_is_an_empty_result(run, folder, what, frame):
    (folder / "two.wkt").write_text("POINT (0 0)\nPOINT (1 1)\n")
    (folder / "far.wkt").write_text("POLYGON ((9 9, 10 9, 9 10, 9 9))\n")
    line = f"voronoi two.wkt --frame {frame} --clip far.wkt --what {what} -f csv --verify"
    assert len(run(line, says="all 2 cells are empty").rows) == 2 * (what == "cells")
