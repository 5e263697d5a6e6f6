"""``vorotool alphashape``: every result, every kind of input, and what is said when something is wrong."""

from __future__ import annotations

import json
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import shapely
from PIL import Image

import vorotool
from vorotool.products.registry import all_layers
from vorotool.types.alpha.complex import CLASSES

DATA = Path(__file__).parents[3] / "data"
DOTS = DATA / "dots.csv"
LAYERS = all_layers("alphashape")
FAMILY = vorotool.alpha_complex(vorotool.read(DOTS))
SHAPE = vorotool.alpha_shape(FAMILY, r=60)


def test_edges_go_to_standard_output(run):
    done = run("alphashape", DOTS, "-r", 60, "--verify")
    assert (done.code, done.err) == (0, "")
    assert done.out.splitlines()[0] == "label_a,label_b,x_a,y_a,x_b,y_b,length,r_min,r_max,class"
    rows = done.rows
    assert [(int(row["label_a"]), int(row["label_b"])) for row in rows] == [
        tuple(e) for e in (SHAPE.edges + 1).tolist()
    ]
    assert [row["class"] for row in rows] == SHAPE.classes.tolist()
    assert [float(row["r_min"]) for row in rows] == FAMILY.r_min[SHAPE.edge_index].tolist()
    assert any(row["r_max"] == "" for row in rows)
    assert float(rows[0]["length"]) == pytest.approx(np.hypot(*np.diff(SHAPE.points[SHAPE.edges[0]], axis=0)[0]))


def polygons_of(path):
    features = json.loads(path.read_text())["features"]
    return features, [shapely.geometry.shape(feature["geometry"]) for feature in features]


def test_polygons_are_the_default_of_geojson_and_wkt(run, folder):
    run("alphashape", DOTS, "-r", 60, "-o", "shape.geojson")
    run("alphashape", DOTS, "-r", 60, "-o", "shape.wkt")
    features, polygons = polygons_of(folder / "shape.geojson")
    assert [p.wkt for p in map(shapely.from_wkt, (folder / "shape.wkt").read_text().splitlines())] == [
        p.wkt for p in polygons
    ]
    assert all(p.geom_type == "Polygon" and p.is_valid for p in polygons)
    assert sum(p.area for p in polygons) == SHAPE.area
    assert [feature["properties"]["area"] for feature in features] == [p.area for p in polygons]
    assert [feature["id"] for feature in features] == list(range(1, SHAPE.region_count + 1))
    edges = json.loads(run("alphashape", DOTS, "-r", 60, "--what", "edges", "-f", "geojson").out)["features"]
    assert {feature["properties"]["class"] for feature in edges} == {"singular", "boundary"}
    assert len(edges) == len(SHAPE.edges)


def test_general_holds_all_parts(run, folder):
    (folder / "far.csv").write_text(DOTS.read_text() + "5000,5000\n")
    run("alphashape", "far.csv", "-r", 60, "--what", "general", "-o", "all.geojson")
    features, parts = polygons_of(folder / "all.geojson")
    kinds = [feature["properties"]["class"] for feature in features]
    assert kinds.count("region") == SHAPE.region_count
    assert kinds.count("singular") == SHAPE.classes.tolist().count("singular")
    assert kinds.count("isolated") == len(SHAPE.isolated) + 1
    assert features[-1]["properties"]["label"] == 54
    done = run("alphashape", "far.csv", "-r", 60, "--what", "general", "-f", "wkt")
    assert [shapely.from_wkt(line).wkt for line in done.out.splitlines()] == [part.wkt for part in parts]


def test_complex_family_spectrum_and_curves(run):
    rows = run("alphashape", DOTS, "-r", 60, "--what", "complex").rows
    classes = SHAPE.edge_classes
    assert [row["class"] for row in rows] == [CLASSES[c] for c in classes if c]
    rows = run("alphashape", DOTS, "--what", "family").rows
    assert list(rows[0]) == ["label_a", "label_b", "r_min", "r_mid", "r_max"]
    assert [float(row["r_mid"]) for row in rows] == FAMILY.r_mid.tolist()
    assert [row["r_max"] == "" for row in rows] == np.isinf(FAMILY.r_max).tolist()
    rows = run("alphashape", DOTS, "--what", "spectrum").rows
    assert [float(row["r"]) for row in rows] == FAMILY.spectrum.tolist()
    rows = run("alphashape", DOTS, "--what", "curves").rows
    assert list(rows[0]) == ["r", "area", "perimeter", "regions", "cavities", "edges"]
    assert float(rows[-1]["area"]) == FAMILY.mesh.areas.sum()
    at = FAMILY.reached(60) - 1
    assert (float(rows[at]["area"]), int(rows[at]["regions"])) == (SHAPE.area, SHAPE.region_count)


