"""What skeleton commands measure: offset curves, shapes rebuilt, places along branches, transects, and graphs."""

import json
from pathlib import Path

import networkx
import pytest
import shapely

import vorotool

DATA = Path(__file__).parents[3] / "data"
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
    for feature, shape in zip(features, shapely.from_wkt(wkt_of(run, given)), strict=True):
        again = shapely.geometry.shape(feature["geometry"])
        assert shapely.symmetric_difference(again, shape).area <= allowed * shape.area


def wkt_of(run, polygons):
    vorotool.write(polygons, "given.wkt")
    return Path("given.wkt").read_text().splitlines()


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
