"""``vorotool delaunay``: every result, every kind of input, and what is said when something is wrong."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapely
from PIL import Image

import vorotool
from support.readers.written import rows_of

DATA = Path(__file__).parents[3] / "data"
DOTS = DATA / "dots.csv"
MESH = vorotool.delaunay(vorotool.read(DOTS))


def pairs(text):
    return [(int(row["label_a"]), int(row["label_b"])) for row in rows_of(text)]


def test_edges_go_to_standard_output(run):
    done = run("delaunay", DOTS, "--verify")
    assert (done.code, done.err) == (0, "")
    header, first, *rest = done.out.splitlines()
    assert header == "label_a,label_b,x_a,y_a,x_b,y_b,length"
    assert len(rest) == len(MESH.edges) - 1
    assert pairs(done.out) == [tuple(edge) for edge in (MESH.edges + 1).tolist()]
    a, b, *numbers = map(float, first.split(","))
    ends = MESH.points[[int(a) - 1, int(b) - 1]]
    assert numbers == [*ends.reshape(-1).tolist(), np.sqrt(((ends[0] - ends[1]) ** 2).sum())]


POINTS = [[2, 1], [7, 5], [1, 6], [9, 9.5]]
INPUTS = {
    "a.csv": b"x,y\n2,1\n7,5\n1,6\n9,9.5\n",
    "a.tsv": b"2\t1\n7\t5\n1\t6\n9\t9.5\n",
    "a.json": b"[[2, 1], [7, 5], [1, 6], [9, 9.5]]",
    "a.node": b"4 2 0 0\n1 2 1\n2 7 5\n3 1 6\n4 9 9.5\n",
    "a.wkt": shapely.MultiPoint(POINTS).wkt.encode(),
    "a.geojson": shapely.to_geojson(shapely.MultiPoint(POINTS)).encode(),
}


@pytest.mark.parametrize("name", INPUTS)
def test_all_point_formats_are_read(run, folder, name):
    (folder / name).write_bytes(INPUTS[name])
    np.save(folder / "a.npy", np.array(POINTS))
    expected = run("delaunay", "a.npy").out
    assert run("delaunay", name).out == expected
    assert len(expected.splitlines()) == 6


def test_standard_input_and_columns(run, process, folder):
    child = process("delaunay", "-", "--columns", "3,1", stdin=-1)
    out, err = child.communicate(b"1,a,2\n5,b,7\n6,c,1\n9.5,d,9\n")
    np.save(folder / "a.npy", np.array(POINTS))
    expected = run("delaunay", "a.npy").out
    assert (out.decode(), err) == (expected, b"")


def test_labels_of_the_input_are_kept(run, folder):
    (folder / "own.csv").write_text("x,y,label\n2,1,70\n7,5,4\n1,6,70000\n")
    done = run("delaunay", "own.csv", "--what", "triangles")
    assert done.out == "label_a,label_b,label_c\n70,4,70000\n"
    assert {frozenset(edge) for edge in pairs(run("delaunay", "own.csv").out)} == {
        frozenset(edge) for edge in [(70, 4), (4, 70000), (70000, 70)]
    }


def test_regions_of_images_count_as_their_centroids(run, folder):
    labels = np.zeros((20, 30), np.uint16)
    labels[2:5, 3:6], labels[10, 10:12], labels[15:, 20:] = 300, 7, 12
    np.save(folder / "labels.npy", labels)
    for seeds in ([], ["--seeds", "labels"], ["--seeds", "centroids"]):
        done = run("delaunay", "labels.npy", "--what", "table", *seeds)
        found = [(int(row["label"]), float(row["x"]), float(row["y"])) for row in done.rows]
        assert found == [(7, 10.5, 10), (12, 24.5, 17), (300, 4, 3)]
        assert done.err == ""  # nothing is put on a lattice
    assert len(run("delaunay", "mask.pbm", "--what", "table").rows) == 2
    assert len(run("delaunay", "mask.pbm", "--what", "table", "--connectivity", "4").rows) == 3
    assert len(run("delaunay", "mask.pbm", "--what", "table", "--seeds", "pixels").rows) == 4


def test_properties_go_to_the_table(run, folder):
    done = run("delaunay", "dots.csv", "--columns", "x,y", "--what", "table")
    assert [row["name"] for row in done.rows] == ["a", "b", "c"]
    assert "name" not in run("delaunay", "dots.csv", "--columns", "x,y", "--what", "table", "--no-properties").out
    assert "name" not in run("delaunay", "dots.csv", "--columns", "x,y").out


def test_geojson_keeps_its_crs_and_is_drawn_upwards(run, folder):
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2056"}}
    features = [{"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": p}} for p in POINTS]
    (folder / "a.geojson").write_text(json.dumps({"type": "FeatureCollection", "crs": crs, "features": features}))
    (folder / "a.json").write_text(json.dumps(POINTS))
    assert json.loads(run("delaunay", "a.geojson", "-f", "geojson").out)["crs"] == crs
    up = run("delaunay", "a.geojson", "-f", "svg").out
    assert up == run("delaunay", "a.json", "-f", "svg", "--y-up").out
    assert run("delaunay", "a.json", "-f", "svg").out != up


def test_files_of_triangle_belong_together(run, folder):
    (folder / "zero.node").write_text("4 2 0 0\n0 0 0\n1 4 0\n2 0 3\n3 1 1\n")
    done = run("delaunay", "zero.node", "--what", "edges,triangles,table", "-f", "ele", "-o", "mesh")
    assert done.code == 0, done.err
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
    done = run("delaunay", "zero.node", "-o", "a.ele")
    assert done.code == 2
    assert "--what" in done.err


def test_stats(run, folder):
    (folder / "twice.csv").write_text("x,y\n1,1\n1,1\n4.1,2\n9,0\n5,1\n")
    done = run("delaunay", "twice.csv", "-o", "a.csv", "--stats", "-", "--verify")
    stats = json.loads(done.out)
    expected = {"points": 5, "duplicates": 1, "edges": 6, "triangles": 3, "hull": 3, "collinear": False}
    assert {name: stats[name] for name in expected} == expected
    assert {"read", "triangulate", "verify", "write edges"} <= set(stats["seconds"])
    (warning,) = stats["warnings"]
    assert "1 of 5 points lie on an earlier point" in warning
    assert done.err == f"warning: {warning}\n"
    assert run("delaunay", "twice.csv", "-o", "a.csv", "-q").err == ""


def test_verify_notices_a_wrong_triangulation(run, monkeypatch):
    from dataclasses import replace

    monkeypatch.setattr(
        "vorotool.jobs.triangulation.delaunay", lambda *_, **__: replace(MESH, triangles=MESH.triangles[:, ::-1])
    )
    assert run("delaunay", DOTS).code == 0
    done = run("delaunay", DOTS, "--verify")
    assert (done.code, done.out) == (1, "")
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
    done = run("delaunay", "few.csv", "--verify")
    assert done.code == 0, done.err
    assert set(pairs(done.out)) == set(edges)
    assert all(word in done.err for word in words)
    assert len(done.err.splitlines()) == len(words)
    done = run("delaunay", "few.csv", "--what", "triangles", "--stats", "s.json", "-o", "a.csv")
    assert (folder / "a.csv").read_text() == "label_a,label_b,label_c\n"
    assert ("warning: the result has no triangles: " in done.err) == ("," in text.replace("x,y", ""))
    assert json.loads((folder / "s.json").read_text())["collinear"] is True
    for fmt in ("svg", "png", "obj", "geojson", "npz"):
        picture = ("--width", 90) if fmt == "png" else ()
        assert run("delaunay", "few.csv", "-o", f"few.{fmt}", "-q", *picture).code == 0


def test_an_image_without_foreground_has_no_points(run, folder):
    (folder / "black.pbm").write_text("P1 3 2 0 0 0 0 0 0")
    done = run("delaunay", "black.pbm")
    assert (done.code, done.out.count("\n")) == (0, 1)
    assert (done.err[:9], "--invert" in done.err) == ("warning: ", True)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--what", "faces"], "'faces'"),
        (["-f", "tiff"], "edges cannot be written as tiff: use one of csv"),
        (["-f", "npz"], None),  # binary to a pipe
        (["--what", "edges,triangles"], "several results need -o STEM"),
        (["--layers", "cellar", "-f", "svg"], "not one of cells, triangles, diagram, edges, points, labels"),
        (["--precision", "3", "-o", "a.npz"], "--precision"),
        (["--precision", "0"], "precision"),
        (["--seeds", "pixels", "--connectivity", "4"], "--connectivity"),
        (["-o", "dots.csv"], "is also an input"),
    ],
)
def test_bad_options(run, folder, options, words):
    before = sorted(folder.iterdir())
    done = run("delaunay", "dots.csv", *options)
    assert done.code == (0 if words is None else 2), done.err
    assert words is None or words in done.err
    assert sorted(folder.iterdir()) == before


def test_options_for_points_are_refused_with_images(run, folder):
    done = run("delaunay", "mask.pbm", "--columns", "1,2")
    assert (done.code, "but the input is an image" in done.err) == (2, True)


def test_limits(run, folder):
    assert run("delaunay", "dots.csv", "--max-sites", "3").code == 0
    done = run("delaunay", "dots.csv", "--max-sites", "2")
    assert done.code == 5
    assert "--max-sites" in done.err
    done = run("delaunay", "dots.csv", "-o", "a.png", "--width", "100000")
    assert done.code == 5
    assert "--width" in done.err
    assert run("delaunay", "dots.csv", "-o", "a.svg", "--width", "100000").code == 0


def test_strict_refuses_duplicates(run, folder):
    (folder / "twice.csv").write_text("x,y\n1,2\n1,2\n")
    done = run("delaunay", "twice.csv", "--strict")
    assert (done.code, done.out) == (3, "")
    assert "twice.csv" in done.err


def test_pictures(run, folder):
    assert run("delaunay", DOTS, "--what", "triangles", "-o", "t.png", "--width", "300").code == 0
    with Image.open(folder / "t.png") as image:
        assert (image.mode, image.width) == ("RGB", 300)
    done = run("delaunay", DOTS, "-f", "svg")
    assert '<g id="edges"' in done.out
    assert '<g id="points"' in done.out
    assert done.out.count("<circle") == 53
    done = run("delaunay", DOTS, "-f", "svg", "--layers", "labels,triangles", "--width", "500")
    assert 'width="500"' in done.out
    assert done.out.index('<g id="triangles"') < done.out.index('<g id="labels"')
    assert "circle" not in done.out
    assert done.out.count("</text>") == 53
