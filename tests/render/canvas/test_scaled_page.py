"""Pictures to scale, read back with their sizes, and in the colors and widths that are chosen."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest

from support.few import few
from support.readers.written import bytes_of
from vorotool.errors import UsageError
from vorotool.formats.drawing.svg_reader import read_svg
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.render.canvas.insets import ScaledPage, styled_layers
from vorotool.render.canvas.layers import Arcs, Curves, Lines, Page, Points, Polygons, Texts
from vorotool.render.canvas.styles import WHITE, PictureStyle
from vorotool.render.canvas.svg import write_layers_svg
from vorotool.types.polygons.shapely_geometry import to_shapely

SQUARE = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]])


def shapes_of(layers, page):
    svg = bytes_of(write_layers_svg, layers, page)
    return to_shapely(read_svg(Source("a.svg", svg), ReadOptions(flatten=1e-4)))


def square(scale=1.0):
    return Polygons("shape", SQUARE * scale, np.arange(4, dtype=np.int32), np.array([0, 4]))


@pytest.mark.parametrize("millimeters", [1e-3, 0.5, 1, 25.4, 1000])
@pytest.mark.parametrize("size", few([1.0, 1e-6, 1e9], 1))
@pytest.mark.parametrize("y_up", [False, True])
def test_sizes_return(millimeters, size, y_up):
    if not 1e-3 <= size * millimeters <= 1e5:
        pytest.skip("no page for it")
    page = ScaledPage((0, 0, 3 * size, 2 * size), y_up=y_up, millimeters=millimeters)
    shape = shapes_of([square(size)], page)[-1]  # the first is the ground
    x, y, right, bottom = shape.bounds
    across = size * millimeters
    assert right - x == pytest.approx(3 * across, rel=1e-6, abs=1e-4)
    assert bottom - y == pytest.approx(2 * across, rel=1e-6, abs=1e-4)
    assert x == pytest.approx(0.06 * across, rel=1e-6, abs=1e-4)


def test_arcs_return():
    page = ScaledPage((-1, -1, 1, 1), y_up=True, millimeters=20)
    places = np.array([[1.0, 0.0], [-1.0, 0.0]])
    arcs = Arcs("offset", places, places[::-1], np.zeros((2, 2)), np.array([0, 2]), None, WHITE, 1.0, np.ones(2, bool))
    circle = shapes_of([arcs], page)[-1]
    assert circle.area == pytest.approx(400 * np.pi, rel=1e-4)


@pytest.mark.parametrize("millimeters", [1e300, 1e7, 0.0, 1e-320, float("inf"), float("nan")])
def test_pages_that_nobody_has(millimeters):
    with pytest.raises(UsageError, match=r"the page would be .* choose another scale"):
        ScaledPage((0, 0, 3, 2), y_up=False, millimeters=millimeters)


def test_colors_and_widths_of_all_layers():
    pairs = np.array([[0, 1]], dtype=np.int32)
    control = np.array([-1], dtype=np.int32)
    center = np.full((4, 2), np.nan)
    layers = [
        Lines("a", SQUARE, pairs),
        Curves("centerline", SQUARE, pairs, control),
        square(),
        Polygons("cells", SQUARE, np.arange(4, dtype=np.int32), np.array([0, 4]), colors=["#111111", "#222222"]),
        Points("points", SQUARE),
        Texts("labels", SQUARE, ["1", "2", "3", "4"]),
        Arcs("offset", SQUARE, np.roll(SQUARE, -1, axis=0), center, np.array([0, 4]), None, WHITE),
    ]
    names = ("a", "skeleton", "shape", "cells", "points", "labels", "offset")
    style = PictureStyle(colors=dict.fromkeys(names, "#abcdef"), widths=dict.fromkeys(names, 7.0))
    made = styled_layers(layers, style)
    colors = [getattr(layer, "color", None) or getattr(layer, "edge", None) or layer.colors[0] for layer in made]
    assert colors == ["#abcdef"] * 7
    assert made[3].colors == ["#111111", "#222222"]
    assert [layer.width for layer in made if hasattr(layer, "width")] == [7.0] * 5
    assert styled_layers(layers, PictureStyle()) == layers


CONTROLS = [*map(chr, range(0x20)), "\ud800", "\udfff", "\ufffe", "\uffff", "]]>", "&<>\"'"]


@pytest.mark.parametrize("text", CONTROLS, ids=lambda text: "-".join(f"{ord(each):04x}" for each in text))
def test_every_character_gives_xml(text):
    page = Page((0, 0, 9, 9), width=100, y_up=False)
    data = bytes_of(write_layers_svg, [Texts("labels", np.array([[1.0, 1.0]]), [f"v{text}v"])], page)
    root = ET.fromstring(data.decode())
    (found,) = [each.text for each in root.iter("{http://www.w3.org/2000/svg}text")]
    kept = text if text.isprintable() or text in "\t\n\r" else "\ufffd"
    assert found == f"v{kept}v".replace("\r", "\n")
