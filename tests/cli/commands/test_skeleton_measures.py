"""What skeleton commands measure: offset curves, shapes rebuilt, places along branches, transects, and graphs."""

import json
import re
from pathlib import Path

import ezdxf
import networkx
import numpy as np
import pytest
import shapely
import tifffile

import vorotool
from support.documents import DATA
from support.readers.written import rows_of

SHAPES = DATA / "two-shapes.json"
COMMANDS = {"skeleton-exact": [], "skeleton-approx": ["--tolerance", "0.1"]}


@pytest.mark.parametrize("command", COMMANDS)
def test_the_shape_again(run, command):
    done = run(command, SHAPES, *COMMANDS[command], "--what", "shape", "-f", "geojson", "--verify")
    assert done.err == ""
    features = json.loads(done.out)["features"]
    assert [feature["id"] for feature in features] == ["branch", "key"]
    given = vorotool.read(SHAPES)
    allowed = 1e-9 if command == "skeleton-exact" else 0.01
    for feature, shape in zip(features, given.to_shapely(), strict=True):
        again = shapely.geometry.shape(feature["geometry"])
        assert shapely.symmetric_difference(again, shape).area <= allowed * shape.area


@pytest.mark.parametrize("command", COMMANDS)
def test_transects_along_centerlines(run, folder, command):
    options = [*COMMANDS[command], "--prune", "scale=1.5", "--along", "centerline", "--every", "7", "--verify"]
    done = run(command, SHAPES, "--what", "transects,centerline", *options, "-o", "a.geojson", "--stats", "-")
    assert json.loads(done.out)["along"] == "centerline"
    read = [json.loads((folder / f"a.{what}.geojson").read_text())["features"] for what in ("transects", "centerline")]
    transects, lines = ([shapely.geometry.shape(each["geometry"]) for each in features] for features in read)
    for each, feature in zip(transects, read[0], strict=True):
        own = feature["properties"]
        assert own["along"] % 7 == 0
        assert own["width"] == pytest.approx(each.length)
        assert shapely.distance(each, lines[own["label"] - 1]) < 1e-6
        assert {own["ring_a"], own["ring_b"]} <= {0, 1}
    for label, line in enumerate(lines, 1):
        along = [each["properties"]["along"] for each in read[0] if each["properties"]["label"] == label]
        assert max(along) == pytest.approx(line.length, abs=7.1)
    many = run(command, SHAPES, "--what", "points", *options, "-f", "csv").rows
    assert {row["label"] for row in many} == {"1", "2"}


def test_graphml_is_read_by_networkx(run, folder):
    run(f"skeleton-exact {SHAPES} -o a.graphml")
    graph = networkx.read_graphml(folder / "a.graphml", node_type=int, force_multigraph=True)
    skeleton = vorotool.skeleton_exact(vorotool.read(SHAPES))
    expected = skeleton.to_networkx()
    assert dict(graph.nodes(data=True)) == dict(expected.nodes(data=True))
    assert graph.number_of_edges() == expected.number_of_edges()
    branches = vorotool.branch_table(skeleton)
    own = {data["branch"]: data for _, _, data in graph.edges(data=True)}
    for source, target, branch, given in expected.edges(keys=True, data=True):
        found = own[branch]
        line = shapely.from_wkt(found.pop("geometry"))
        assert line.equals_exact(given.pop("geometry"), 0)
        assert found == given
        for name in ("length", "r_min", "r_max", "r_mean"):
            assert found[name] == branches[name][branch]
        ends = [skeleton.vertices[node].tolist() for node in (source, target)]
        assert sorted([list(line.coords[0]), list(line.coords[-1])]) == sorted(ends)
        assert line.length == pytest.approx(found["length"], rel=1e-3)


# ---- approximate skeletons, magnitudes ----------------------------------------
@pytest.mark.parametrize("options", [[], ["--stats", "a.json", "--what", "elements"]])
def test_the_comparison_is_said_with_and_without_statistics(run, options):
    done = run(f"skeleton-approx {SHAPES} --step 5 --compare", *options, "-o", "a.npz")
    assert done.err.splitlines() == [
        "note: from approximate to exact the distance is up to 0.825, near (177.349, 179.301)",
        "note: from exact to approximate the distance is up to 5.77, near (330, 40)",
    ]


@pytest.mark.parametrize(
    ("command", "size"), [(["skeleton-exact"], 1e300), (["skeleton-approx", "--step", "1"], 1e-300)]
)
def test_magnitudes_whose_products_are_no_numbers(run, folder, command, size):
    (folder / "a.json").write_text(json.dumps([[0, 0], [size, 0], [size, size]]))
    run(*command, "a.json", "--verify", "-o", "out.json", code=3, says="a.json")
    assert not (folder / "out.json").exists()


