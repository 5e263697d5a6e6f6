"""``vorotool delaunay --method digital``, ``digital-valid`` and ``--what compare``."""

import json
from pathlib import Path

import numpy as np
import pytest

import vorotool
from support.readers.written import rows_of
from vorotool.engines.digital import triangulation as engine

DATA = Path(__file__).parents[3] / "data"
DOTS = DATA / "dots.csv"
FRAME = ("--size", "512x512")


def pairs(text):
    return [(int(row["label_a"]), int(row["label_b"])) for row in rows_of(text)]


def test_the_rule_to_the_letter(run):
    done = run("delaunay", DOTS, *FRAME, "--method", "digital", "--verify")
    assert (done.code, done.err) == (0, "")
    found = vorotool.digital_triangulation(vorotool.read(DOTS), shape=(512, 512))
    assert pairs(done.out) == [tuple(edge) for edge in (found.edges + 1).tolist()]
    table = run("tessellate", DOTS, *FRAME, "--what", "neighbors")
    assert pairs(done.out) == pairs(table.out)
    triangles = run("delaunay", DOTS, *FRAME, "--method", "digital", "--what", "triangles")
    assert [tuple(map(int, row.values())) for row in triangles.rows] == [
        tuple(t) for t in (found.triangles + 1).tolist()
    ]


@pytest.mark.parametrize("what", ["edges", "triangles"])
def test_formats_of_the_rule(run, folder, what):
    for fmt in ("csv", "json", "geojson", "npz", "obj", "svg", "png"):
        done = run("delaunay", DOTS, *FRAME, "--method", "digital", "--what", what, "-o", f"a.{fmt}")
        assert (done.code, done.err) == (0, "")
    found = vorotool.digital_triangulation(vorotool.read(DOTS), shape=(512, 512))
    with np.load(folder / "a.npz") as arrays:
        assert len(arrays["label_a"]) == len(getattr(found, what))
    vorotool.write(found, folder / "b.csv", what=what)
    assert (folder / "b.csv").read_bytes() == (folder / "a.csv").read_bytes()
    kind = {"edges": "edge", "triangles": "ele"}[what]
    done = run("delaunay", DOTS, "--method", "digital", "--what", what, "-f", kind)
    assert done.code == 2
    assert "--method" in done.err
    with pytest.raises(vorotool.UsageError, match=f"'{kind}'"):
        vorotool.write(found, folder / f"b.{kind}")


def test_regions_of_images_are_linked(run, folder):
    done = run("delaunay", DATA / "blobs.png", "--method", "digital", "--verify")
    assert (done.code, done.err) == (0, "")
    table = run("tessellate", DATA / "blobs.png", "--what", "neighbors")
    assert pairs(done.out) == pairs(table.out)
    sites = {row["label"]: (row["x"], row["y"]) for row in run("delaunay", DATA / "blobs.png", "--what", "table").rows}
    assert all(sites[row["label_a"]] == (row["x_a"], row["y_a"]) for row in done.rows)
    labels = run("delaunay", DATA / "cells.png", "--method", "digital")
    assert pairs(labels.out) == pairs(done.out)  # that is their tessellation


@pytest.mark.parametrize("what", ["edges", "triangles", "table", "cells"])
def test_the_repair_gives_the_exact_result(run, what):
    exact = run("delaunay", DOTS, "--what", what)
    done = run(
        "delaunay", DOTS, *FRAME, "--method", "digital-valid", "--what", what, "--verify", "--stats", "stats.json"
    )
    assert (done.code, done.err) == (0, "")
    assert done.out == exact.out
    repair = json.loads(Path("stats.json").read_text())["repair"]
    assert (repair["route"], repair["fault"]) == ("repaired", None)
    assert repair["filled"] > 0


