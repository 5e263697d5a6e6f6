"""`skeleton-exact --what necks` and `--what parts`: their outputs, and which options go with them."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapely
from PIL import Image

import vorotool

DATA = Path(__file__).parents[3] / "data"
SHAPES, CELLS = DATA / "two-shapes.json", DATA / "cells.png"


def test_cuts_are_lines(run):
    expected = vorotool.necks(vorotool.read(SHAPES))
    found = json.loads(run("skeleton-exact", SHAPES, "--what", "necks", "-f", "geojson").out)["features"]
    lines = [shapely.geometry.shape(each["geometry"]) for each in found]
    assert [line.length for line in lines] == pytest.approx(expected.width.tolist())
    assert [each["properties"]["r_smaller"] for each in found] == expected.beside[:, 0].tolist()
    done = run("skeleton-exact", SHAPES, "--what", "necks", "-f", "wkt")
    assert [shapely.from_wkt(text).length for text in done.out.splitlines()] == pytest.approx(expected.width.tolist())


def test_areas_of_masks_sum_to_their_pixels(run):
    done = run("skeleton-exact", CELLS, "--what", "parts", "-f", "csv", "--verify", "--stats", "stats.json")
    pixels = np.count_nonzero(np.asarray(Image.open(CELLS)))
    assert sum(float(row["area"]) for row in done.rows) == pytest.approx(pixels)


def test_statistics_count(run, folder):
    options = ("--what", "necks,parts", "--neck", "1", "-o", "made.csv", "-f", "csv", "--stats", "stats.json")
    assert run("skeleton-exact", SHAPES, *options).code == 0
    found = json.loads((folder / "stats.json").read_text())
    assert {name: found[name] for name in ("necks", "neck", "pieces", "cuts")} == {
        "necks": 6,
        "neck": 1.0,
        "pieces": 7,
        "cuts": 6,
    }


def test_pictures_have_colors_that_differ_along_cuts(run, folder):
    done = run("skeleton-exact", SHAPES, "--what", "parts", "--neck", "1", "-f", "svg", "--layers", "parts,cuts,labels")
    assert done.code == 0
    assert all(f'<g id="{name}"' in done.out for name in ("parts", "cuts", "labels"))
    assert run("skeleton-exact", SHAPES, "--what", "necks", "-o", "necks.png").code == 0
    pixels = np.asarray(Image.open(folder / "necks.png").convert("RGB")).reshape(-1, 3)
    assert (pixels == (0xAA, 0x33, 0x44)).all(axis=1).sum() > 100