@pytest.mark.parametrize("factor", [1e-70, 1e69])
def test_magnitudes_at_the_limits(run, folder, factor):
    (folder / "a.json").write_text(json.dumps([[0, 0], [10 * factor, 0], [factor, 7 * factor]]))
    options = ["--what", "skeleton,table,centerline,offset", "-d", f"{-factor},{factor}", "--verify", "-o", "out"]
    run("skeleton-exact a.json", *options)
    run(f"skeleton-approx a.json --step {factor} --side both --verify -o b.svg")


# ---- repairs, features, curves ----------------------------------------
def test_repairs_are_told(run, folder):
    (folder / "a.json").write_text("[[0, 0], [4, 4], [4, 0], [0, 4]]")
    assert run("skeleton-exact a.json --stats s.json -o b.csv").err.startswith("warning: a.json: repaired: 1 crossing")
    stats = json.loads((folder / "s.json").read_text())
    assert stats["repairs"]["crossings"] == 1
    assert len(stats["warnings"]) == 1
    run("skeleton-exact a.json --strict", code=3, says="polygon 1")


def test_the_polygons_of_a_skeleton_are_read_again(run):
    run(f"skeleton-exact {SHAPES} -o a.json")
    again = run("skeleton-exact a.json --what table", says="a.json")
    assert again.out == run(f"skeleton-exact {SHAPES} --what table").out


@pytest.mark.parametrize("command", [["skeleton-exact"], ["skeleton-approx", "--step", "1", "--compare"]])
def test_the_inside_of_lines_is_missed_once_and_where_it_is_asked_for(run, folder, command):
    (folder / "a.wkt").write_text("LINESTRING (0 0, 9 0, 9 9)")
    done = run(*command, "a.wkt", "-o", "a.json")
    [warning] = [line for line in done.err.splitlines() if line.startswith("warning")]
    assert "--side" in warning
    assert "warning" not in run(*command, "a.wkt", "--side", "both", "-o", "a.json").err


def test_features_are_separate_unless_they_are_together(run, folder):
    squares = ([[0, 0], [9, 0], [9, 9], [0, 9]], [[3, 3], [6, 3], [6, 6]])
    (folder / "nested.json").write_text(json.dumps({"polygons": [{"shell": square} for square in squares]}))
    arguments = ("skeleton-exact", "nested.json", "--what", "table", "--strict", "--verify")
    rows = [run(*arguments, *more).rows for more in ((), ("--features", "together"))]
    assert [[row["ends"] for row in table] for table in rows] == [["4", "3"], ["7", "0"]]
    assert run("skeleton-exact nested.json -f svg --layers polygons").out.count("<path") == 2
    drawings = {
        run("skeleton-exact nested.json --gap 0.1", *more, "-f", "csv", "--verify").out
        for more in ((), ("--features", "separate"), ("--features", "together"))
    }
    assert sorted({row["label"] for row in rows_of(drawing)} for drawing in drawings) == [{"1"}, {"1", "2"}]


def test_the_deviation_of_a_gap_is_the_largest_of_the_features(run, folder):
    shape = [[0, 0], [8, 0], [8, 3], [4, 1], [0, 3]]
    shapes = [shape, [[2 * x + 1, 2 * y + 1] for x, y in shape]]
    deviations = []
    for chosen in (shapes[:1], shapes[1:], shapes):
        (folder / "a.json").write_text(json.dumps({"polygons": [{"shell": shell} for shell in chosen]}))
        for side in ("interior", "both"):
            done = run(f"skeleton-exact a.json --gap 0.2 --side {side} -o a.csv --stats -")
            deviations.append(json.loads(done.out)["gap_deviation"])
    assert deviations[4] == pytest.approx(max(deviations[0], deviations[2]))
    assert deviations[5] >= deviations[4] > min(deviations[0], deviations[2]) > 0


def test_a_ring_in_the_first_one_of_a_list_is_noted(run, folder):
    (folder / "rings.json").write_text("[[[0, 0], [9, 0], [9, 9], [0, 9]], [[3, 3], [6, 3], [6, 6]]]")
    run("skeleton-exact rings.json --what table", says=["ring 2", '"holes"'])


CURVES = {
    "a.svg": '<svg xmlns="http://www.w3.org/2000/svg"><path d="M1 1H6A2 2 0 0 1 6 5H1Z"/></svg>',
    "a.wkt": "CURVEPOLYGON (COMPOUNDCURVE ((1 1, 6 1), CIRCULARSTRING (6 1, 8 3, 6 5), (6 5, 1 5, 1 1)))",
}


