"""Applications of dot patterns on the command line: proximity graphs, statistics of cells, persistence of regions."""

import json
from pathlib import Path

import numpy as np
import pytest

import vorotool

DATA = Path(__file__).parents[3] / "data"
DOTS = DATA / "dots.csv"
KINDS = ("gabriel", "relative", "mst")


def pairs(rows):
    return [[int(row["label_a"]) - 1, int(row["label_b"]) - 1] for row in rows]


@pytest.mark.parametrize("kind", KINDS)
def test_graphs_are_those_of_the_library(run, folder, kind):
    graph = vorotool.proximity_graph(vorotool.read(DOTS), kind)
    done = run("delaunay", DOTS, "--graph", kind, "--verify", "--stats", "stats.json")
    assert pairs(done.rows) == graph.edges.tolist()
    assert json.loads((folder / "stats.json").read_text())["graph_edges"] == len(graph)
    assert run("delaunay", DOTS, "--graph", kind, "--threads", 2).out == done.out
    features = json.loads(run("delaunay", DOTS, "--graph", kind, "-f", "geojson").out)["features"]
    assert len(features) == len(graph)
    repaired = run("delaunay", DOTS, "--graph", kind, "--method", "digital-valid", "--size", "512x512")
    assert repaired.out == done.out


def test_graphs_in_pictures(run):
    all_edges = run("delaunay", DOTS, "-f", "svg", "--layers", "edges").out
    assert run("delaunay", DOTS, "-f", "svg", "--layers", "edges", "--graph", "delaunay").out == all_edges
    tree = run("delaunay", DOTS, "-f", "svg", "--layers", "edges", "--graph", "mst").out
    assert len(tree) < 0.6 * len(all_edges)
    assert '<g id="cells"' in run("delaunay", DOTS, "--what", "cells", "-f", "svg", "--layers", "cells,edges",
                                  "--graph", "mst").out  # fmt: skip


def test_graphs_in_other_units(run):
    lengths, halves = (
        [float(row["length"]) for row in run("delaunay", DOTS, "--graph", "mst", *more).rows]
        for more in ([], ["--pixel-size", "0.5um"])
    )
    assert halves == [length / 2 for length in lengths]


def test_statistics_are_those_of_the_library(run):
    found = vorotool.cell_statistics(vorotool.read(DOTS), frame=(0, 0, 512, 512))
    rows = run("delaunay", DOTS, "--frame", "0,0,512,512", "--what", "statistics", "--verify").rows
    assert [row["measure"] for row in rows] == found.summary["measure"]
    assert [float(row["mean"]) for row in rows] == found.summary["mean"].tolist()
    cells = run("delaunay", DOTS, "--frame", "0,0,512,512", "--what", "measures").rows
    assert [row["whole"] == "1" for row in cells] == found.cells["whole"].tolist()


def test_statistics_in_other_units(run):
    def means(*more):
        rows = run("delaunay", DOTS, "--what", "statistics", *more).rows
        return {row["measure"]: float(row["mean"]) for row in rows}

    one, half = means(), means("--pixel-size", "0.5um")
    factors = {"area": 4, "perimeter": 2, "nearest_distance": 2, "tree_length": 2}
    for name, value in half.items():
        assert value * factors.get(name, 1) == pytest.approx(one[name])


def test_persistence_is_that_of_the_library(run, folder):
    found = vorotool.persistence(vorotool.read(DOTS))
    done = run("alphashape", DOTS, "--what", "persistence", "--verify")
    assert done.err == "note: 3 regions stand out, apart below r = 64.49413399086379\n"
    assert [float(row["birth"]) for row in done.rows] == found.birth.tolist()
    assert [row["into"] for row in done.rows] == [str(k + 1) if k >= 0 else "" for k in found.into.tolist()]
    assert run("alphashape", DOTS, "--what", "persistence", "-o", "p.svg", "-q").err == ""
    assert (folder / "p.svg").read_text().count("<rect") == min(len(found), 40) + 1
    scaled = run("alphashape", DOTS, "--what", "persistence", "--pixel-size", "2mm")
    assert f"apart below r = {2 * found.apart_until!r}" in scaled.err
    assert [float(row["birth"]) for row in scaled.rows] == (2 * found.birth).tolist()


def test_one_cluster_and_none(run, folder):
    np.savetxt("dots.csv", np.random.default_rng(1).random((300, 2)), delimiter=",")
    assert run("alphashape", "dots.csv", "--what", "persistence").err == "note: 1 region stands out\n"
    Path("line.csv").write_text("0,0\n1,1\n2,2\n")
    done = run("alphashape", "line.csv", "--what", "persistence", "-f", "svg")
    assert (done.code, done.err) == (0, "note: the shapes have no regions\n")
    assert "there are no regions" in done.out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["delaunay", "--graph", "mst", "--what", "cells"], "--graph"),
        (["delaunay", "--graph", "mst", "--method", "digital"], "--graph"),
        (["delaunay", "--what", "statistics", "--method", "digital"], "--method"),
        (["alphashape", "--what", "persistence", "--rule", "printed"], "use --rule corrected"),
        (["alphashape", "--what", "persistence", "--method", "digital"], "--method"),
    ],
)
def test_what_does_not_go_together(run, arguments, message):
    command, *more = arguments
    done = run(command, DOTS, *more)
    assert (done.code, message in done.err) == (2, True), done.err