def test_the_repair_keeps_the_direction_and_crs(run, folder):
    points = {"type": "MultiPoint", "coordinates": [[0, 0], [9, 1], [4, 7]]}
    crs = {"type": "name", "properties": {"name": "EPSG:3857"}}
    (folder / "a.geojson").write_text(json.dumps({"type": "FeatureCollection", "crs": crs, "features": [
        {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": c}}
        for c in points["coordinates"]
    ]}))  # fmt: skip
    for what in ("edges", "triangles"):
        outputs = {}
        for method in ("exact", "digital", "digital-valid"):
            for fmt in ("geojson", "svg"):
                done = run("delaunay", "a.geojson", "--method", method, "--what", what, "-f", fmt)
                assert (done.code, done.err) == (0, "")
                outputs[method, fmt] = done.out
        assert outputs["digital-valid", "geojson"] == outputs["exact", "geojson"]
        assert outputs["digital-valid", "svg"] == outputs["exact", "svg"]
        assert json.loads(outputs["digital", "geojson"])["crs"] == crs


def test_objects_cannot_be_repaired(run):
    done = run("delaunay", DATA / "blobs.png", "--method", "digital-valid")
    assert done.code == 3
    assert "blobs.png: label 1" in done.err
    assert "--method" in done.err
    done = run("delaunay", DATA / "blobs.png", "--method", "digital-valid", "--seeds", "centroids")
    assert (done.code, done.err) == (0, "")
    assert done.out == run("delaunay", DATA / "blobs.png").out


def test_centroids_between_the_lattice(run, folder):
    labels = np.zeros((20, 20), np.uint8)
    labels[3, 3:5] = labels[4, 3] = 1  # thirds of pixels: the region's seed moves, the site does not
    labels[15, 4], labels[8, 16] = 2, 3
    np.save(folder / "a.npy", labels)
    done = run("delaunay", "a.npy", "--method", "digital-valid", "--seeds", "centroids", "--what", "table")
    assert "1 of 3 seeds moved to the nearest 2^-" in done.err
    assert done.out == run("delaunay", "a.npy", "--what", "table").out


def test_a_failed_certificate_is_said(run, monkeypatch):
    monkeypatch.setattr(engine._core.delaunay, "find_fault", lambda *_: "a side is wrong")
    done = run("delaunay", DOTS, *FRAME, "--method", "digital-valid", "--stats", "stats.json")
    assert done.code == 0
    assert done.err.startswith("warning: the digital triangulation could not be repaired")
    assert done.out == run("delaunay", DOTS).out
    stats = json.loads(Path("stats.json").read_text())
    assert stats["repair"]["route"] == "rebuilt"
    assert len(stats["warnings"]) == 1


def test_seeds_that_cannot_be_repaired_are_inserted(run, folder):
    """Far outside the frame there is nothing to read off it."""
    np.save(folder / "a.npy", np.random.default_rng(1).random((40, 2)) * 100)
    done = run("delaunay", "a.npy", "--window", "300,300,9,9", "--method", "digital-valid")
    assert done.code == 0
    assert len(pairs(done.out)) > 80
    assert "moved to the nearest 2^-" in done.err


def test_compare(run):
    done = run("delaunay", DOTS, *FRAME, "--what", "compare", "--stats", "stats.json")
    assert done.code == 0
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
        assert run("delaunay", DOTS, *FRAME, "--what", "compare", "-q", "-o", f"a.{fmt}").err == ""
    assert len(json.loads(Path("a.json").read_text())) == 30


def test_several_results_of_one_run(run, folder):
    done = run("delaunay", DOTS, *FRAME, "--method", "digital", "--what", "edges,compare", "-o", "found", "-q")
    assert (done.code, done.err) == (0, "")
    assert len(rows_of((folder / "found.compare.csv").read_text())) == 30
    assert len(pairs((folder / "found.edges.csv").read_text())) == 131


@pytest.mark.parametrize("method", ["digital", "digital-valid"])
def test_few_points(run, folder, method):
    (folder / "none.csv").write_text("x,y\n")
    (folder / "one.csv").write_text("x,y\n3,2\n")
    (folder / "line.csv").write_text("x,y\n3,2\n5,2\n9,2\n")
    for name, count, warning in (
        ("none", 0, "warning: the input holds no geometry: the result is empty\n"),
        ("one", 0, "warning: the result has no edges"),
        ("line", 2, ""),
    ):
        done = run("delaunay", f"{name}.csv", "--method", method)
        assert done.code == 0
        assert len(pairs(done.out)) == count
        assert done.err.startswith(warning)
        assert done.err.count("warning: ") == (count == 0)
        done = run("delaunay", f"{name}.csv", "--what", "compare")
        assert (done.code, len(done.rows)) == (0, 0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--size", "9x9"], "--size"),
        (["--window", "0,0,9,9"], "--window"),
        (["--size", "9x9", "--window", "0,0,9,9", "--method", "digital"], "--window"),
        (["--method", "digital", "--what", "table"], "--method"),
        (["--method", "digital", "--what", "cells"], "--method"),
        (["--method", "digital", "-f", "svg", "--layers", "cells"], "--layers"),
        (["--method", "digital-valid", "--what", "compare"], "--what"),
        (["--what", "edges,compare", "-o", "a"], "--what"),
        (["--what", "compare", "-f", "svg"], "compare cannot be written as svg"),
    ],
)  # fmt: skip
def test_what_does_not_go_together(run, arguments, message):
    done = run("delaunay", DOTS, *arguments)
    assert done.code == 2
    assert message in done.err


def test_frames_are_for_points(run):
    done = run("delaunay", DATA / "blobs.png", "--method", "digital", *FRAME)
    assert done.code == 2
    assert "--size" in done.err


def test_limits_and_bad_input(run, folder):
    done = run("delaunay", DOTS, *FRAME, "--method", "digital-valid", "--max-pixels", "1000")
    assert done.code == 5
    assert run("delaunay", DOTS, *FRAME, "--what", "compare", "--max-pixels", "1000").code == 5
    assert run("delaunay", DOTS, *FRAME, "--method", "digital", "--max-pixels", "1000").code == 0  # streamed
    (folder / "low.csv").write_text("x,y\n-3,2\n5,2\n")
    done = run("delaunay", "low.csv", "--method", "digital")
    assert done.code == 3
    assert "--window" in done.err
    assert run("delaunay", "low.csv", "--method", "digital", "--window", "-5,0,20,9").code == 0
