"""``vorotool skeleton-exact``: every result, every kind of input, and what is said when something is wrong."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import vorotool
from support.processes.leftovers import leftovers
from support.readers.written import rows_of

DATA = Path(__file__).parents[3] / "data"
SHAPES = DATA / "two-shapes.json"
MADE = vorotool.skeleton_exact(vorotool.read(SHAPES))


def test_json_goes_to_standard_output(run, folder):
    done = run("skeleton-exact", SHAPES, "--verify")
    assert (done.code, done.err) == (0, "")
    (folder / "again.json").write_text(done.out)
    assert np.array_equal(vorotool.read(folder / "again.json").vertices, MADE.vertices)


@pytest.mark.parametrize("side", ["interior", "exterior", "both"])
@pytest.mark.parametrize("more", [[], ["--gap", "4"], ["--gap", "4", "--no-complete"]])
def test_sides_and_gaps(run, side, more):
    done = run("skeleton-exact", SHAPES, "--side", side, *more, "-f", "csv", "--verify", "-o", "a.csv", "--stats", "-")
    assert (done.code, done.err) == (0, "")
    stats = json.loads(done.out)
    assert stats["side"] == side
    assert ("gap_deviation" in stats) == bool(more)
    if more:
        assert 0 < stats["gap_deviation"] < 1
    assert stats["arcs"] > stats["parabolas"] > 0


def test_several_results(run, folder):
    done = run("skeleton-exact", SHAPES, "--what", "skeleton,branches,table,elements", "-o", "a.csv")
    assert done.code == 0
    assert {path.name for path in folder.iterdir() if path.name.startswith("a.")} == {
        f"a.{what}.csv" for what in ("skeleton", "branches", "table", "elements")
    }
    table = rows_of((folder / "a.table.csv").read_text())
    assert [(row["id"], row["cycles"]) for row in table] == [("branch", "0"), ("key", "1")]


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.wkt", b"POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))"),
        ("a.json", b"[[0, 0], [4, 0], [4, 4], [0, 4]]"),
        ("a.geojson", b'{"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]]}'),
        ("a.poly", b"4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n"),
    ],
)
def test_inputs(run, folder, name, data):
    (folder / name).write_bytes(data)
    done = run("skeleton-exact", name, "-f", "csv", "-q")
    assert done.code == 0
    assert len(done.rows) == 4


def test_statistics_do_not_depend_on_threads(run, folder):
    """So many segments that two threads insert them at once, and meet."""
    angle = np.linspace(0, 2 * np.pi, 24_000, endpoint=False)
    radius = 10**6 * (2 + np.cos(7 * angle) + np.where(np.arange(len(angle)) % 2, 0.01, 0))
    ring = np.rint(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)).astype(int)
    (folder / "a.json").write_text(json.dumps(ring.tolist()))
    stats = []
    for threads in ("1", "2"):
        done = run("skeleton-exact", "a.json", "--threads", threads, "--stats", "s.json", "-f", "npz", "-o", "b.npz")
        assert done.code == 0
        stats.append(json.loads((folder / "s.json").read_text()))
        del stats[-1]["seconds"], stats[-1]["threads"]
    assert stats[0] == stats[1]


def test_repairs_are_told(run, folder):
    (folder / "a.json").write_text("[[0, 0], [4, 4], [4, 0], [0, 4]]")
    done = run("skeleton-exact", "a.json", "--stats", "s.json", "-o", "b.csv")
    assert done.code == 0
    assert done.err.startswith("warning: repaired: 1 crossing")
    stats = json.loads((folder / "s.json").read_text())
    assert stats["repairs"]["crossings"] == 1
    assert len(stats["warnings"]) == 1
    refused = run("skeleton-exact", "a.json", "--strict")
    assert refused.code == 3
    assert "polygon 1" in refused.err


def test_degrees_are_a_warning(run):
    done = run("skeleton-exact", DATA / "ne_110m_lakes.geojson", "-o", "a.svg", "--input-crs", "OGC:CRS84")
    assert done.code == 0
    assert done.err.startswith("warning: ")
    assert "lengths are in degrees" in done.err.splitlines()[0]


def test_an_open_line_has_no_inside(run, folder):
    (folder / "a.wkt").write_text("LINESTRING (0 0, 4 0, 4 4)")
    done = run("skeleton-exact", "a.wkt", "-f", "csv")
    assert (done.code, len(done.rows)) == (0, 0)
    assert "use --side exterior" in done.err
    rows = run("skeleton-exact", "a.wkt", "--side", "exterior", "-f", "csv").rows
    assert {row["branch"] for row in rows} == {"0"}


BAD = {
    "nan": (b"[[0, 0], [1e999, 0], [0, 1]]", 3, "a.json"),
    "text": (b"hello", 3, "a.json"),
    "nested": (b"[" * 5000, 3, "a.json"),
    "points": (b'{"type": "Point", "coordinates": [0, 0]}', 3, "point"),
    "short": (b"[[0, 0]", 3, "JSON"),
    "empty": (b" ", 3, "a.json is empty"),
    "table": (b'[{"polygon": 0, "area": 2}]', 3, "a.json holds a table, whose rows have polygon, area, not polygons"),
    "offsets": (b'{"type": "vorotool.offsets", "polygons": []}', 3, "write them as GeoJSON (--what offset -f geojson)"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input(run, folder, name):
    data, code, words = BAD[name]
    (folder / "a.json").write_bytes(data)
    done = run("skeleton-exact", "a.json", "-o", "b.svg")
    assert done.code == code
    assert done.err.startswith("error: ")
    assert words in done.err
    assert not (folder / "b.svg").exists()
    assert leftovers(folder) == []


def test_the_polygons_of_a_skeleton_are_read_again(run):
    assert run("skeleton-exact", SHAPES, "-o", "a.json").code == 0
    again = run("skeleton-exact", "a.json", "--what", "table")
    assert (again.code, "a.json" in again.err) == (0, True)
    assert again.out == run("skeleton-exact", SHAPES, "--what", "table").out


@pytest.mark.parametrize("command", [["skeleton-exact"], ["skeleton-approx", "--step", "1", "--compare"]])
def test_the_inside_of_lines_is_missed_once_and_where_it_is_asked_for(run, folder, command):
    (folder / "a.wkt").write_text("LINESTRING (0 0, 9 0, 9 9)")
    done = run(*command, "a.wkt", "-o", "a.json")
    [warning] = [line for line in done.err.splitlines() if line.startswith("warning")]
    assert "--side" in warning
    done = run(*command, "a.wkt", "--side", "both", "-o", "a.json")
    assert (done.code, "warning" in done.err) == (0, False)


def test_what_is_no_text_is_called_so(run, folder):
    (folder / "a.wkt").write_bytes(b"PK\0\1" * 20)
    assert "a.wkt" in run("skeleton-exact", "a.wkt").err


def test_too_many_vertices(run):
    done = run("skeleton-exact", SHAPES, "--max-sites", "10")
    assert done.code == 5
    assert "--max-sites" in done.err


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--gap", "-1"], "0 or more"),
        (["--gap", "x"], "expected a number such as 0.5"),
        (["--flatten", "0", "-f", "wkt"], "expected more than 0"),
        (["--flatten", "1"], "no curves"),
        (["--complete"], "--gap STEP"),
        (["--frame", "0,0,1,1"], "--side exterior"),
        (["--side", "both", "--frame", "0,0,1"], "four numbers"),
        (["--layers", "skeleton"], "pictures"),
        (["--precision", "3", "-o", "a.svg"], "--precision"),
        (["--what", "table", "-o", "a.svg"], "table cannot be written"),
        (["--side", "left"], "left"),
    ],
)
def test_wrong_options(run, options, words):
    done = run("skeleton-exact", SHAPES, *options)
    assert done.code == 2
    assert words in done.err


def test_a_gap_that_removes_an_edge(run):
    done = run("skeleton-exact", SHAPES, "--gap", "20")
    assert done.code == 3
    assert "two-shapes.json: polygon " in done.err
    assert "use a gap below" in done.err


def test_png_has_the_width(run, folder):
    assert run("skeleton-exact", SHAPES, "-o", "a.png", "--width", "320").code == 0
    with Image.open(folder / "a.png") as picture:
        assert picture.size[0] == 320
    assert run("skeleton-exact", SHAPES, "-o", "a.png", "--max-pixels", "1000").code == 5


def test_frames_cut(run):
    done = run("skeleton-exact", SHAPES, "--side", "exterior", "--frame", "0,0,400,200", "-f", "csv", "--verify")
    assert done.code == 0
    xs = [float(row["x1"]) for row in done.rows]
    assert 0 <= min(xs) <= max(xs) <= 400


def test_features_are_separate_unless_they_are_together(run, folder):
    nested = {
        "polygons": [{"shell": square} for square in ([[0, 0], [9, 0], [9, 9], [0, 9]], [[3, 3], [6, 3], [6, 6]])]
    }
    (folder / "nested.json").write_text(json.dumps(nested))
    arguments = ("skeleton-exact", "nested.json", "--what", "table", "--strict", "--verify")
    rows = [run(*arguments, *more).rows for more in ((), ("--features", "together"))]
    assert [[row["ends"] for row in table] for table in rows] == [["4", "3"], ["7", "0"]]
    drawn = run("skeleton-exact", "nested.json", "-f", "svg", "--layers", "polygons").out
    assert drawn.count("<path") == 2
    drawings = {
        run("skeleton-exact", "nested.json", "--gap", "0.1", *more, "-f", "csv", "--verify").out
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
            done = run("skeleton-exact", "a.json", "--gap", "0.2", "--side", side, "-o", "a.csv", "--stats", "-")
            deviations.append(json.loads(done.out)["gap_deviation"])
    assert deviations[4] == pytest.approx(max(deviations[0], deviations[2]))
    assert deviations[5] >= deviations[4] > min(deviations[0], deviations[2]) > 0


def test_a_ring_in_the_first_one_of_a_list_is_noted(run, folder):
    (folder / "rings.json").write_text("[[[0, 0], [9, 0], [9, 9], [0, 9]], [[3, 3], [6, 3], [6, 6]]]")
    done = run("skeleton-exact", "rings.json", "--what", "table")
    assert "ring 2" in done.err
    assert '"holes"' in done.err
