"""Pictures of skeletons."""

import io
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import vorotool
from vorotool.errors import UsageError
from vorotool.formats.images.png_writer import write_png
from vorotool.render.canvas.layers import Curves, Page
from vorotool.render.canvas.png import layer_bands
from vorotool.render.canvas.svg import write_layers_svg
from vorotool.render.layers.skeleton import LAYERS, diagram_layers, skeleton_layers, skeleton_page

SHAPES = vorotool.read(Path(__file__).parents[3] / "data" / "two-shapes.json")
MADE = vorotool.skeleton_exact(SHAPES)
PAGE = skeleton_page(MADE)


def svg_of(layers, page=PAGE):
    out = io.BytesIO()
    write_layers_svg(out, layers, page)
    return out.getvalue().decode()


def test_every_parabola_is_one_quadratic_curve():
    text = svg_of(skeleton_layers(MADE, PAGE, ["skeleton"]))
    paths = "".join(re.findall(r' d="([^"]*)"', text))
    assert paths.count("Q") == np.count_nonzero(MADE.is_parabola)
    assert paths.count("L") == np.count_nonzero(~MADE.is_parabola)
    joined = (MADE.arcs[1:, 0] == MADE.arcs[:-1, 1]).sum()
    assert paths.count("M") == len(MADE) - joined


def test_layers_are_groups_from_below():
    text = svg_of(skeleton_layers(MADE, PAGE, reversed(LAYERS), exact=MADE))
    assert text.count("stroke-dasharray") == 1
    assert re.findall(r'<g id="(\w+)"', text) == list(LAYERS)
    assert re.findall(r'<g id="(\w+)"', svg_of(diagram_layers(MADE, PAGE, ["skeleton"]))) == ["diagram"]
    with pytest.raises(UsageError, match="cells"):
        skeleton_layers(MADE, PAGE, ["cells"])


def test_png_follows_the_curve():
    """A parabola from (0, 0) over (5, 10) to (10, 0) passes (5, 5), where its control triangle does not."""
    points = np.array([[0.0, 0.0], [10.0, 0.0], [5.0, 10.0]])
    layer = Curves("curve", points, np.array([[0, 1]], np.int32), np.array([2], np.int32), "#000000", 2)
    page = Page((0, 0, 10, 10), width=104, y_up=False)
    out = io.BytesIO()
    write_png(out, layer_bands([layer], page), (page.height, page.width), rgb=True)
    dark = np.asarray(Image.open(io.BytesIO(out.getvalue())).convert("L")) < 128
    middle = page.place(np.array([[5.0, 5.0]]))[0]
    rows = np.flatnonzero(dark[:, int(middle[0])])
    assert np.abs(rows + 0.5 - middle[1]).max() <= 1.5
