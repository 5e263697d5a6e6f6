"""Options of the skeleton commands that are about junctions, and about the border of images."""

import json
from pathlib import Path

import networkx
import numpy as np
import pytest
import tifffile

import vorotool

DATA = Path(__file__).parents[3] / "data"
SHAPES, BLOBS = DATA / "two-shapes.json", DATA / "blobs.png"
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
            assert {name: a[name] for name in ("ends", "cycles", "area")} == {
                name: b[name] for name in ("ends", "cycles", "area")
            }
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
    opened = run(*command, "--border", "open", "--verify")
    assert opened.out != usual.out
