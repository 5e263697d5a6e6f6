"""Scans of ink, and masks that need cleaning: ``--invert``, ``--min-area``, ``--fill-holes`` in all commands."""

import json

import numpy as np
import pytest
import tifffile
from PIL import Image

RNG = np.random.default_rng(8)
INK = np.zeros((60, 90), bool)
INK[10:30, 10:40] = INK[40:50, 50:80] = True
INK[15:20, 20:30] = False
SPECKS = INK.copy()
SPECKS[3, 5] = SPECKS[55, 10] = SPECKS[17, 25] = True
CLEAN = INK.copy()
CLEAN[15:20, 20:30] = True


@pytest.fixture
def scans(tmp_path):
    noise = RNG.normal(0, 5, INK.shape)
    grey = (np.where(SPECKS, 40, 225) + noise).clip(0, 255).astype(np.uint8)
    Image.fromarray(grey).save(tmp_path / "scan.jpg", quality=97)
    Image.fromarray(grey).save(tmp_path / "scan.png")
    Image.fromarray(np.dstack([grey, grey, grey // 2])).save(tmp_path / "colour.png")
    Image.fromarray(255 - grey).save(tmp_path / "dark.png")
    for name, mask in (("ink", INK), ("specks", SPECKS), ("clean", CLEAN)):
        tifffile.imwrite(tmp_path / f"{name}.tif", mask.astype(np.uint8) * 255)
    return tmp_path


@pytest.mark.parametrize("name", ["scan.jpg", "scan.png", "colour.png"])
def test_messages_say_what_makes_a_mask_of_a_scan(run, scans, name):
    done = run("tessellate", name, "-o", "a.png")
    assert (done.code, "--threshold otsu --invert (most of it is light)" in done.err) == (3, True)
    done = run("tessellate", name, "-o", "a.png", "--threshold", "otsu")
    assert done.code == 0
    assert "of the image is brighter than that, and foreground: --invert takes what is dark" in done.err
    done = run("tessellate", name, "-o", "a.png", "--threshold", "otsu", "--invert")
    assert (done.code, "brighter" in done.err) == (0, False)


def test_dark_images_are_told_nothing_of_it(run, scans):
    assert "--invert" not in run("tessellate", "dark.png", "-o", "a.png").err
    assert "--invert" not in run("tessellate", "dark.png", "-o", "a.png", "--threshold", "otsu").err


COMMANDS = [
    "tessellate -f npy",
    "tessellate --what table -f csv",
    "delaunay --what table -f csv",
    "alphashape --seeds pixels -r 2 -f json",
    "skeleton-exact -f json",
    "skeleton-exact --outline contour -f json",
    "skeleton-approx --step 1 -f json",
]


@pytest.mark.parametrize("command", COMMANDS)
def test_a_cleaned_scan_is_the_clean_mask(run, scans, command):
    options = ["--threshold", "otsu", "--invert"]
    source, options = ("specks.tif", []) if "contour" in command else ("scan.jpg", options)
    cleaning = ["--min-area", "5", "--fill-holes"]
    assert run(*command.split(), source, *options, *cleaning, "-q", "-o", "made.out").code == 0
    assert run(*command.split(), "clean.tif", "-q", "-o", "clean.out").code == 0
    assert (scans / "made.out").read_bytes() == (scans / "clean.out").read_bytes()


def test_what_is_left_out_is_told(run, scans):
    done = run("tessellate", "specks.tif", "-o", "a.png", "--min-area", "5", "--stats", "s.json")
    assert "note: 3 of 5 objects have fewer than 5 pixels: left out" in done.err
    assert json.loads((scans / "s.json").read_text())["small_objects"] == 3
    done = run("tessellate", "specks.tif", "-o", "a.png", "--fill-holes", "--stats", "s.json")
    assert json.loads((scans / "s.json").read_text())["filled_pixels"] == 49
    done = run("tessellate", "specks.tif", "-o", "a.png", "--min-area", "99999")
    assert (done.code, "the image has no foreground" in done.err) == (0, True)


def test_large_images_are_held_for_it(run, scans, monkeypatch):
    import vorotool.jobs.streamed_tessellation as streamed

    options = ["--min-area", "5", "--fill-holes", "-q"]
    assert run("tessellate", "specks.tif", "-o", "held.tif", *options).code == 0
    monkeypatch.setattr(streamed, "LARGE", 100)
    assert run("tessellate", "specks.tif", "-o", "rows.tif", *options).code == 0
    assert (scans / "held.tif").read_bytes() == (scans / "rows.tif").read_bytes()


@pytest.mark.parametrize(
    ("command", "code", "words"),
    [
        ("tessellate labels.tif --min-area 3 -o a.png", 3, "the image holds labels, but --min-area is for masks"),
        ("tessellate ink.tif --fill-holes --seeds labels -o a.png", 3, "but --fill-holes is for masks"),
        ("tessellate dots.csv --size 9x9 --min-area 3 -o a.png", 2, "--min-area is for images"),
        ("delaunay dots.csv --fill-holes", 2, "--fill-holes is for images"),
        ("skeleton-exact line.wkt --min-area 3 -f json", 2, "--min-area is for images"),
        ("tessellate ink.tif --min-area 0 -o a.png", 2, "0 is not in the range x>=1"),
        ("skeleton-exact ink.tif --threshold 9 --outline contour --fill-holes -f json", 2, "--outline contour"),
    ],
)  # fmt: skip
def test_what_is_refused(run, scans, command, code, words):
    labels = np.zeros((9, 9), np.uint8)
    labels[2:4, 2:4], labels[6:8, 6:8] = 3, 5
    tifffile.imwrite(scans / "labels.tif", labels)
    (scans / "dots.csv").write_text("x,y\n2,3\n5,5\n1,7\n")
    (scans / "line.wkt").write_text("LINESTRING (0 0, 3 4)\n")
    done = run(*command.split())
    assert (done.code, words in done.err) == (code, True), done.err
    assert run("tessellate", "labels.tif", "--min-area", "3", "--seeds", "components", "-o", "a.png").code == 0
