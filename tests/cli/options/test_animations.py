"""``--animate``, ``--frames``, ``--fps``: each frame is the picture that a run of its own draws."""

from fractions import Fraction
from math import isqrt

import numpy as np
import pytest
from PIL import Image, ImageSequence

import vorotool


@pytest.fixture
def folder(tmp_path):
    rng = np.random.default_rng(7)
    np.savetxt(tmp_path / "dots.csv", rng.integers(0, 60, (12, 2)), fmt="%d", delimiter=",")
    return tmp_path


def frames_of(path):
    """Frames, each as often as its time says."""
    with Image.open(path) as image:
        frames = ImageSequence.Iterator(image)
        found = [(np.asarray(frame.convert("RGB")), frame.info.get("duration")) for frame in frames]
    shortest = min((time for _, time in found if time), default=None)
    return [pixels for pixels, time in found for _ in range(round(time / shortest) if time else 1)]


def pixels(path):
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


@pytest.mark.parametrize("fmt", ["gif", "apng", "webp"])
def test_cells_grow(run, folder, fmt):
    style = ["--size", "60x60", "--what", "color", "--line-width", "cells=0"]
    run("tessellate dots.csv", *style, "-o", f"out.{fmt}", "--frames", "5", "--fps", "4")
    found = frames_of(f"out.{fmt}")
    assert len(found) == 5
    points = np.loadtxt("dots.csv", delimiter=",")
    y, x = np.mgrid[:60, :60]
    squares = np.min((x[..., None] - points[:, 0]) ** 2 + (y[..., None] - points[:, 1]) ** 2, axis=2).astype(int)
    farthest = isqrt(squares.max()) + 1
    run("tessellate dots.csv", *style, "-o", "whole.png")
    whole, seeds = pixels("whole.png"), found[0]
    for number, frame in enumerate(found):
        reached = squares <= (Fraction(number, 4) * farthest) ** 2
        is_seed = (seeds != 255).any(axis=2)
        np.testing.assert_array_equal(frame, np.where((reached | is_seed)[..., None], whole, 255))


def test_what_animate_stands_for(run, folder):
    command = ["tessellate", "dots.csv", "--size", "20x20", "--what", "color", "--animate", "--frames", "2"]
    for name, kind in (("a.gif", b"GIF89a"), ("a.png", b"\x89PNG"), ("a.webp", b"RIFF"), ("a", b"GIF89a")):
        run(*command, "-o", name)
        assert (folder / name).read_bytes().startswith(kind)
    assert b"acTL" in (folder / "a.png").read_bytes()
    run(*command, "--out-dir", "out")
    assert [path.name for path in (folder / "out").iterdir()] == ["dots.gif"]


def test_many_colors_share_a_palette(run, folder):
    rng = np.random.default_rng(1)
    Image.fromarray(rng.integers(0, 256, (60, 60, 3), dtype=np.uint8)).save("photo.png")
    style = ["--size", "60x60", "--what", "color", "--layers", "seeds", "--overlay", "photo.png"]
    run("tessellate dots.csv", *style, "-o", "out.gif", "--frames", "2")
    difference = np.abs(frames_of("out.gif")[0].astype(int) - pixels("photo.png"))
    assert difference.mean() < 40  # 256 colors for 3600


def test_the_library_has_none():
    with pytest.raises(vorotool.UsageError, match="'gif'"):
        vorotool.write(vorotool.tessellate([[1, 1]], shape=(3, 3)), "a.gif", what="color")
