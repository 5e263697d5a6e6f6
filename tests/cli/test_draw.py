"""``vorotool draw``."""

import re

import numpy as np
import pytest
from PIL import Image


def test_the_picture_is_that_of_tessellate(run, folder):
    assert run("tessellate", "dots.csv", "-o", "labels.png").code == 0
    assert run("tessellate", "dots.csv", "--what", "colour", "--layers", "cells", "-o", "a.png").code == 0
    assert run("draw", "labels.png", "-o", "b.png").code == 0
    assert (folder / "a.png").read_bytes() == (folder / "b.png").read_bytes()


def test_svg_and_layers(run, folder):
    np.save(folder / "labels.npy", np.array([[1, 1, 2], [3, 3, 2]], dtype=np.uint16))
    done = run("draw", "labels.npy", "-f", "svg")
    assert done.code == 0
    assert "</svg>" in done.out
    assert run("draw", "labels.npy", "--layers", "diagram", "-o", "lines.png").code == 0
    lines = np.asarray(Image.open(folder / "lines.png").convert("L"))
    assert (lines == 0).tolist() == [[True, True, False], [False, False, True]]


def test_what_is_no_label_image_is_refused(run, folder):
    done = run("draw", "dots.csv", "-o", "a.png")
    assert done.code == 3
    assert "dots.csv" in done.err
    assert run("draw", "labels.png").code == 2


@pytest.mark.parametrize("extension", ["png", "svg"])
def test_sparse_labels_have_the_colours_of_dense_ones(run, folder, extension):
    dense = np.kron(np.arange(12, dtype=np.uint32).reshape(3, 4), np.ones((20, 30), np.uint32))
    np.save(folder / "dense.npy", dense)
    np.save(folder / "sparse.npy", dense * np.uint32(390_000_000))
    for name in ("dense", "sparse"):
        done = run("draw", f"{name}.npy", "-o", f"{name}.{extension}", "--layers", "cells")
        assert done.code == 0, done.err
    drawn = [(folder / f"{name}.{extension}").read_text("latin-1") for name in ("dense", "sparse")]
    assert re.sub('id="cell-[0-9]+"', "", drawn[0]) == re.sub('id="cell-[0-9]+"', "", drawn[1])
    done = run("tessellate", "sparse.npy", "--seeds", "labels", "--what", "colour", "-o", f"c.{extension}")
    assert done.code == 0, done.err
