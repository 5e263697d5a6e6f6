"""``vorotool delaunay --method digital``, ``digital-valid`` and ``--what compare``."""

import json
from pathlib import Path

import pytest

import vorotool
from support.readers.written import rows_of
from vorotool.engines.digital import triangulation as engine

DATA = Path(__file__).parents[3] / "data"
DOTS = DATA / "dots.csv"
FRAME = "--size 512x512"


def pairs(text):
    return [(int(row["label_a"]), int(row["label_b"])) for row in rows_of(text)]


def test_regions_of_images_are_linked(run, folder):
    done = run(f"delaunay {DATA}/blobs.png --method digital --verify")
    assert done.err == ""
    table = run(f"tessellate {DATA}/blobs.png --what neighbors")
    assert pairs(done.out) == pairs(table.out)
    sites = {row["label"]: (row["x"], row["y"]) for row in run(f"delaunay {DATA}/blobs.png --what table").rows}
    assert all(sites[row["label_a"]] == (row["x_a"], row["y_a"]) for row in done.rows)
    labels = run(f"delaunay {DATA}/cells.png --method digital")
    assert pairs(labels.out) == pairs(done.out)  # that is their tessellation


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
