"""What skeleton commands measure: offset curves, shapes rebuilt, places along branches, transects, and graphs."""

import json
import re
from pathlib import Path

import networkx
import numpy as np
import pytest
import shapely
from PIL import Image

import vorotool
from support.readers.written import rows_of

DATA = Path(__file__).parents[3] / "data"
SHAPES, CELLS = DATA / "two-shapes.json", DATA / "cells.png"
COMMANDS = {"skeleton-exact": [], "skeleton-approx": ["--tolerance", "0.1"]}


def test_offsets_of_several_distances(run):
    done = run("skeleton-exact", SHAPES, "--what", "offset", "-d", "-20,5", "-f", "csv", "--verify")
    assert (done.code, done.err) == (0, "")
    rows = done.rows
    expected = vorotool.offset(vorotool.read(SHAPES), [-20, 5])
    assert [float(row["x0"]) for row in rows] == expected.start[:, 0].tolist()
    assert {float(row["distance"]) for row in rows} == {-20, 5}
    assert {row["id"] for row in rows} == {"branch", "key"}
    arcs = [row for row in rows if row["kind"] == "arc"]
    assert {(row["r"], row["ccw"]) for row in arcs} == {("20", "0"), ("5", "1")}


def test_offsets_as_json_and_features(run, folder):
    assert run("skeleton-exact", SHAPES, "--what", "offset", "-d", "10", "-o", "a.json").code == 0
    found = json.loads((folder / "a.json").read_text())
    assert (found["type"], len(found["shapes"]), len(found["rings"])) == ("vorotool.offsets", 2, 3)
    assert {piece["kind"] for piece in found["pieces"]} == {"line", "arc"}
    fine, coarse = (
        json.loads(run("skeleton-exact", SHAPES, "--what", "offset", "-d", "10", "-f", "geojson", *more).out)
        for more in (["--flatten", "0.001"], [])
    )
    shapes = [shapely.geometry.shape(feature["geometry"]) for feature in fine["features"]]
    assert [feature["properties"]["distance"] for feature in fine["features"]] == [10, 10]
    expected = vorotool.offset(vorotool.read(SHAPES), 10).area
    assert [shape.area for shape in shapes] == pytest.approx(expected.tolist(), abs=0.001 * 1000)
    assert len(json.dumps(fine)) > len(json.dumps(coarse))


def test_arcs_are_arcs_in_svg(run):
    done = run("skeleton-exact", SHAPES, "--what", "offset", "-d", "10", "-f", "svg")
    assert re.findall(r'<g id="(\w+)"', done.out) == ["polygons", "offset"]
    drawn = done.out.split('<g id="offset"')[1]
    assert drawn.count("A") == np.count_nonzero(vorotool.offset(vorotool.read(SHAPES), 10).is_arc)


def test_nothing_is_left(run):
    done = run("skeleton-exact", SHAPES, "--what", "offset", "-d", "-1,-1000", "-f", "wkt", "--verify")
    assert done.code == 0
    assert "-1000" in done.err
    assert len(done.out.splitlines()) == 2


@pytest.mark.parametrize("command", COMMANDS)
def test_the_shape_again(run, command):
    done = run(command, SHAPES, *COMMANDS[command], "--what", "shape", "-f", "geojson", "--verify")
    assert (done.code, done.err) == (0, "")
    features = json.loads(done.out)["features"]
    assert [feature["id"] for feature in features] == ["branch", "key"]
    given = vorotool.read(SHAPES)
    allowed = 1e-9 if command == "skeleton-exact" else 0.01
    for feature, shape in zip(features, shapely.from_wkt(wkt_of(run, given)), strict=True):
        again = shapely.geometry.shape(feature["geometry"])
        assert shapely.symmetric_difference(again, shape).area <= allowed * shape.area


def wkt_of(run, polygons):
    vorotool.write(polygons, "given.wkt")
    return Path("given.wkt").read_text().splitlines()


@pytest.mark.parametrize("command", COMMANDS)
def test_points_and_transects(run, command):
    options = [*COMMANDS[command], "--prune", "angle=90", "--every", "7", "-f", "csv"]
    rows = run(command, SHAPES, "--what", "points", *options).rows
    assert {float(row["along"]) % 7 for row in rows} == {0}
    for row in rows:
        x, y, r, *feet = (float(row[name]) for name in ("x", "y", "r", "x_a", "y_a", "x_b", "y_b"))
        assert [np.hypot(feet[0] - x, feet[1] - y), np.hypot(feet[2] - x, feet[3] - y)] == pytest.approx(
            [r, r], abs=0.5
        )
    spans = run(command, SHAPES, "--what", "transects", *options).rows
    assert spans == [row for row in rows if (row["x_a"], row["y_a"]) != (row["x_b"], row["y_b"])]


