"""Pictures of label images: borders, outlines of objects, colors, widths and ground, as PNG and SVG."""

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from PIL import Image, ImageColor
from skimage.draw import disk
from skimage.segmentation import find_boundaries

import vorotool
from support.refusals import refused
from vorotool.render.canvas.styles import SEED

NS = "{http://www.w3.org/2000/svg}"
WHITE, VIOLET = (255, 255, 255), ImageColor.getrgb(SEED)


@pytest.fixture
def nuclei(tmp_path):
    """Eight discs of 60 x 80 pixels, of which two touch."""
    labels = np.zeros((60, 80), np.uint8)
    for number, (y, x) in enumerate([(10, 10), (10, 32), (12, 62), (33, 18), (33, 29), (30, 60), (50, 12), (48, 50)]):
        labels[disk((y, x), 6, shape=labels.shape)] = number + 1
    Image.fromarray(labels).save(tmp_path / "labels.png")
    return labels


def pixels(path="out.png", mode="RGB"):
    return np.asarray(Image.open(path).convert(mode))


def is_color(image, color):
    return (image == np.array(color)).all(axis=2)


def outermost(labels):
    """Brute force: pixels of objects with a side on another label, or on the side of the image."""
    padded = np.pad(labels.astype(int), 1, constant_values=-1)
    sides = [padded[1:-1, :-2], padded[1:-1, 2:], padded[:-2, 1:-1], padded[2:, 1:-1]]
    return (labels > 0) & np.logical_or.reduce([side != labels for side in sides])


def test_cells_have_borders_of_a_pixel(run, nuclei):
    run("tessellate labels.png --what color --layers cells -o out.png")
    cells = vorotool.tessellate(vorotool.seeds_from_raster(nuclei)).labels
    right, below = np.zeros((2, *cells.shape), bool)
    right[:, :-1], below[:-1] = cells[:, :-1] < cells[:, 1:], cells[:-1] < cells[1:]
    right[:, 1:] |= cells[:, 1:] < cells[:, :-1]
    below[1:] |= cells[1:] < cells[:-1]
    found = is_color(pixels(), WHITE)
    np.testing.assert_array_equal(found, right | below)
    assert not (found & ~find_boundaries(cells, connectivity=1, mode="thick")).any()
    run("tessellate labels.png --what color --layers cells --line-width cells=0 -o b.png")
    assert not is_color(pixels("b.png"), WHITE).any()


@pytest.mark.parametrize("seeds", ["labels", "components"])
def test_objects_are_outlines(run, nuclei, seeds):
    run(f"tessellate labels.png --what color --seeds {seeds} -o out.png")
    objects = vorotool.seeds_from_raster(nuclei, mode=seeds)
    labels = np.zeros(nuclei.shape, int)
    labels[objects.y, objects.x] = objects.labels
    np.testing.assert_array_equal(is_color(pixels(), VIOLET), outermost(labels))
    run("tessellate labels.png --what color --layers cells,objects -o out.png")
    np.testing.assert_array_equal(is_color(pixels(), VIOLET), nuclei > 0)


def test_one_path_an_object(run, nuclei):
    done = run("tessellate labels.png -f svg --layers cells,objects,seeds --seeds labels")
    groups = {group.get("id"): group for group in ET.fromstring(done.out).iter(f"{NS}g")}
    assert [path.get("id") for path in groups["seeds"]] == [f"seed-{k}" for k in range(1, 9)]
    assert [path.get("id") for path in groups["objects"]] == [f"object-{k}" for k in range(1, 9)]
    assert groups["seeds"].get("fill") == "none"
    assert "circle" not in done.out
    for path in groups["seeds"]:  # the box of each outline is that of its object
        numbers = re.findall(r"([MHV])([\d. ]+)", path.get("d"))
        across = [float(text.split()[0]) for kind, text in numbers if kind in "MH"]
        columns = np.flatnonzero((nuclei == int(path.get("id")[5:])).any(axis=0))
        scale = 1000 / (80 + 0.04 * 80)
        expected = [(columns[0] + 1.6) * scale, (columns[-1] + 2.6) * scale]
        assert [min(across), max(across)] == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize(
    ("looks", "message"),
    [
        ({"color": {"seed": "red"}}, "'seed'"),
        ({"color": {"seeds": "reddish"}}, "'reddish'"),
        ({"line_width": {"seeds": -1}}, "line_width"),
        ({"background": 3}, "invalid background 3: expected a color"),
    ],
)
def test_the_library_refuses(tmp_path, looks, message):
    image = vorotool.tessellate([[1, 1], [5, 3]], shape=(50, 60))
    refused(vorotool.UsageError, message, vorotool.write, image, tmp_path / "out.svg", **looks)
    with pytest.raises(vorotool.UsageError, match=r"background applies to pictures: use fmt='svg'"):
        vorotool.write(image, tmp_path / "out.npy", background="red")
    with pytest.raises(vorotool.UsageError, match=r"layers applies to pictures: use what='color'"):
        vorotool.write(image, tmp_path / "out.png", layers=["diagram"])
    assert not list(tmp_path.iterdir())
