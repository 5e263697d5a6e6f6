"""Layers, their page, palettes and glyphs, and both kinds of pictures."""

from __future__ import annotations

import io
import itertools
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from PIL import Image
from scipy import ndimage
from skimage.color import deltaE_ciede2000, rgb2lab

from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import LimitError
from vorotool.formats.images.png_writer import write_png
from vorotool.render.canvas import svg as layers_svg
from vorotool.render.canvas.layers import Lines, Page, Points, Polygons, Texts, bounds_of
from vorotool.render.canvas.png import check_picture_size, layer_bands, text_cells
from vorotool.render.canvas.styles import CELLS, LINE, SEED, picture_palette
from vorotool.render.canvas.svg import write_layers_svg

NS = "{http://www.w3.org/2000/svg}"
SQUARES = np.array([[0, 0], [10, 0], [10, 8], [0, 8], [2, 2], [2, 6], [6, 6], [6, 2], [12, 0], [16, 4], [12, 8.0]])
CORNERS = np.arange(11, dtype=np.int32)
HOLED = Polygons(
    "cells",
    SQUARES,
    CORNERS,
    rings=np.array([0, 4, 8, 11]),
    first_rings=np.array([0, 2, 3]),
    colors=["#77aadd", "#ee8866"],
    color_of=np.array([0, 1]),
    ids=["cell-1", "cell-<2"],
    edge="#000000",
    width=3,
)


def svg(*layers, width=600, y_up=False, bounds=None):
    page = Page(bounds or bounds_of(*(layer.points for layer in layers)), width=width, y_up=y_up)
    return ET.fromstring(bytes_of(write_layers_svg, layers, page))


def picture(*layers, width=160, y_up=False, bounds=None):
    page = Page(bounds or bounds_of(*(layer.points for layer in layers)), width=width, y_up=y_up)
    rows = np.concatenate(list(layer_bands(layers, page)))
    assert rows.dtype == np.uint8
    return rows.reshape(page.height, page.width, 3)


def rings_of(path):
    """Corners of each ring of a path."""
    parts = [part for part in path.attrib["d"].split("Z") if part]
    return [np.array([list(map(float, xy.split())) for xy in re.split("[ML]", part)[1:]]) for part in parts]


finite = st.floats(allow_nan=False, allow_infinity=False)


@settings(deadline=None)
@given(st.lists(st.tuples(finite, finite), min_size=1, max_size=20), st.booleans(), st.integers(16, 2000))
@example([(0.0, 1.0), (0.0, np.nextafter(1.0, 2.0))], False, 1030)
@example([(0.0, np.nextafter(1.0, 2.0)), (0.0, 1.0 + 2.0**-51)], True, 1030)
def test_the_page_holds_all_points_whatever_their_size(points, y_up, width):
    array = np.array(points)
    page = Page(bounds_of(array), width=width, y_up=y_up)
    assert page.width == width
    assert 1 <= page.height <= 4 * width + 1
    placed = page.place(array)
    assert (placed >= -0.51).all()  # the height is rounded to whole px
    assert (placed <= np.array([page.width, page.height]) + 0.51).all()


def test_polygons_in_svg():
    root = svg(HOLED, width=1000)
    (group,) = root.iter(f"{NS}g")
    assert (group.attrib["id"], group.attrib["fill-rule"], group.attrib["stroke-width"]) == ("cells", "evenodd", "3")
    page = Page(bounds_of(HOLED.points), width=1000, y_up=False)
    rings = ([range(4), range(4, 8)], [range(8, 11)])
    for path, name, fill, corners in zip(group, HOLED.ids, HOLED.colors, rings, strict=True):
        assert (path.attrib["id"], path.attrib["fill"]) == (name, fill)
        assert path.attrib["vector-effect"] == "non-scaling-stroke"
        for ring, expected in zip(rings_of(path), corners, strict=True):
            np.testing.assert_allclose(ring, page.place(SQUARES[expected]), atol=0.0051)


def test_lines_and_points_and_texts_in_svg(monkeypatch):
    pairs = np.array([[0, 9], [3, 10], [4, 5]], np.int32)
    texts = [str(k) if k else "a<b" for k in range(11)]
    layers = (Lines("edges", SQUARES, pairs), Points("sites", SQUARES), Texts("labels", SQUARES, texts))
    root = svg(*layers)
    groups = {group.attrib["id"]: group for group in root.iter(f"{NS}g")}
    assert list(groups) == ["edges", "sites", "labels"]
    placed = np.round(Page(bounds_of(*(layer.points for layer in layers)), width=600, y_up=False).place(SQUARES), 2)
    (path,) = groups["edges"]
    lines = [re.split("[L ]", part) for part in path.attrib["d"].split("M")[1:]]
    np.testing.assert_allclose(np.array(lines, float).reshape(-1, 2, 2), placed[pairs])
    circles = [(float(c.attrib["cx"]), float(c.attrib["cy"])) for c in groups["sites"]]
    np.testing.assert_allclose(circles, placed)
    assert [text.text for text in groups["labels"]] == texts
    monkeypatch.setattr(layers_svg, "MOST_ELEMENTS", 5)
    monkeypatch.setattr(layers_svg, "PATH_ROWS", 4)
    paths = list(svg(*layers).iter(f"{NS}path"))
    assert [path.attrib["d"].count("h0") for path in paths] == [0, 4, 4, 3]