def test_points_and_table(run, folder):
    (folder / "named.csv").write_text("x,y,name\n0,0,a\n4,0,b\n0,3,c\n9,9,d\n0,0,e\n")
    done = run("alphashape", "named.csv", "-r", 2.5, "--columns", "x,y", "--what", "points", "-q")
    assert done.out.splitlines() == [
        "label,x,y,class,region,name",
        *["1,0,0,boundary,1,a", "2,4,0,boundary,1,b", "3,0,3,boundary,1,c", "4,9,9,isolated,,d", "5,0,0,boundary,1,e"],
    ]
    done = run("alphashape", "named.csv", "-r", 2.5, "--columns", "x,y", "--what", "table", "-q")
    assert done.out.splitlines() == [
        "region,area,perimeter,holes,points,triangles,bbox_x,bbox_y,bbox_w,bbox_h",
        "1,6,12,0,3,1,0,0,4,3",
    ]


def test_auto_is_the_default_and_tells_r(run, folder):
    done = run("alphashape", DOTS, "-o", "a.csv", "--stats", "s.json", "--verify")
    told = re.search(r"^note: r = (\S+), the smallest radius .* one region", done.err, re.MULTILINE)
    stats = json.loads((folder / "s.json").read_text())
    assert stats["r"] == float(told[1])
    assert (stats["regions"], stats["isolated_points"], stats["automatic"]) == (1, 0, True)
    run("alphashape", DOTS, "--auto", "-o", "b.csv", "-q")
    run("alphashape", DOTS, "-r", told[1], "-o", "c.csv")
    assert (folder / "a.csv").read_text() == (folder / "b.csv").read_text() == (folder / "c.csv").read_text()
    less = np.nextafter(stats["r"], 0)
    assert vorotool.alpha_shape(FAMILY, r=less).family.reached(less) == FAMILY.reached(stats["r"]) - 1
    done = run("alphashape", DOTS, "--regions", 3, "-o", "d.csv", "--stats", "s.json")
    assert "at most 3 regions" in done.err
    fewer = json.loads((folder / "s.json").read_text())
    assert fewer["r"] <= stats["r"]
    assert fewer["regions"] <= 3


def test_r_and_alpha_are_read_exactly(run, folder):
    """Half of 0.2 as a double is more than 1/10, which a decimal says exactly."""
    (folder / "pair.csv").write_text("x,y\n0,0\n0.2,0\n")
    assert len(run("alphashape", "pair.csv", "-r", "0.1").out.splitlines()) == 1
    assert len(run("alphashape", "pair.csv", "--alpha", "-10").out.splitlines()) == 1
    exact = repr(0.1) + "000000000000000056"
    assert Fraction(exact) > Fraction(0.1)
    assert len(run("alphashape", "pair.csv", "-r", exact).out.splitlines()) == 2


def test_the_printed_rule(run, folder):
    (folder / "four.csv").write_text("x,y\n0,0\n4,0\n2,1\n2,-5\n")
    right = run("alphashape", "four.csv", "-r", "2.25")
    printed = run("alphashape", "four.csv", "-r", "2.25", "--rule", "printed")
    wrong = set(printed.out.splitlines()) - set(right.out.splitlines())
    assert wrong == {"1,2,0,0,4,0,4,2,2.9,singular"}


def test_thresholds(run, folder):
    options = ("--what", "table", "-f", "json", "-r", 60)
    rows = json.loads(run("alphashape", DOTS, *options).out)
    smallest = min(row["area"] for row in rows)
    kept = json.loads(run("alphashape", DOTS, *options, "--region-threshold", smallest).out)
    assert len(kept) == len(rows) - 1
    run("alphashape", DOTS, "-r", 60, "--hole-threshold", "1e9", "-o", "a.csv", "--stats", "s.json", "--verify")
    assert json.loads((folder / "s.json").read_text())["holes"] == 0