@pytest.mark.parametrize("name", CURVES)
def test_pruning_is_named_where_curves_are_flattened(run, folder, name):
    (folder / name).write_text(CURVES[name])
    done = run(f"skeleton-exact {name} --what branches", says=f"{name}: 1 curve")
    advice = "--prune angle=20"
    assert advice in done.err
    assert len(run(f"skeleton-exact {name} --what branches {advice}").rows) < 10 < len(done.rows)
    for more in (advice.split(), ("--what", "discs"), ("--prune", "none")):
        assert advice not in run(f"skeleton-exact {name}", *more).err


# ---- junctions, borders ----------------------------------------
BLOBS = DATA / "blobs.png"
APPROX = ("skeleton-approx", SHAPES, "--tolerance", "1")
BRICK = '{"polygons": [{"id": "brick", "shell": [[0, 0], [5, 0], [5, 4], [0, 4]]}]}'


@pytest.fixture
def fibre(folder):
    image = np.zeros((9, 12), dtype=np.uint8)
    image[3:6] = 255
    tifffile.imwrite(folder / "fibre.tif", image)
    return folder / "fibre.tif"


@pytest.mark.parametrize("fmt", ["json", "graphml"])
def test_joined_junctions(run, folder, fmt):
    (folder / "brick.json").write_text(BRICK)
    done = run(f"skeleton-exact brick.json --join-junctions --verify -o a.{fmt} --stats -")
    assert done.err == ""
    assert json.loads(done.out)["junctions_joined"] == 1
    joined = vorotool.join_junctions(vorotool.skeleton_exact(vorotool.read("brick.json")))
    if fmt == "graphml":
        graph = networkx.read_graphml("a.graphml")
        assert sorted(dict(graph.nodes(data="degree")).values()) == [1, 1, 1, 1, 4]
        assert all(graph.degree(node) == degree for node, degree in graph.nodes(data="degree"))
    vorotool.write(joined, f"b.{fmt}")
    assert (folder / f"a.{fmt}").read_bytes() == (folder / f"b.{fmt}").read_bytes()


def test_branches_and_tables_of_joined_junctions(run):
    for command in (("skeleton-exact", SHAPES), APPROX):
        whole, joined = (
            run(*command, "--what", "table", "--verify", *more).rows for more in ((), ["--join-junctions"])
        )
        for a, b in zip(whole, joined, strict=True):
            assert int(b["junctions"]) < int(a["junctions"])
            assert all(a[name] == b[name] for name in ("ends", "cycles", "area"))
    rows = run(f"skeleton-exact {SHAPES} --join-junctions --what branches").rows
    assert {row["type"] for row in rows} <= {"junction-end", "junction-junction"}
    assert all(float(row["tortuosity"]) >= 1 for row in rows if row["tortuosity"])


def test_open_border(run, fibre):
    done = run(f"skeleton-exact {fibre} --border open --verify -f json --stats stats.json")
    assert done.err == ""
    made = json.loads(done.out)
    assert (made["border"], made["frame"]) == ("open", [-0.5, -0.5, 12, 9])
    assert [(row["x"], row["y"], row["r"]) for row in made["vertices"]] == [(-0.5, 4, 1.5), (11.5, 4, 1.5)]
    assert json.loads(Path("stats.json").read_text())["border"] == "open"
    Path("made.json").write_text(done.out)
    read = vorotool.read("made.json")
    assert (read.border, read.on_frame.tolist()) == ("open", [True, True])
    scaled = run(f"skeleton-exact {fibre} --border open --spacing 0.5,2um --verify -f csv").rows
    assert [(float(row["x0"]), float(row["x1"]), float(row["r0"])) for row in scaled] == [(-0.25, 5.75, 3)]
    line = run(f"skeleton-exact {fibre} --border open --what centerline -f csv").rows
    assert [float(row["length"]) for row in line] == [12]


@pytest.mark.parametrize("outline", ["crack", "contour"])
def test_closed_is_as_without(run, outline):
    command = ("skeleton-exact", BLOBS, "--outline", outline, "-f", "json")
    closed, usual = run(*command, "--border", "closed"), run(*command)
    assert closed.out == usual.out
    assert run(*command, "--border", "open", "--verify").out != usual.out