def test_filled_pixels_are_those_inside():
    image = picture(HOLED, width=416, bounds=(0, 0, 16, 8))
    page = Page((0, 0, 16, 8), width=416, y_up=False)
    first, second = (0x77, 0xAA, 0xDD), (0xEE, 0x88, 0x66)
    for x, y, color in ((1, 1, first), (8, 7, first), (4, 4, (255,) * 3), (11, 4, (255,) * 3), (13, 4, second)):
        across, down = page.place(np.array([[x, y]], float))[0].astype(int)
        assert tuple(image[down, across]) == color, (x, y)


@pytest.mark.parametrize("seed", range(4))
def test_area_of_polygons(seed):
    """The mean darkness of a polygon's picture is its area."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, 9))
    points = 50 + 45 * np.stack([np.cos(angles), np.sin(angles)], axis=1) * rng.uniform(0.3, 1, (9, 1))
    layer = Polygons("p", points, np.arange(9, dtype=np.int32), np.array([0, 9]), colors=["#000000"])
    image = picture(layer, width=400, bounds=(0, 0, 100, 100))
    following = np.roll(points, -1, axis=0)
    area = abs((points[:, 0] * following[:, 1] - points[:, 1] * following[:, 0]).sum()) / 2
    scale = Page((0, 0, 100, 100), width=400, y_up=False).scale / 128  # the page scales by a power of two first
    assert (1 - image[:, :, 0] / 255).sum() == pytest.approx(area * scale**2, rel=0.01)


@pytest.mark.parametrize("angle", [0, 0.3, np.pi / 4, 1.0, np.pi / 2, 2.5])
def test_lines_are_as_thick_as_told(angle):
    way = 40 * np.array([np.cos(angle), np.sin(angle)])
    line = Lines("l", np.array([50 - way, 50 + way]), np.array([[0, 1]], np.int32), "#000000", 3.0)
    image = picture(line, width=416, bounds=(0, 0, 100, 100))
    dark = (1 - image[:, :, 0] / 255).sum()
    assert dark == pytest.approx(80 * 4 * 3.0, rel=0.05)


def test_limits():
    page = Page((0, 0, 1, 1), width=1000, y_up=False)
    check_picture_size(page, 16_000_000)
    refused(LimitError, 'fmt="svg"', check_picture_size, page, 15_999_999)
    many = Polygons("p", SQUARES, CORNERS, np.array([0, 11]), colors=[f"#0000{k:02x}" for k in range(256)])
    refused(LimitError, 'fmt="svg"', picture, many)


def test_bands_make_a_png():
    page = Page((0, 0, 16, 8), width=333, y_up=False)
    data = bytes_of(write_png, layer_bands([HOLED], page), (page.height, page.width), rgb=True)
    np.testing.assert_array_equal(
        np.asarray(Image.open(io.BytesIO(data))), picture(HOLED, width=333, bounds=(0, 0, 16, 8))
    )


def glyph_picture(text):
    owner, cells, is_ink = text_cells([text])
    assert not owner.any()
    made = np.zeros((15, 6 * len(text) + 15), np.uint8)
    x, y = (cells + np.array([made.shape[1] // 2, 7])).T
    made[y, x] = np.where(is_ink, 2, 1)
    return made


@pytest.mark.parametrize("text", ["0", "8", "17", "lake 5", "ÄÖ", "~"])
def test_the_halo_is_what_touches_the_ink(text):
    made = glyph_picture(text)
    np.testing.assert_array_equal(made > 0, ndimage.binary_dilation(made == 2, np.ones((3, 3))))


def test_all_digits_and_letters_differ():
    letters = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
    assert len({glyph_picture(letter).tobytes() for letter in letters}) == len(letters)


# normal vision, severe protanopia, deuteranopia and tritanopia, on linear RGB (Machado et al. 2009, table 1)
DEFICIENCIES = [
    np.eye(3),
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
]


def as_seen(names: list[str], deficiency: object) -> np.ndarray:
    rgb = np.array([list(bytes.fromhex(name[1:])) for name in names]) / 255
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    seen = np.clip(linear @ np.transpose(deficiency), 0, 1)
    return rgb2lab(np.where(seen <= 0.0031308, seen * 12.92, 1.055 * seen ** (1 / 2.4) - 0.055))


@pytest.mark.parametrize(("count", "least"), [(4, 12.0), (8, 10.0), (12, 8.0)])
@pytest.mark.parametrize("deficiency", DEFICIENCIES)
def test_cells_are_distinct_in_any_color_vision(count: int, least: float, deficiency: object) -> None:
    lab = as_seen(list(CELLS[:count]), deficiency)
    for a, b in itertools.combinations(range(count), 2):
        assert deltaE_ciede2000(lab[a], lab[b]) > least, (CELLS[a], CELLS[b])


@pytest.mark.parametrize("deficiency", DEFICIENCIES)
def test_lines_and_seeds_stand_out(deficiency: object) -> None:
    lab = as_seen([LINE, SEED, *CELLS], deficiency)
    for dark in lab[:2]:
        assert (deltaE_ciede2000(dark[None], lab[2:]) > 25).all()


@pytest.mark.parametrize(
    ("classes", "entries", "bit_depth"), [(0, 15, 4), (12, 15, 4), (13, 16, 4), (14, 17, 8), (253, 256, 8)]
)
def test_palette_fits_its_bits(classes: int, entries: int, bit_depth: int) -> None:
    palette = picture_palette(classes)
    assert palette.colors.shape == (entries, 3)
    assert palette.bit_depth == bit_depth
    assert palette.colors[[0, palette.line]].tolist() == [[255] * 3, [0] * 3]
    assert palette.seed == entries - 1


def test_too_many_classes() -> None:
    refused(LimitError, "254 color classes", picture_palette, 254)
