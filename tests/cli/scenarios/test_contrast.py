"""Letters, lines and scale bars that show on any ground: read back by Pillow and by the parser of XML."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from PIL import Image

from vorotool.render.canvas.styles import CELLS, INK, LINE, RESULT, SEED, WHITE, edge_color

NAMESPACE = "{http://www.w3.org/2000/svg}"


@pytest.fixture
def mask(tmp_path):
    pixels = np.zeros((120, 200), dtype=np.uint8)
    pixels[20:40, 20:50] = pixels[70:100, 120:180] = pixels[80:90, 30:60] = 255
    Image.fromarray(pixels).save(tmp_path / "mask.png")
    return "mask.png"


def group(path, name):
    return next(each for each in ET.parse(path).iter(f"{NAMESPACE}g") if each.get("id") == name)


def test_edges_are_white_but_for_light_colors():
    assert [edge_color(color) for color in (INK, LINE, SEED, RESULT, "#ff0000", CELLS[0])] == [WHITE] * 6
    assert [edge_color(color) for color in (WHITE, "#ffff00", "#cccccc", "#99ddff")] == [INK] * 4


@pytest.mark.parametrize(
    ("command", "color", "edge"),
    [
        ("tessellate --what color", "white", "#222222"),
        ("delaunay", "black", "#ffffff"),
        ("voronoi", "yellow", "#222222"),
    ],
)
def test_names_have_an_edge_of_another_lightness(run, tmp_path, mask, command, color, edge):
    run(f"{command} {mask} --layers labels --color labels={color} -o made.svg --background black")
    assert group(tmp_path / "made.svg", "labels").get("stroke") == edge


@pytest.mark.parametrize(
    ("options", "color"),
    [
        ("", "#222222"),
        ("--background black", "#ffffff"),
        ("--color scale-bar=red", "#ff0000"),
        ("--color scale-bar=white --overlay mask.png", "#ffffff"),
    ],
)
def test_scale_bars_have_a_color(run, tmp_path, mask, options, color):
    run(f"tessellate {mask} --what color --scale-bar --pixel-size 0.5um -o made.svg {options}")
    assert group(tmp_path / "made.svg", "scale-bar").get("stroke") == color
    assert group(tmp_path / "made.svg", "scale-bar-length").get("fill") == color
    assert group(tmp_path / "made.svg", "scale-bar-length").get("stroke") != color