# ---- centerlines ----------------------------------------
@pytest.fixture
def rectangle(folder):
    (folder / "rectangle.wkt").write_text("POLYGON((0 0,10 0,10 4,0 4,0 0))")
    return "rectangle.wkt"


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ([], "0 2, 10 2"),
        (["--prune", "none"], "0 2, 10 2"),
        (["--prune", "scale=1.3"], "0 2, 10 2"),
        (["--prune", "scale=1.42"], "0 2, 10 2"),
        (["--from", "0,2", "--to", "10,2"], "0 2, 10 2"),
        (["--to", "0,2", "--from", "10,2"], "10 2, 0 2"),
        (["--ends", "middle"], "0 2, 10 2"),
        (["--ends", "corner"], "0 0, 2 2, 8 2, 10 0"),
        (["--ends", "none"], "2 2, 8 2"),
    ],
)
def test_a_rectangle(run, rectangle, options, line):
    done = run(f"skeleton-exact {rectangle} --what centerline -f wkt", *options)
    assert (done.out, done.err) == (f"LINESTRING ({line})\n", "")


def test_lengths_and_widths_follow(run, rectangle):
    for options, expected in (([], ("10", "4")), (["--ends", "none"], ("6", "4"))):
        done = run(f"skeleton-exact {rectangle} --what table", *options)
        (row,) = done.rows
        assert (row["centerline_length"], row["centerline_width_mean"]) == expected
    done = run(f"skeleton-exact {rectangle} --what centerline -f geojson")
    properties = json.loads(done.out)["features"][0]["properties"]
    assert (properties["length"], properties["width_mean"], properties["width_min"]) == (10, 4, 4)


# ---- smooth lines ----------------------------------------
@pytest.fixture
def ell(tmp_path):
    (tmp_path / "ell.json").write_text("[[[0,0],[60,0],[60,40],[50,40],[50,10],[0,10]]]")
    return "ell.json"


def test_skeletons_are_led_on_to_ends(run, ell):
    pruned = ("skeleton-exact", ell, "--prune", "scale=1.5", "-f")
    led_on = run(*pruned, "wkt", "--ends", "middle", "--flatten", "9", "--verify").out
    assert led_on.startswith("LINESTRING (55 40, 55 10,")
    assert led_on.endswith(" 50 5, 0 5)\n")
    as_is = run(*pruned, "wkt", "--flatten", "9").out
    for ends in ("corner", "none"):
        assert run(*pruned, "wkt", "--ends", ends, "--flatten", "9").out == as_is
    assert [row["kind"] for row in run(*pruned, "csv", "--ends", "middle").rows][:2] == ["extension", "line"]
    (feature,) = json.loads(run(*pruned, "geojson", "--ends", "middle").out)["features"]
    assert feature["properties"]["width_max"] > feature["properties"]["width_min"] == 10


@pytest.mark.parametrize("what", [("--what", "centerline"), ("--prune", "scale=1.5", "--ends", "middle")])
def test_smooth_lines_in_every_format(run, ell, tmp_path, what):
    command = ("skeleton-exact", ell, *what, "--smooth", "0.5", "--verify")
    rows = run(*command, "-f", "csv").rows
    assert all(float(row["error"]) <= 0.5 for row in rows)
    assert list(rows[0])[:4] == ["label", "id", "branch", "curve"]
    assert len(json.loads(run(*command, "-f", "json").out)) == len(rows)
    features = json.loads(run(*command, "-f", "geojson").out)["features"]
    assert sum(feature["properties"]["curves"] for feature in features) == len(rows)
    assert len(run(*command, "-f", "wkt").out.splitlines()) == len(features)
    picture = run(*command, "-f", "svg").out
    assert picture.count("C") >= len(features)
    assert "Q" not in picture
    for options in ("lines.png --width 90", "lines.npz", "lines.dxf"):
        run(*command, "-o", *options.split())
    splines = ezdxf.readfile(tmp_path / "lines.dxf").modelspace().query("SPLINE")
    assert len(splines) == len(features)
    assert {spline.dxf.degree for spline in splines} == {3}


def test_svg_has_the_curves_of_the_table(run, ell):
    command = ("skeleton-exact", ell, "--what", "centerline", "--smooth", "0.5")
    rows, picture = run(*command, "-f", "csv").rows, run(*command, "-f", "svg").out
    path = re.search(r'id="centerline".*? d="([^"]*)"', picture, re.DOTALL)[1]
    numbers = np.array(re.findall(r"[-0-9.]+", path), dtype=float).reshape(-1, 2)
    names = [(f"x{k}", f"y{k}") for k in range(4)]
    table = np.array([[[float(row[x]), float(row[y])] for x, y in names] for row in rows])
    table = np.concatenate([table[0, :1], *table[:, 1:]])
    scale = np.ptp(numbers, axis=0) / np.ptp(table, axis=0)
    np.testing.assert_allclose((numbers - numbers[0]) / scale, table - table[0], atol=0.01)
