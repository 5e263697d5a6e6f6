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


def test_necks_are_those_of_the_library(run):
    done = run("skeleton-exact", SHAPES, "--what", "necks", "-f", "csv", "--verify")
    assert (done.code, done.err) == (0, "")
    expected = vorotool.necks(vorotool.read(SHAPES))
    assert [float(row["width"]) for row in done.rows] == expected.width.tolist()
    assert [float(row["ratio"]) for row in done.rows] == expected.ratio.tolist()
    assert [row["id"] for row in done.rows] == ["key"] * 4


def test_necks_up_to_a_ratio_are_those_of_the_library(run):
    for ratio in ("0", "0.6", "1"):
        done = run("skeleton-exact", SHAPES, "--what", "necks", "--neck", ratio, "-f", "csv", "--verify")
        expected = vorotool.necks(vorotool.read(SHAPES), neck=float(ratio))
        assert (done.code, done.err) == (0, "")
        assert [float(row["width"]) for row in done.rows] == expected.width.tolist()
    assert [row["id"] for row in done.rows] == ["branch", *["key"] * 5]


def test_cuts_are_lines(run):
    expected = vorotool.necks(vorotool.read(SHAPES))
    found = json.loads(run("skeleton-exact", SHAPES, "--what", "necks", "-f", "geojson").out)["features"]
    lines = [shapely.geometry.shape(each["geometry"]) for each in found]
    assert [line.length for line in lines] == pytest.approx(expected.width.tolist())
    assert [each["properties"]["r_smaller"] for each in found] == expected.beside[:, 0].tolist()
    done = run("skeleton-exact", SHAPES, "--what", "necks", "-f", "wkt")
    assert [shapely.from_wkt(text).length for text in done.out.splitlines()] == pytest.approx(expected.width.tolist())


def test_parts_have_ids_areas_and_neighbors(run):
    done = run("skeleton-exact", SHAPES, "--what", "parts", "--neck", "0.95", "-f", "geojson", "--verify")
    assert (done.code, done.err) == (0, "")
    found = json.loads(done.out)["features"]
    expected = vorotool.parts(vorotool.read(SHAPES), neck=0.95)
    own = [each["properties"] for each in found]
    assert [each["piece"] for each in own] == list(range(len(expected)))
    assert [each["neighbors"] for each in own] == expected.neighbors
    assert [each["area"] for each in own] == expected.area.tolist()
    assert [shapely.geometry.shape(each["geometry"]).area for each in found] == pytest.approx(expected.area.tolist())
    rows = run("skeleton-exact", SHAPES, "--what", "parts", "--neck", "0.95", "-f", "csv").rows
    assert [float(row["width"]) for row in rows] == expected.width.tolist()


def test_pieces_can_be_read_again(run, folder):
    assert run("skeleton-exact", SHAPES, "--what", "parts", "--neck", "1", "-o", "parts.json").code == 0
    again = vorotool.read(folder / "parts.json")
    assert again.xy.tolist() == vorotool.parts(vorotool.read(SHAPES), neck=1).polygons.xy.tolist()


def test_pixel_sizes_scale_lengths_and_areas(run):
    options = ("skeleton-exact", CELLS, "--what", "parts", "--neck", "0.8", "-f", "csv")
    plain, scaled = run(*options).rows, run(*options, "--pixel-size", "0.5um").rows
    assert len(plain) == len(scaled) > 10
    assert [float(row["area"]) for row in scaled] == pytest.approx([float(row["area"]) / 4 for row in plain])
    assert [float(row["width"]) for row in scaled] == pytest.approx([float(row["width"]) / 2 for row in plain])
    necks = [
        run("skeleton-exact", CELLS, "--what", "necks", "-f", "csv", *more).rows for more in ([], ["--pixel-size", "2"])
    ]
    for name in ("width", "r_smaller", "x_a"):
        assert [float(row[name]) for row in necks[1]] == pytest.approx([2 * float(row[name]) for row in necks[0]])
    assert [row["ratio"] for row in necks[1]] == [row["ratio"] for row in necks[0]]


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


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--neck", "0.5"], "--neck"),
        (["--what", "parts", "--side", "both"], "--side"),
        (["--what", "necks", "--gap", "1"], "--what"),
        (["--what", "parts", "--prune", "chord=1"], "--prune"),
        (["--what", "parts", "--neck", "2"], "0<=x<=1"),
    ],
)
def test_what_does_not_go_together(run, options, message):
    done = run("skeleton-exact", SHAPES, *options, "-f", "svg")
    assert done.code == 2
    assert message in done.err


def test_approximate_skeletons_have_none(run):
    done = run("skeleton-approx", SHAPES, "--step", "4", "--what", "necks", "-f", "csv")
    assert done.code == 2
    assert "necks" in done.err