def test_pictures(run, folder):
    done = run("alphashape", DOTS, "-r", 60, "-f", "svg", "--what", "hull")
    assert done.out.count("A60") == 0  # in px, not in units
    assert done.out.count("<path") == 1
    hull = vorotool.alpha_hull(SHAPE)
    assert len(re.findall(r"A[\d.]+ [\d.]+ 0 0 0 ", done.out)) == len(hull)
    up = run("alphashape", DOTS, "-r", 60, "-f", "svg", "--what", "hull", "--y-up")
    assert len(re.findall(r"A[\d.]+ [\d.]+ 0 0 1 ", up.out)) == len(hull)
    chosen = ("--what", "general", "--layers", ",".join(LAYERS[:-1]))
    run("alphashape", DOTS, "-r", 60, *chosen, "--width", 300, "-o", "a.png")
    with Image.open(folder / "a.png") as image:
        assert image.width == 300
    done = run("alphashape", DOTS, "-r", 60, "-f", "svg", "--layers", ",".join(LAYERS))
    assert re.findall(r'<g id="(\w+)"', done.out) == list(LAYERS)
    plot = run("alphashape", DOTS, "--what", "curves", "-f", "svg")
    assert re.findall(r'<g id="(\w+)"', plot.out) == ["axes", "area", "perimeter", "regions", "cavities", "edges"]


def test_the_arcs_of_the_picture_bulge_as_the_hull_does(run, folder):
    """The flattened picture in PNG and the arcs of GeoJSON have the same area."""
    run("alphashape", DOTS, "-r", 60, "--what", "hull", "--layers", "hull", "-o", "hull.png", "--width", 1200)
    run("alphashape", DOTS, "-r", 60, "--what", "hull", "-o", "hull.geojson")
    _, parts = polygons_of(folder / "hull.geojson")
    area = sum(part.area for part in parts)
    assert area < SHAPE.area
    with Image.open(folder / "hull.png") as image:
        pixels = np.asarray(image.convert("RGB"))
    filled = (pixels != 255).any(axis=2).sum()
    low, high = SHAPE.points.min(axis=0), SHAPE.points.max(axis=0)
    scale = 1200 / ((high - low)[0] + 0.04 * (high - low).max())
    assert filled / scale**2 == pytest.approx(area, rel=0.03)


def test_images_by_both_pipelines(run, folder):
    """A dot pattern as a picture: exact and digital triangulations agree but for what the errata say."""
    points = np.loadtxt(DATA / "dot-pattern.csv", delimiter=",", skiprows=1, dtype=int)
    mask = np.zeros((128, 128), np.uint8)
    mask[points[:, 1], points[:, 0]] = 255
    Image.fromarray(mask).save(folder / "dots.png")

    def edges(*options):
        rows = run("alphashape", *options, "-r", 10, "-q").rows
        return {frozenset([(row["x_a"], row["y_a"]), (row["x_b"], row["y_b"])]) for row in rows}

    exact = edges(DATA / "dot-pattern.csv")
    assert edges("dots.png", "--seeds", "pixels") == exact
    assert edges("dots.png", "--seeds", "pixels", "--method", "digital-valid") == exact
    assert edges(DATA / "dot-pattern.csv", "--method", "digital-valid", "--size", "128x128") == exact
    digital = edges("dots.png", "--seeds", "pixels", "--method", "digital")
    assert len(digital & exact) > 0.9 * len(exact)
    assert len(digital - exact) < 0.1 * len(exact)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["-r", 0], "r is 0: a radius must be positive; leave it out for the smallest that joins all points"),
        (["-r", "nan"], "'nan'"),
        (["--alpha", "0.1"], "0.1"),
        (["--alpha", "0"], "alpha must be negative (α = −1/r): for the convex hull use -r inf\n"),
        (["-r", 3, "--alpha", -3], "r and alpha each set the radius"),
        (["-r", 3, "--regions", 2], "--regions"),
        (["--rule", "printed"], "--rule"),
        (["-r", 3, "--rule", "printed", "--verify"], "--verify cannot be combined with --rule printed"),
        (["-r", 3, "--method", "digital", "--what", "table"], "--method"),
        (["-r", 3, "--method", "digital", "-f", "html"], "--method"),
        (["--method", "digital"], "--method"),
        (["--size", "3x3", "-r", 3], "--size"),
        (["--what", "hull", "-r", 3, "--hole-threshold", 1], "the hull has no thresholds"),
        (["-r", 3, "--layers", "points"], "--layers"),
        (["-r", "inf", "--what", "hull"], "the hull of an infinite radius is the convex hull"),
        (["-r", 3, "--region-threshold", -1], "'-1'"),
    ],
)
def test_usage(run, arguments, words):
    done = run("alphashape", DOTS, *arguments)
    assert done.code == 2, done.err
    assert words in done.err.replace("\n       ", " ")


@pytest.mark.parametrize(
    ("text", "arguments", "words"),
    [
        ("x,y\n1,2\n", ["-r", 1], "few.csv"),
        ("x,y\n1,2\n1,2\n", ["-r", 1], "few.csv"),
        ("x,y\n1,2\n3,4\n", [], "few.csv"),
        ("x,y\n0,0\n1,1\n2,2\n", [], "few.csv"),
        ("x,y\n0,0\n1,nan\n", ["-r", 1], "few.csv, line 3"),
    ],
)
def test_bad_input(run, folder, text, arguments, words):
    (folder / "few.csv").write_text(text)
    done = run("alphashape", "few.csv", *arguments)
    assert done.code == 3
    assert words in done.err