@pytest.mark.parametrize("command", COMMANDS)
def test_transects_along_centerlines(run, folder, command):
    options = [*COMMANDS[command], "--prune", "scale=1.5", "--along", "centerline", "--every", "7", "--verify"]
    done = run(command, SHAPES, "--what", "transects,centerline", *options, "-o", "a.geojson", "--stats", "-")
    assert done.code == 0
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


def test_transects_are_lines(run):
    done = run("skeleton-exact", SHAPES, "--what", "transects", "--every", "9", "-f", "geojson")
    features = json.loads(done.out)["features"]
    border = shapely.union_all(shapely.boundary(shapely.from_wkt(wkt_of(run, vorotool.read(SHAPES)))))
    ends = [place for feature in features for place in feature["geometry"]["coordinates"]]
    assert max(border.distance(shapely.points(ends))) < 1e-9
    assert {feature["id"] for feature in features} == {"branch", "key"}


def test_graphml_is_read_by_networkx(run, folder):
    assert run("skeleton-exact", SHAPES, "-o", "a.graphml").code == 0
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


def test_many_inputs(run, folder):
    results = ["--what", "offset,shape,points", "-d", "-2", "--every", "5"]
    done = run(
        "skeleton-exact", SHAPES, CELLS, *results, "--out-dir", "out", "-f", "geojson", "--table", "all.csv", "-q"
    )
    assert (done.code, done.err) == (0, "")
    assert {path.name for path in (folder / "out").glob("*.geojson")} == {
        f"{stem}.{what}.geojson" for stem in ("two-shapes", "cells") for what in ("offset", "shape", "points")
    }
    assert len(rows_of((folder / "all.csv").read_text())) == 26


def test_statistics_count(run):
    done = run("skeleton-exact", SHAPES, "--what", "offset", "-d", "-20,5", "-o", "a.csv", "--stats", "-")
    stats = json.loads(done.out)
    assert (stats["distances"], stats["shapes"], stats["rings"]) == ([-20, 5], 5, 6)
    assert "prune" not in stats


def test_pictures(run, folder):
    wanted = ["--what", "offset,shape,points,transects", "-d", "-10,10", "--every", "10"]
    assert run("skeleton-exact", CELLS, *wanted, "-o", "a.png", "--overlay", CELLS).code == 0
    for what in ("offset", "shape", "points", "transects"):
        with Image.open(folder / f"a.{what}.png") as picture:
            assert picture.size == (300, 200)
    made = vorotool.offset(vorotool.read(SHAPES), [-10, 10])
    vorotool.write(made, "b.svg")
    assert run("skeleton-exact", SHAPES, "--what", "offset", "-d", "-10,10", "-o", "c.svg").code == 0
    assert (folder / "b.svg").read_bytes() == (folder / "c.svg").read_bytes()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--what", "offset"], "--what"),
        (["--what", "points,transects", "--out-dir", "x"], "--what points needs --every D"),
        (["-d", "3"], "-d applies only to --what offset"),
        (["--what", "points", "--every", "3", "--along", "centerline", "--side", "exterior"], "inside polygons"),
        (["--every", "3"], "--every"),
        (["--what", "offset", "-d", "0"], "a distance is 0"),
        (["--what", "offset", "-d", "1,inf"], "a distance is inf"),
        (["--what", "offset", "-d", "1,,2"], "'1,,2'"),
        (["--what", "offset", "-d", "2,1,2"], "the distance 2 is repeated"),
        (["--what", "points", "--every", "far"], "'far'"),
        (["--what", "offset", "-d", "1", "--side", "both"], "--side"),
        (["--what", "shape", "--gap", "1"], "a gap leaves the corners out"),
        (["--what", "shape", "--side", "exterior"], "inside polygons"),
        (["--what", "offset", "-d", "1", "-f", "graphml"], "--what"),
        (
            ["--what", "offset", "-d", "1", "-f", "svg", "--layers", "nodes"],
            "a picture of offset in SVG has polygons, offset, labels",
        ),
        (
            ["-f", "svg", "--layers", "offset"],
            "skeleton in SVG has polygons, elements, points, skeleton, nodes, labels",
        ),
        (["--what", "offset", "-d", "-1e71"], "use at most 1e+70"),
        (["--side", "both", "--frame", "0,0,1e71,1"], "use numbers of at most 1e+70"),
        (["--what", "offset", "-d", "1", "--flatten", "1", "-f", "csv"], "--flatten"),
    ],
)
def test_wrong_options(run, folder, options, words):
    there = sorted(folder.iterdir())
    done = run("skeleton-exact", SHAPES, *options)
    assert done.code == 2
    assert words in done.err
    assert sorted(folder.iterdir()) == there


def test_limits(run):
    assert run("skeleton-exact", SHAPES, "--what", "points", "--every", "1e-9").code == 5
    options = ["--what", "offset", "-d", "3", "-o", "a.png", "--max-pixels", "1000"]
    assert run("skeleton-exact", SHAPES, *options).code == 5
