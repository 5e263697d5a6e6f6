"""Masks, label images and images without foreground on the command line; frames that nobody gave."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import vorotool
from support.documents import DATA
from support.readers.written import rows_of
from vorotool.engines.features import batches as feature_sheets
from vorotool.engines.features.batches import Features, batches_of

NO_FOREGROUND = "warning: the image has no foreground: use --invert or --threshold"


@pytest.fixture
def fields(folder):
    """Images of one label, of two, and of none."""
    two = np.zeros((20, 30), np.uint16)
    two[2:5, 3:8] = 7
    two[12:15, 20:24] = 7
    np.save(folder / "empty.npy", 0 * two)
    np.save(folder / "one.npy", two)
    two[8:10, 10:14] = 9
    np.save(folder / "two.npy", two)
    return folder


def labels_of(done):
    return [row["label"] for row in done.rows]


def test_the_only_label_of_a_field_stays(run, fields):
    done = run("tessellate one.npy --what table")
    assert labels_of(done) == ["7"]
    note = "note: 7 is the only value besides 0, and read as a label: for a mask use --seeds components\n"
    assert done.err == note
    assert labels_of(run("tessellate two.npy --what table")) == ["7", "9"]
    done = run("tessellate one.npy --what table --seeds components")
    assert (labels_of(done), done.err) == (["1", "2"], "")
    for command, column in (("delaunay", "label"), ("skeleton-exact", "id")):
        done = run(command, "one.npy", "--what", "table", "--seeds", "labels")
        known = {row[column] for row in done.rows}
        again = run(command, "one.npy", "--what", "table")
        assert (known, again.out, note in again.err) == ({"7"}, done.out, True)


def test_a_batch_of_fields_goes_on_without_foreground(run, fields):
    names = ["empty.npy", "one.npy", "two.npy"]
    done = run("tessellate", *names, "--out-dir", "out", "-f", "npy", "--table", "all.csv")
    assert f"warning: empty.npy: {NO_FOREGROUND.removeprefix('warning: ')}" in done.err.splitlines()
    assert not np.load(fields / "out/empty.npy").any()
    rows = rows_of((fields / "all.csv").read_text())
    assert [(row["input"], row["label"]) for row in rows] == [("one.npy", "7"), ("two.npy", "7"), ("two.npy", "9")]
    run("tessellate", *names, "--out-dir", "strict", "-f", "npy", "--strict", "--keep-going", code=6)


@pytest.mark.parametrize("what", ["distance", "distance2", "labels,distance"])
def test_distances_to_nothing_do_not_exist(run, fields, what):
    words = "error: empty.npy: the image has no foreground"
    run(f"tessellate empty.npy --what {what} --out-dir out -f npy", code=3, says=words)
    assert not list(fields.rglob("out/*.npy"))


@pytest.mark.parametrize(
    "arguments",
    [
        "delaunay --what cells -f geojson",
        "alphashape -r 4 --verify",
        "alphashape --what curves",
        "alphashape -f html -o page.html",
        "skeleton-exact --what table --verify",
        "skeleton-exact --what centerline",
        "skeleton-approx --step 1 --verify",
    ],
)
def test_what_follows_from_an_image_without_foreground_is_empty(run, fields, arguments):
    lines = run(f"{arguments} empty.npy --stats stats.json").err.splitlines()
    assert lines[0] == NO_FOREGROUND
    assert all(line.startswith("warning: ") for line in lines)
    assert lines[0].removeprefix("warning: ") in json.loads((fields / "stats.json").read_text())["warnings"]
    run(f"{arguments} empty.npy --strict", code=3, says="the image has no foreground")


# ---- few objects ----------------------------------------
ONE = "an alpha shape needs at least two distinct points, but got 1 point"
TWO = "two points span no triangle, so no radius gives a region that holds all points: give r itself (-r)"
LINE = "3 points on a line span no triangle, so no radius gives a region that holds all points: give r itself (-r)"
COLLECTION = {"type": "FeatureCollection", "y_axis": "down", "features": []}


@pytest.fixture
def fields_of_few_objects(folder):
    """Masks of one object, of two, of three in a row, and of three that span a triangle; flat images."""
    mask = np.zeros((24, 30), np.uint8)
    for name, x, y in (("one", 4, 3), ("two", 12, 3), ("line", 20, 3)):
        mask[y : y + 3, x : x + 2] = 255
        np.save(folder / f"{name}.npy", mask)
    mask[15:18, 4:6] = 255
    np.save(folder / "many.npy", mask)
    for value in (0, 93, 255):
        np.save(folder / f"flat{value}.npy", np.full((8, 9), value, np.uint8))
    return folder


def test_a_batch_of_fields_with_few_objects_goes_on(run, fields_of_few_objects):
    names = ["one.npy", "two.npy", "line.npy", "many.npy"]
    done = run("alphashape", *names, "--out-dir", "out", "-f", "geojson", "--table", "all.csv", "--verify")
    lines = done.err.splitlines()
    for name, reason in zip(names, (ONE, TWO, LINE), strict=False):
        assert any(line.startswith(f"warning: {name}: {reason}") for line in lines)
        assert json.loads((fields_of_few_objects / "out" / name).with_suffix(".geojson").read_text()) == COLLECTION
    assert len(json.loads((fields_of_few_objects / "out/many.geojson").read_text())["features"]) == 1
    assert [row["input"] for row in rows_of((fields_of_few_objects / "all.csv").read_text())] == ["many.npy"]
    done = run("alphashape", *names, "--out-dir", "strict", "--strict", "--keep-going", code=6)
    for name, reason in zip(names, (ONE, TWO, LINE), strict=False):
        assert any(line.startswith(f"error: {name}: {reason}") for line in done.err.splitlines())


@pytest.mark.parametrize(
    ("options", "name", "reason"),
    [
        *(((), name, reason) for name, reason in (("one.npy", ONE), ("two.npy", TWO), ("line.npy", LINE))),
        *((("-f", fmt), "two.npy", TWO) for fmt in ("npz", "svg", "html")),
        (("--what", "hull"), "one.npy", ONE),
        (("--what", "polygons", "-f", "wkt"), "line.npy", LINE),
        (("--method", "digital-valid", "--seeds", "centroids"), "line.npy", LINE),
    ],
)
def test_every_output_of_an_empty_shape_is_written(run, fields_of_few_objects, name, reason, options):
    fmt = () if "-f" in options else ("-f", "geojson" if "hull" in options else "csv")
    run(f"alphashape {name} --verify --stats stats.json -o shape", *options, *fmt, says=reason)
    stats = json.loads((fields_of_few_objects / "stats.json").read_text())
    assert (stats["r"], stats["alpha"], stats["boundary_edges"], stats["singular_edges"]) == (None, None, 0, 0)
    assert (fields_of_few_objects / "shape").stat().st_size > 0 or "wkt" in options  # which has nothing to say


@pytest.mark.parametrize(
    ("command", "value", "invert"),
    [
        *((("delaunay",), value, invert) for value, invert in ((0, ()), (93, ("--invert",)), (255, ()))),
        (("tessellate", "--what", "table"), 0, ()),
        (("tessellate", "-f", "text"), 93, ()),
        (("skeleton-exact", "--outline", "contour", "--what", "table"), 93, ("--invert",)),
        (("skeleton-approx", "--step", "1", "-f", "geojson"), 0, ()),
    ],
)
def test_a_flat_image_has_no_foreground_by_otsu(run, fields_of_few_objects, command, value, invert):
    options = (f"flat{value}.npy", "--threshold", "otsu", *invert)
    done = run(*command, *options, "--verify", "--stats", "stats.json")
    note, warning = done.err.splitlines()
    assert (note.startswith("note: "), f"value {value}" in note) == (True, True)
    assert warning.startswith("warning: ")
    assert json.loads((fields_of_few_objects / "stats.json").read_text())["threshold"] is None
    assert set(done.out.split()) == {"0"} or len(done.out.splitlines()) < 7
    assert run(*command, *options, "--strict", code=3).err.count("error: ") == 1


# ---- masks of skeletons ----------------------------------------
BLOBS, CELLS = DATA / "blobs.png", DATA / "cells.png"
WHOLE = ("--prune", "none")


@pytest.mark.parametrize("what", ["branches", "shape"])
def test_batches_of_objects_give_the_same_bytes(run, monkeypatch, what):
    """These objects do not touch: in one diagram they are the same as in one a batch."""
    monkeypatch.setattr(feature_sheets, "BATCH", 60)
    fmt = "csv" if what in ("branches", "table") else "geojson"
    command = ("skeleton-exact", BLOBS, *WHOLE, "--what", what, "-f", fmt)
    made, whole = run(*command), run(*command, "--features", "together")
    assert (made.err, made.out) == ("", whole.out)
    features = Features.of(vorotool.outlines(vorotool.read(BLOBS)))
    assert len(batches_of(features, np.zeros(len(features), dtype=np.int32))) > 5


def test_a_label_image_has_an_object_a_label(run):
    counts = {str(k): float(n) for k, n in enumerate(np.bincount(np.asarray(Image.open(CELLS)).ravel())) if k}
    assert {row["id"]: float(row["area"]) for row in run(f"skeleton-exact {CELLS} --what table").rows} == counts
    parts = run(f"skeleton-exact {CELLS} --what parts -f csv --verify").rows
    assert sum(float(row["area"]) for row in parts) == pytest.approx(sum(counts.values()))


OPTIONS = {
    "contour": ({"--outline": "contour"}, {"outline": "contour"}),
    "four": ({"--connectivity": "4"}, {"connectivity": 4}),
    "simplify": ({"--simplify": "0.75"}, {"simplify": 0.75}),
    "threshold": ({"--threshold": "0.5"}, {"threshold": 0.5}),
    "otsu": ({"--threshold": "otsu", "--outline": "contour"}, {"threshold": "otsu", "outline": "contour"}),
    "labels": ({"--seeds": "labels"}, {"mode": "labels"}),
    "components": ({"--seeds": "components"}, {"mode": "components"}),
    "invert": ({"--invert": None}, {"invert": True}),
}


@pytest.mark.parametrize("name", OPTIONS)
def test_options_are_those_of_the_library(run, folder, name):
    random = np.random.default_rng(1)
    image = np.kron(random.integers(0, 2, (6, 8)), np.ones((3, 3))).astype(np.uint8)
    Image.fromarray(image).save(folder / "a.png")
    given, expected = OPTIONS[name]
    arguments = [part for pair in given.items() for part in pair if part is not None]
    done = run("skeleton-exact a.png", *WHOLE, *arguments, "-f", "csv", "--verify")
    said = "note: threshold 0, by Otsu's method\n" if name == "otsu" else ""
    assert done.err == said
    made = vorotool.skeleton_exact(vorotool.outlines(image, **expected))
    assert [float(row["r0"]) for row in done.rows] == made.radius[made.arcs[:, 0]].tolist()


def test_simplify_is_for_polygons_too(run):
    counts = []
    for more in ([], ["--simplify", "0.05"]):
        run(f"skeleton-exact {DATA}/great-lakes.geojson", *more, "-q", "-o", "a.json", "--stats", "s.json")
        counts.append(json.loads(Path("s.json").read_text())["vertices"])
    assert counts[1] < counts[0] / 4


def test_json_tells_the_connectivity(run, folder):
    Image.fromarray(np.eye(3, dtype=np.uint8)).save(folder / "a.png")
    run("skeleton-exact a.png", *WHOLE, "-o", "a.json")
    assert json.loads((folder / "a.json").read_text())["connectivity"] == 8
    again = vorotool.read(folder / "a.json")
    assert again.polygons.connectivity == 8
    vorotool.verify_skeleton(again)
    text = (folder / "a.json").read_text().replace('"connectivity":8', '"connectivity":[5]')
    (folder / "a.json").write_text(text)
    run("draw a.json -o a.svg", code=3, says="[5]")