def test_an_empty_shape_is_said(run):
    done = run("alphashape", DOTS, "-r", 1)
    assert done.code == 0
    assert (done.err[:9], str(FAMILY.spectrum[0]) in done.err) == ("warning: ", True)
    assert len(done.out.splitlines()) == 1


@pytest.mark.parametrize("what", ["polygons", "table"])
@pytest.mark.parametrize("rule", ["corrected", "printed"])
def test_the_radius_that_is_named_has_a_region(run, what, rule):
    options = [DOTS, "--what", what, "--rule", rule, "-f", "wkt" if what == "polygons" else "csv"]
    done = run("alphashape", *options, "-r", FAMILY.spectrum[0] * 1.001)
    assert done.err.startswith("warning: ")
    named = done.err.split()[-1]
    done = run("alphashape", *options, "-r", named)
    assert (done.err, len(done.out.splitlines()) > (what == "table")) == ("", True)


def test_an_infinite_radius_is_in_the_statistics(run, folder):
    done = run("alphashape", "dots.csv", "-r", "inf", "-o", "shape.csv", "--stats", "-")
    assert (done.code, json.loads(done.out)["r"]) == (0, "inf")


def test_holes_mean_one_thing_and_cavities_another(run, folder):
    """Six triangles in a ring, joined at their corners, enclose a cavity that is a hole of none; a plate has a hole."""
    turn = np.pi / 6 * np.arange(12)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1) * np.where(np.arange(12) % 2, 150, 100)[:, None]
    plate = [(x, y) for x in range(900, 1051, 50) for y in range(0, 151, 50) if not (900 < x < 1050 and 0 < y < 150)]
    (folder / "p.csv").write_text("".join(f"{x},{y}\n" for x, y in [*ring.tolist(), *plate]))
    for r, counts in ((60, (0, 1)), (45, None), (80, None), (110, None)):
        run("alphashape", "p.csv", "-r", r, "--what", "table,polygons", "-f", "json", "-o", "a", "--stats", "s.json")
        stats = json.loads((folder / "s.json").read_text())
        tables = json.loads((folder / "a.table.json").read_text())
        polygons = json.loads((folder / "a.polygons.json").read_text())["polygons"]
        curves = run("alphashape", "p.csv", "--what", "curves").rows
        reached = [row for row in curves if float(row["r"]) <= r][-1]
        assert stats["holes"] == sum(row["holes"] for row in tables)
        assert stats["holes"] == sum(len(polygon["holes"]) for polygon in polygons)
        assert stats["cavities"] == int(reached["cavities"])
        assert counts in (None, (stats["holes"], stats["cavities"]))


def test_rectangular_pixels_are_measured_before(run, folder):
    mask = np.zeros((40, 60), np.uint8)
    mask[5:10, 5:12] = mask[25:33, 30:50] = mask[8:14, 40:45] = 255
    Image.fromarray(mask).save(folder / "mask.png")
    refused = run("alphashape", "mask.png", "--spacing", "1,2")
    assert refused.code == 2
    assert "--spacing" in refused.err
    assert "'--spacin'" in run("alphashape", "mask.png", "--spacin", "1,2").err
    run("tessellate", "mask.png", "--spacing", "1,2", "--what", "table", "-o", "t.csv", "-q")
    rows = run("alphashape", "t.csv", "-r", "50", "--what", "edges", "-q").rows
    places = {(float(row[f"x_{end}"]), float(row[f"y_{end}"])) for row in rows for end in "ab"}
    assert places == {(8, 14), (42, 21), (39.5, 57)}


@pytest.mark.parametrize("ending", ["gpkg", "fgb", "shp", "parquet", "geojson", "wkt"])
def test_files_of_maps_have_polygons(run, tmp_path, ending):
    """As GeoJSON has: GIS users would look for areas."""
    (tmp_path / "p.csv").write_text("x,y\n0,0\n4,0\n4,3\n0,3\n")
    assert run("alphashape", "p.csv", "-r", "3", "-o", f"a.{ending}", "-q").code == 0
    read = vorotool.read(tmp_path / f"a.{ending}")
    assert len(read) == 1
    assert not read.is_line.any()
    vorotool.write(vorotool.alpha_shape([[0, 0], [4, 0], [4, 3], [0, 3]], r=3), tmp_path / f"b.{ending}")
    assert not vorotool.read(tmp_path / f"b.{ending}").is_line.any()
