"""``vorotool delaunay``: every result, every kind of input, and what is said when something is wrong."""

import json
from pathlib import Path

import numpy as np
import pytest

import vorotool
from support.readers.written import rows_of

DATA = Path(__file__).parents[3] / "data"
DOTS = DATA / "dots.csv"
MESH = vorotool.delaunay(vorotool.read(DOTS))


def pairs(text):
    return [(int(row["label_a"]), int(row["label_b"])) for row in rows_of(text)]


def test_regions_of_images_count_as_their_centroids(run, folder):
    labels = np.zeros((20, 30), np.uint16)
    labels[2:5, 3:6], labels[10, 10:12], labels[15:, 20:] = 300, 7, 12
    np.save(folder / "labels.npy", labels)
    for seeds in ([], ["--seeds", "labels"], ["--seeds", "centroids"]):
        done = run("delaunay labels.npy --what table", *seeds)
        found = [(int(row["label"]), float(row["x"]), float(row["y"])) for row in done.rows]
        assert found == [(7, 10.5, 10), (12, 24.5, 17), (300, 4, 3)]
        assert done.err == ""  # nothing is put on a lattice
    assert len(run("delaunay mask.pbm --what table").rows) == 2
    assert len(run("delaunay mask.pbm --what table --connectivity 4").rows) == 3
    assert len(run("delaunay mask.pbm --what table --seeds pixels").rows) == 4


def test_files_of_triangle_belong_together(run, folder):
    (folder / "zero.node").write_text("4 2 0 0\n0 0 0\n1 4 0\n2 0 3\n3 1 1\n")
    run("delaunay zero.node --what edges,triangles,table -f ele -o mesh")
    numbers = {}
    for name in ("edges.edge", "triangles.ele", "table.node"):
        (count, *_), *rows = (
            [float(v) for v in line.split()] for line in (folder / f"mesh.{name}").read_text().splitlines()
        )
        assert len(rows) == count
        assert [row[0] for row in rows] == list(range(int(count)))
        numbers[name] = rows
    assert {row[k] for row in numbers["triangles.ele"] for k in (1, 2, 3)} == {0, 1, 2, 3}
    assert [row[1:3] for row in numbers["table.node"]] == [[0, 0], [4, 0], [0, 3], [1, 1]]


def test_stats(run, folder):
    (folder / "twice.csv").write_text("x,y\n1,1\n1,1\n4.1,2\n9,0\n5,1\n")
    done = run("delaunay twice.csv -o a.csv --stats - --verify")
    stats = json.loads(done.out)
    expected = {"points": 5, "duplicates": 1, "edges": 6, "triangles": 3, "hull": 3, "collinear": False}
    assert {name: stats[name] for name in expected} == expected
    assert {"read", "triangulate", "verify", "write edges"} <= set(stats["seconds"])
    (warning,) = stats["warnings"]
    assert "1 of 5 points lie on an earlier point" in warning
    assert done.err == f"warning: {warning}\n"
    assert run("delaunay twice.csv -o a.csv -q").err == ""


def test_verify_notices_a_wrong_triangulation(run, monkeypatch):
    from dataclasses import replace

    monkeypatch.setattr(
        "vorotool.engines.delaunay.delaunay.delaunay", lambda *_, **__: replace(MESH, triangles=MESH.triangles[:, ::-1])
    )
    run(f"delaunay {DOTS}")
    done = run(f"delaunay {DOTS} --verify", code=1)
    assert done.err.startswith("error: ")


@pytest.mark.parametrize(
    ("text", "edges", "words"),
    [
        ("", [], ["the input holds no geometry: the result is empty"]),
        ("x,y\n", [], ["the input holds no geometry: the result is empty"]),
        ("1,2\n", [], ["no edges: 1 distinct point\n"]),
        ("1,2\n1,2\n", [], ["1 of 2 points", "no edges: 1 distinct point\n"]),
        ("1,2\n3,4\n", [(1, 2)], []),
        ("0,0\n2,2\n1,1\n", [(1, 3), (2, 3)], []),
        ("0.1,0.3\n0.1,0.1\n0.1,0.2\n0.1,0.3\n", [(2, 3), (1, 3)], ["1 of 4 points"]),
    ],
)
def test_few_and_collinear_points(run, folder, text, edges, words):
    (folder / "few.csv").write_text(text)
    done = run("delaunay few.csv --verify")
    assert set(pairs(done.out)) == set(edges)
    assert all(word in done.err for word in words)
    assert len(done.err.splitlines()) == len(words)
    done = run("delaunay few.csv --what triangles --stats s.json -o a.csv")
    assert (folder / "a.csv").read_text() == "label_a,label_b,label_c\n"
    assert ("warning: the result has no triangles: " in done.err) == ("," in text.replace("x,y", ""))
    assert json.loads((folder / "s.json").read_text())["collinear"] is True
    for fmt in ("svg", "png", "obj", "geojson", "npz"):
        picture = ("--width", 90) if fmt == "png" else ()
        run(f"delaunay few.csv -o few.{fmt} -q", *picture)
