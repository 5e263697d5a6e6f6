"""The command skeleton-approx, and pruning and centerlines on the command line."""

import csv
import io
import json
from pathlib import Path

import pytest

DATA = Path(__file__).parents[2] / "data"
SHAPES = str(DATA / "two-shapes.json")


def test_a_step_and_its_bound(run, folder):
    done = run("skeleton-approx", SHAPES, "--step", "2", "-o", "a.csv", "--verify", "--stats", "a.json")
    assert (done.code, done.err) == (0, "")
    rows = list(csv.DictReader(io.StringIO((folder / "a.csv").read_text())))
    assert {row["kind"] for row in rows} == {"line"}
    assert len(rows) > 100
    assert json.loads((folder / "a.json").read_text())["arcs"] == len(rows)


def test_a_tolerance_is_met(run, folder):
    done = run("skeleton-approx", SHAPES, "--tolerance", "0.05", "-f", "csv", "--verify")
    assert (done.code, done.err) == (0, "")
    assert all(float(row["error_bound"]) <= 0.05 for row in csv.DictReader(io.StringIO(done.out)))


@pytest.mark.parametrize("arguments", [(), ("--step", "0"), ("--step", "1", "--tolerance", "1"), ("--tolerance", "x")])
def test_what_is_refused(run, folder, arguments):
    assert run("skeleton-approx", SHAPES, *arguments).code == 2


def test_pruned_branches_and_a_centerline(run, folder):
    whole = run("skeleton-exact", SHAPES, "-f", "csv")
    pruned = run("skeleton-exact", SHAPES, "--prune", "angle=60", "-f", "csv")
    assert (pruned.code, pruned.err) == (0, "")
    assert len(pruned.out.splitlines()) < len(whole.out.splitlines())
    line = run("skeleton-exact", SHAPES, "--prune", "angle=60", "--what", "centerline", "-f", "geojson")
    assert line.code == 0
    kinds = {feature["geometry"]["type"] for feature in json.loads(line.out)["features"]}
    assert kinds == {"LineString"}
