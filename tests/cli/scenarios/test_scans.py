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
    Image.fromarray(np.dstack([grey, grey, grey // 2])).save(tmp_path / "color.png")
    Image.fromarray(255 - grey).save(tmp_path / "dark.png")
    for name, mask in (("ink", INK), ("specks", SPECKS), ("clean", CLEAN)):
        tifffile.imwrite(tmp_path / f"{name}.tif", mask.astype(np.uint8) * 255)
    return tmp_path


@pytest.mark.parametrize("name", ["scan.jpg", "color.png"])
def test_messages_say_what_makes_a_mask_of_a_scan(run, scans, name):
    run(f"tessellate {name} -o a.png", code=3, says="--threshold")
    run(f"tessellate {name} -o a.png --threshold otsu", says="--invert")
    assert "brighter" not in run(f"tessellate {name} -o a.png --threshold otsu --invert").err


COMMANDS = [
    "tessellate -f npy",
    "tessellate --what table -f csv",
    "alphashape --seeds pixels -r 2 -f json",
    "skeleton-exact --outline contour -f json",
    "voronoi -f json",
    "skeleton-approx --step 1 -f json",
]


@pytest.mark.parametrize("command", COMMANDS)
def test_a_cleaned_scan_is_the_clean_mask(run, scans, command):
    source = "specks.tif" if "contour" in command else "scan.jpg --threshold otsu --invert"
    run(f"{command} {source} --min-area 5 --fill-holes -q -o made.out")
    run(f"{command} clean.tif -q -o clean.out")
    assert (scans / "made.out").read_bytes() == (scans / "clean.out").read_bytes()


def test_what_is_left_out_is_told(run, scans):
    words = "note: 3 of 5 objects have fewer than 5 pixels: dropped"
    run("tessellate specks.tif -o a.png --min-area 5 --stats s.json", says=words)
    assert json.loads((scans / "s.json").read_text())["small_objects"] == 3
    run("tessellate specks.tif -o a.png --fill-holes --stats s.json")
    assert json.loads((scans / "s.json").read_text())["filled_pixels"] == 49
    run("tessellate specks.tif -o a.png --min-area 99999", says="the image has no foreground")


def test_the_note_has_whole_pixels(run, scans):
    done = run("skeleton-exact specks.tif --min-area 0.3um2 --pixel-size 0.3um -o a.json")
    assert done.err == "note: 3 of 5 objects have fewer than 4 pixels: dropped\n"


def test_images_beyond_memory_are_refused_with_a_way_out(run, scans, monkeypatch):
    monkeypatch.setattr("vorotool.jobs.tessellation.LARGE", 100)
    run("tessellate specks.tif -o a.tif --fill-holes --max-pixels 500", code=5, says="--fill-holes")


@pytest.mark.parametrize(
    ("command", "typed"),
    [
        ("tessellate --what table", "--fill-holes 49"),
        ("delaunay", "--fill-holes=49"),
        ("skeleton-exact", "--fill-holes 12.25um2 --pixel-size 0.5um"),
    ],
)
def test_holes_of_at_most_an_area(run, scans, command, typed):
    options = ["specks.tif", "--stats", "s.json", "-q", "-o", "a.csv"]
    for area, pixels in ((typed, 49), (typed.replace("49", "48").replace("12.25", "12.2"), 0)):
        run(command, *area.split(), *options)
        assert json.loads((scans / "s.json").read_text())["filled_pixels"] == pixels


def test_contours_of_grey_values_go_around_what_stays(run, scans):
    line = "skeleton-exact dark.png --threshold 90 --outline contour -f json"
    run(f"{line} --min-area 5 --fill-holes --stats s.json -o a.json", says="have fewer than 5 pixels: dropped")
    stats = json.loads((scans / "s.json").read_text())
    assert (stats["filled_pixels"], stats["small_objects"]) == (49, 2)
    run(f"{line} -o b.json")
    before, after = (json.loads((scans / name).read_text()) for name in ("b.json", "a.json"))
    shells = [{str(polygon["shell"]) for polygon in each["polygons"]} for each in (before, after)]
    assert shells[1] < shells[0]
    assert not any(polygon.get("holes") for polygon in after["polygons"])
