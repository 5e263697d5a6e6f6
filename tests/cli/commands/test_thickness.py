"""`skeleton-exact --what thickness`: its files, its picture, its units, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
import tifffile
from PIL import Image

import vorotool

DATA = Path(__file__).parents[3] / "data"
BLOBS = DATA / "blobs.png"


@pytest.fixture(scope="module")
def expected():
    return vorotool.local_thickness(np.asarray(Image.open(BLOBS)))


def thickness(run, *arguments):
    done = run(f"skeleton-exact {BLOBS} --what thickness", *arguments)
    assert done.err == ""


def test_files_hold_floats(run, folder, expected):
    thickness(run, "-o", "a.tif", "--verify")
    made = tifffile.imread(folder / "a.tif")
    assert np.array_equal(made, expected.astype(np.float32))


def test_values_are_in_the_unit_and_summarized(run, folder, expected):
    thickness(run, "-o", "a.npy", "--pixel-size", "0.5um", "--stats", "s.json")
    np.testing.assert_allclose(np.load(folder / "a.npy"), expected / 2, rtol=1e-7)
    found, inner = json.loads((folder / "s.json").read_text()), expected[expected > 0] / 2
    summary = [found[f"thickness_{name}"] for name in ("mean", "sd", "largest")]
    np.testing.assert_allclose(summary, [inner.mean(), inner.std(), inner.max()], rtol=1e-12)
    assert (found["pixels"], found["unit"]) == (len(inner), "um")


def test_maps_keep_their_place(run, folder, expected):
    scale, tie = (33550, "d", 3, (2.0, 2.0, 0.0)), (33922, "d", 6, (0.0, 0.0, 0.0, 500.0, 900.0, 0.0))
    tifffile.imwrite(folder / "map.tif", np.asarray(Image.open(BLOBS)), extratags=[scale, tie], metadata=None)
    run("skeleton-exact map.tif --what thickness -o a.tif --verify")
    with tifffile.TiffFile(folder / "a.tif") as made:
        assert made.pages[0].tags[33550].value[:2] == (2.0, 2.0)
        np.testing.assert_allclose(made.asarray(), 2 * expected, rtol=1e-6)


def test_a_picture_has_a_color_for_each_thickness(run, folder, expected):
    thickness(run, "-o", "a.png")
    made = np.asarray(Image.open(folder / "a.png").convert("RGB")).astype(int)
    assert made.shape[:2] == expected.shape
    assert (made[expected == 0] == 255).all()
    assert made[expected == expected.max()][0].tolist() == [253, 231, 37]
    light = made[expected > 0].sum(axis=1)
    assert (np.diff(light[np.argsort(expected[expected > 0], kind="stable")]) >= -12).all()


def test_an_image_without_foreground(run, folder):
    Image.fromarray(np.zeros((4, 5), np.uint8)).save(folder / "none.png")
    for name in ("a.npy", "a.png"):
        run(f"skeleton-exact none.png --what thickness -o {name} --verify --stats s.json", says="warning")
    assert not np.load(folder / "a.npy").any()
