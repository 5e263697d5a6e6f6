"""Skeleton commands on masks and label images: what they read, and what they refuse."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import vorotool
from vorotool.engines.features import batches as feature_sheets
from vorotool.engines.features.batches import Features, batches_of

DATA = Path(__file__).parents[3] / "data"
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
    counts = {str(label): float(np.count_nonzero(labels_of_cells() == label)) for label in range(1, 25)}
    table = run(f"skeleton-exact {CELLS} --what table").rows
    assert {row["id"]: float(row["area"]) for row in table} == counts
    parts = run(f"skeleton-exact {CELLS} --what parts -f csv --verify").rows
    assert sum(float(row["area"]) for row in parts) == pytest.approx(sum(counts.values()))


def labels_of_cells():
    return np.asarray(Image.open(CELLS))


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
