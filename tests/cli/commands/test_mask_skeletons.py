"""Skeleton commands on masks and label images: what they read, and what they refuse."""

import json
from pathlib import Path

import numpy as np
import pytest
import tifffile
from PIL import Image

import vorotool
from vorotool.engines.features import batches as feature_sheets
from vorotool.engines.features.batches import Features, batches_of

DATA = Path(__file__).parents[3] / "data"
BLOBS, CELLS = DATA / "blobs.png", DATA / "cells.png"
WHOLE = ("--prune", "none")


def test_a_mask_has_a_skeleton(run, folder):
    done = run("skeleton-exact", BLOBS, *WHOLE, "--verify", "-o", "a.npz", "--stats", "-")
    assert (done.code, done.err) == (0, "")
    stats = json.loads(done.out)
    assert (stats["polygons"], stats["outline"], stats["connectivity"]) == (24, "crack", 8)
    expected = vorotool.skeleton_exact(vorotool.outlines(vorotool.read(BLOBS)))
    assert np.array_equal(np.load(folder / "a.npz")["vertex_r"], expected.radius)


@pytest.mark.parametrize("what", ["skeleton", "branches", "table", "centerline", "shape"])
def test_batches_of_objects_give_the_same_bytes(run, monkeypatch, what):
    """These objects do not touch: in one diagram they are the same as in one a batch."""
    monkeypatch.setattr(feature_sheets, "BATCH", 60)
    fmt = "csv" if what in ("branches", "table") else "geojson"
    command = ("skeleton-exact", BLOBS, *WHOLE, "--what", what, "-f", fmt)
    made, whole = run(*command), run(*command, "--features", "together")
    assert (made.code, made.err, made.out) == (0, "", whole.out)
    features = Features.of(vorotool.outlines(vorotool.read(BLOBS)))
    assert len(batches_of(features, np.zeros(len(features), dtype=np.int32))) > 5


def test_a_label_image_has_an_object_a_label(run):
    table = run("skeleton-exact", CELLS, "--what", "table").rows
    labels = np.asarray(Image.open(CELLS))
    assert [(row["id"], float(row["area"])) for row in table] == [
        (str(label), float(np.count_nonzero(labels == label))) for label in range(1, 25)
    ]


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
    done = run("skeleton-exact", "a.png", *WHOLE, *arguments, "-f", "csv", "--verify")
    said = "note: threshold 0, by Otsu's method\n" if name == "otsu" else ""
    assert (done.code, done.err) == (0, said)
    made = vorotool.skeleton_exact(vorotool.outlines(image, **expected))
    assert [float(row["r0"]) for row in done.rows] == made.radius[made.arcs[:, 0]].tolist()


def test_simplify_is_for_polygons_too(run):
    counts = []
    for more in ([], ["--simplify", "0.05"]):
        done = run("skeleton-exact", DATA / "great-lakes.geojson", *more, "-q", "-o", "a.json", "--stats", "s.json")
        assert done.code == 0
        counts.append(json.loads(Path("s.json").read_text())["vertices"])
    assert counts[1] < counts[0] / 4


def test_a_page_of_a_stack(run, folder):
    pages = np.zeros((2, 5, 6), dtype=np.uint8)
    pages[1, 1:4, 1:5] = 1
    tifffile.imwrite(folder / "a.tif", pages, photometric="minisblack")
    assert "--page 1" in run("skeleton-exact", "a.tif").err
    done = run("skeleton-exact", "a.tif", "--page", "1", "--what", "table")
    assert [row["area"] for row in done.rows] == ["12"]


def test_nothing_in_the_foreground(run, folder):
    Image.new("1", (5, 4)).save(folder / "a.png")
    done = run("skeleton-exact", "a.png", *WHOLE, "-f", "csv")
    assert (done.code, len(done.rows)) == (0, 0)
    assert "--invert" in done.err
    assert len(run("skeleton-exact", "a.png", *WHOLE, "--invert", "-f", "csv").rows) == 5


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ((DATA / "two-shapes.json", "--outline", "crack"), 2, "--outline"),
        ((DATA / "two-shapes.json", "--threshold", "3"), 2, "--threshold"),
        ((BLOBS, "--seeds", "pixels"), 2, "'pixels'"),
        ((BLOBS, "--simplify", "0"), 2, "expected more than 0"),
        ((BLOBS, "--max-sites", "100"), 5, "--max-sites 100"),
        ((BLOBS, "--max-pixels", "100"), 5, "--max-pixels"),
        (("noise.png",), 3, "noise.png"),
        (("color.png",), 3, "color.png"),
        ((BLOBS, "--page", "3"), 3, "--page 3"),
    ],
)
def test_what_is_refused(run, folder, arguments, code, words):
    random = np.random.default_rng(0)
    Image.fromarray(random.integers(0, 256, (64, 64), dtype=np.uint8)).save(folder / "noise.png")
    Image.fromarray(random.integers(0, 256, (8, 8, 3), dtype=np.uint8)).save(folder / "color.png")
    done = run("skeleton-exact", *arguments, "-o", "out.json")
    assert done.code == code
    assert words in done.err
    assert not (folder / "out.json").exists()


def test_json_tells_the_connectivity(run, folder):
    Image.fromarray(np.eye(3, dtype=np.uint8)).save(folder / "a.png")
    assert run("skeleton-exact", "a.png", *WHOLE, "-o", "a.json").code == 0
    assert json.loads((folder / "a.json").read_text())["connectivity"] == 8
    again = vorotool.read(folder / "a.json")
    assert again.polygons.connectivity == 8
    vorotool.verify_skeleton(again)
    text = (folder / "a.json").read_text().replace('"connectivity":8', '"connectivity":[5]')
    (folder / "a.json").write_text(text)
    assert "[5]" in run("draw", "a.json", "-o", "a.svg").err
