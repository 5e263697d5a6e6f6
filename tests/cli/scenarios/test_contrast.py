"""Letters, lines and scale bars that show on any ground: read back by Pillow and by the parser of XML."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from PIL import Image

from vorotool.render.canvas.glyphs import text_cells
from vorotool.render.canvas.styles import CELLS, INK, LINE, RESULT, SEED, WHITE, edge_color

NAMESPACE = "{http://www.w3.org/2000/svg}"
DARK = (34, 34, 34)


@pytest.fixture
def mask(tmp_path):
    pixels = np.zeros((120, 200), dtype=np.uint8)
    pixels[20:40, 20:50] = pixels[70:100, 120:180] = pixels[80:90, 30:60] = 255
    Image.fromarray(pixels).save(tmp_path / "mask.png")
    return "mask.png"


def pixels_of(path, color):
    with Image.open(path) as made:
        return int((np.asarray(made.convert("RGB")) == color).all(axis=2).sum())


def group(path, name):
    return next(each for each in ET.parse(path).iter(f"{NAMESPACE}g") if each.get("id") == name)


def test_edges_are_white_but_for_light_colors():
    assert [edge_color(color) for color in (INK, LINE, SEED, RESULT, "#ff0000", CELLS[0])] == [WHITE] * 6
    assert [edge_color(color) for color in (WHITE, "#ffff00", "#cccccc", "#99ddff")] == [INK] * 4


@pytest.mark.parametrize(("color", "edge"), [("white", "#222222"), ("black", "#ffffff"), ("yellow", "#222222")])
@pytest.mark.parametrize("command", [("tessellate", "--what", "color"), ("delaunay",), ("voronoi",)])
def test_names_have_an_edge_of_another_lightness(run, tmp_path, mask, command, color, edge):
    run(*command, mask, "--layers", "labels", "--color", f"labels={color}", "-o", "made.svg", "--background", "black")
    labels = group(tmp_path / "made.svg", "labels")
    assert labels.get("stroke") == edge


@pytest.mark.parametrize("command", [("tessellate", "--what", "color"), ("delaunay",)])
def test_white_names_in_png_have_dark_edges(run, tmp_path, mask, command):
    for color, edged in (("white", True), ("black", False)):
        run(*command, mask, "--layers", "labels", "--color", f"labels={color}", "-o", "made.png", "--overwrite")
        assert (pixels_of(tmp_path / "made.png", DARK) > 20) == edged


def test_lines_over_an_image_have_edges_of_another_lightness(run, tmp_path, mask):
    run("delaunay", mask, "--overlay", mask, "--color", "edges=white", "-o", "made.svg")
    assert group(tmp_path / "made.svg", "edges-halo").get("stroke") == "#222222"
    run("delaunay", mask, "--overlay", mask, "--color", "edges=#aa0000", "-o", "made.svg", "--overwrite")
    assert group(tmp_path / "made.svg", "edges-halo").get("stroke") == "#ffffff"


@pytest.mark.parametrize(
    ("options", "color"),
    [
        ((), "#222222"),
        (("--background", "black"), "#ffffff"),
        (("--color", "scale-bar=red"), "#ff0000"),
        (("--color", "scale-bar=white", "--overlay", "mask.png"), "#ffffff"),
    ],
)
@pytest.mark.parametrize("command", [("tessellate", "--what", "color"), ("delaunay",), ("voronoi",)])
def test_scale_bars_have_a_color(run, tmp_path, mask, command, options, color):
    done = run(*command, mask, "--scale-bar", "--pixel-size", "0.5um", *options, "-o", "made.svg")
    assert done.code == 0
    assert group(tmp_path / "made.svg", "scale-bar").get("stroke") == color
    assert group(tmp_path / "made.svg", "scale-bar-length").get("fill") == color
    assert group(tmp_path / "made.svg", "scale-bar-length").get("stroke") != color


def test_a_scale_bar_in_png_has_its_color(run, tmp_path, mask):
    run("delaunay", mask, "--scale-bar", "--pixel-size", "0.5um", "--color", "scale-bar=#00ff00", "-o", "made.png")
    assert pixels_of(tmp_path / "made.png", (0, 255, 0)) > 100


def test_the_color_of_a_bar_that_is_not_drawn_is_refused(run, mask):
    assert run("delaunay", mask, "--color", "scale-bar=red", "-f", "svg").code == 2


def test_micro_is_a_letter_of_its_own():
    micro, greek, latin = (cells[is_ink].tolist() for _, cells, is_ink in map(text_cells, (["µ"], ["μ"], ["u"])))
    assert micro == greek != latin
    assert max(y for _, y in micro) == max(y for _, y in latin)
