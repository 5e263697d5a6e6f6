"""Lengths with units on the command line: the bytes are those of the same number of pixels, which is exact."""

import numpy as np
import pytest

XY = np.array([[0, 0], [9, 1], [4, 7], [12, 8], [2, 3], [7, 4], [11, 2], [1, 9], [5, 2], [8, 9]])


@pytest.fixture
def inputs(tmp_path):
    (tmp_path / "in.csv").write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in XY))
    (tmp_path / "in.json").write_text(
        "[[[0, 0], [9, 0], [9, 9], [5, 3], [0, 9]], [[20, 0], [33, 1], [30, 8], [21, 7]]]"
    )
    return tmp_path


def test_what_is_exact_stays_so(run, inputs):
    """A third of an inch is no decimal number: of pixels at distance 1 none is lost or won by rounding."""
    (inputs / "two.csv").write_text("x,y\n3,3\n")
    size = ["--pixel-size", "0.1in", "--size", "7x7", "-q", "-o"]
    run("tessellate two.csv --max-distance 2.54mm", *size, "one.npy")
    run("tessellate two.csv --max-distance 2.5399999999999999999999mm", *size, "less.npy")
    assert np.count_nonzero(np.load(inputs / "one.npy")) == 5
    assert np.count_nonzero(np.load(inputs / "less.npy")) == 1


# ---- places and frames


FRAMED = [
    "voronoi in.json -o {}.csv --frame",
    "delaunay in.csv --what cells -o {}.csv --frame",
]


@pytest.mark.parametrize("command", FRAMED, ids=lambda text: text.split()[0])
def test_a_frame_is_its_numbers(run, inputs, command):
    """A pixel is 0.5 um."""
    for name, frame in (("unit", "-1um,-1um,10um,0.009mm"), ("plain", "-2,-2,20,18")):
        words = command.format(name).split()
        run(*words, frame, "--pixel-size", "0.5um", "-q")
    kind = words[words.index("-o") + 1].rpartition(".")[2]
    assert (inputs / f"unit.{kind}").read_bytes() == (inputs / f"plain.{kind}").read_bytes()


def test_places_on_a_map_are_in_pixels(run, tmp_path):
    import rasterio

    place = {"crs": "EPSG:2056", "transform": rasterio.Affine(2, 0, 2600000, 0, -2, 1200000)}
    mask = np.zeros((20, 30), np.uint8)
    mask[5:15, 5:25] = 255
    with rasterio.open(tmp_path / "m.tif", "w", "GTiff", 30, 20, 1, dtype="uint8", **place) as out:
        out.write(mask, 1)
    run("voronoi m.tif --frame 0,0,20,20m -f csv", code=2, says=["--frame", "pixels"])
