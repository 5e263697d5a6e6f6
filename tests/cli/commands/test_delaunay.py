"""``vorotool delaunay``: every result, every kind of input, and what is said when something is wrong."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import vorotool
from support.documents import DATA
from vorotool.engines.digital import triangulation as engine

DOTS = DATA / "dots.csv"
MESH = vorotool.delaunay(vorotool.read(DOTS))


def pairs(done):
    return [(int(row["label_a"]), int(row["label_b"])) for row in done.rows]


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
        lines = (folder / f"mesh.{name}").read_text().splitlines()
        (count, *_), *rows = ([float(v) for v in line.split()] for line in lines)
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
    wrong = replace(MESH, triangles=MESH.triangles[:, ::-1])
    monkeypatch.setattr("vorotool.engines.delaunay.delaunay.delaunay", lambda *_, **__: wrong)
    run(f"delaunay {DOTS}")
    assert run(f"delaunay {DOTS} --verify", code=1).err.startswith("error: ")


@pytest.mark.parametrize(
    ("text", "edges", "words"),
    [
        ("", [], ["warning: few.csv holds no geometry: the result is empty"]),
        ("x,y\n", [], ["warning: few.csv holds no geometry: the result is empty"]),
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
    assert set(pairs(done)) == set(edges)
    assert all(word in done.err for word in words)
    assert len(done.err.splitlines()) == len(words)
    done = run("delaunay few.csv --what triangles --stats s.json -o a.csv")
    assert (folder / "a.csv").read_text() == "label_a,label_b,label_c\n"
    assert ("warning: the result has no triangles: " in done.err) == ("," in text.replace("x,y", ""))
    assert json.loads((folder / "s.json").read_text())["collinear"] is True
    for output in ("few.svg", "few.png --width 90", "few.obj", "few.geojson", "few.npz"):
        run(f"delaunay few.csv -q -o {output}")


# ---- digital triangulations ----------------------------------------
FRAME = "--size 512x512"


def test_regions_of_images_are_linked(run, folder):
    done = run(f"delaunay {DATA}/blobs.png --method digital --verify")
    assert done.err == ""
    table = run(f"tessellate {DATA}/blobs.png --what neighbors")
    assert pairs(done) == pairs(table)
    sites = {row["label"]: (row["x"], row["y"]) for row in run(f"delaunay {DATA}/blobs.png --what table").rows}
    assert all(sites[row["label_a"]] == (row["x_a"], row["y_a"]) for row in done.rows)
    labels = run(f"delaunay {DATA}/cells.png --method digital")
    assert pairs(labels) == pairs(done)  # that is their tessellation


@pytest.mark.parametrize("what", ["edges", "triangles", "table", "cells"])
def test_the_repair_gives_the_exact_result(run, what):
    exact = run(f"delaunay {DOTS} --what {what}")
    done = run(f"delaunay {DOTS} {FRAME} --method digital-valid --what {what} --verify --stats stats.json")
    assert done.err == ""
    assert done.out == exact.out
    repair = json.loads(Path("stats.json").read_text())["repair"]
    assert (repair["route"], repair["fault"]) == ("repaired", None)
    assert repair["filled"] > 0


def test_the_repair_keeps_the_direction_and_crs(run, folder):
    crs = {"type": "name", "properties": {"name": "EPSG:3857"}}
    points = {"type": "MultiPoint", "coordinates": [[0, 0], [9, 1], [4, 7]], "crs": crs}
    (folder / "a.geojson").write_text(json.dumps(points))
    for fmt in ("geojson", "svg"):
        exact, digital, valid = (
            run(f"delaunay a.geojson --method {method} -f {fmt}").out
            for method in ("exact", "digital", "digital-valid")
        )
        assert valid == exact
        assert fmt == "svg" or json.loads(digital)["crs"] == json.loads(exact)["crs"] == crs


def test_objects_cannot_be_repaired(run):
    run(f"delaunay {DATA}/blobs.png --method digital-valid", code=3, says=["blobs.png: label 1", "--method"])
    done = run(f"delaunay {DATA}/blobs.png --method digital-valid --seeds centroids")
    assert done.err == ""
    assert done.out == run(f"delaunay {DATA}/blobs.png").out


def test_a_failed_certificate_is_said(run, monkeypatch):
    monkeypatch.setattr(engine._core.delaunay, "find_fault", lambda *_, **__: "a side is wrong")
    done = run(f"delaunay {DOTS} {FRAME} --method digital-valid --stats stats.json")
    assert done.err.startswith("warning: the digital triangulation could not be repaired")
    assert done.out == run(f"delaunay {DOTS}").out
    stats = json.loads(Path("stats.json").read_text())
    assert stats["repair"]["route"] == "rebuilt"
    assert len(stats["warnings"]) == 1


def test_compare(run):
    done = run(f"delaunay {DOTS} {FRAME} --what compare --stats stats.json")
    table = done.rows
    assert list(table[0]) == ["kind", "difference", "label_a", "label_b", "label_c", "cause", "voronoi_length"]
    comparison = vorotool.compare_digital(vorotool.read(DOTS), shape=(512, 512))
    assert len(table) == comparison.differences.rows == 30
    assert done.err.splitlines() == [f"note: {comparison.summary()}", f"note: {comparison.suggestion.typed}"]
    stats = json.loads(Path("stats.json").read_text())["compare"]
    assert stats["differences"] == {"edge missing off_frame": 15, "triangle missing off_frame": 15}
    assert stats["edge_recall"] == comparison.edge_recall
    assert stats["suggestion"] in done.err
    for fmt in ("json", "npz"):
        assert run(f"delaunay {DOTS} {FRAME} --what compare -q -o a.{fmt}").err == ""
    assert len(json.loads(Path("a.json").read_text())) == 30


def test_limits_and_bad_input(run, folder):
    for options, code in (("--what compare", 5), ("--method digital-valid", 5), ("--method digital", 0)):
        run(f"delaunay {DOTS} {FRAME} {options} --max-pixels 1000", code=code)  # the last is streamed
    (folder / "low.csv").write_text("x,y\n-3,2\n5,2\n")
    run("delaunay low.csv --method digital", code=3, says="--window")
    run("delaunay low.csv --method digital --window -5,0,20,9")
