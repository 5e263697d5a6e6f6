"""`skeleton-exact --what necks` and `--what parts`: their outputs, and which options go with them."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

DATA = Path(__file__).parents[3] / "data"
SHAPES, CELLS = DATA / "two-shapes.json", DATA / "cells.png"


def test_areas_of_masks_sum_to_their_pixels(run):
    done = run(f"skeleton-exact {CELLS} --what parts -f csv --verify --stats stats.json")
    pixels = np.count_nonzero(np.asarray(Image.open(CELLS)))
    assert sum(float(row["area"]) for row in done.rows) == pytest.approx(pixels)


def test_statistics_count(run, folder):
    options = ("--what", "necks,parts", "--neck", "1", "-o", "made.csv", "-f", "csv", "--stats", "stats.json")
    run(f"skeleton-exact {SHAPES}", *options)
    found = json.loads((folder / "stats.json").read_text())
    assert {name: found[name] for name in ("necks", "neck", "pieces", "cuts")} == {
        "necks": 6,
        "neck": 1.0,
        "pieces": 7,
        "cuts": 6,
    }
