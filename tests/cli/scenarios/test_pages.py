"""Pages of SVG to scale: sizes, origins and positions, read back by svgelements and by the parser of XML."""

import re
import xml.etree.ElementTree as ET

import ezdxf
import numpy as np
import pytest
from PIL import Image
from svgelements import SVG

PART = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="210mm" height="100mm" viewBox="0 0 420 200">'
    '<rect x="40" y="60" width="160" height="80"/></svg>'
)
SHEET, RECTANGLE = (210, 100), (20, 30, 100, 70)  # in mm


@pytest.fixture
def part(tmp_path):
    (tmp_path / "part.svg").write_text(PART)
    return "part.svg"


def page(path):
    """Width and height in mm of a picture, and the bounds in mm of each of its layers."""
    root = ET.parse(path).getroot()
    sides = tuple(float(re.fullmatch(r"([0-9.]+)mm", root.get(side))[1]) for side in ("width", "height"))
    drawn = SVG.parse(path, ppi=96)
    layers = {}
    for layer in drawn:
        bounds = layer.bbox() if layer.id is not None else None
        if bounds is not None:
            layers[layer.id] = tuple(np.array(bounds) * 25.4 / 96)
    return sides, layers


@pytest.mark.parametrize(
    "made",
    [
        "skeleton-exact --layers polygons --what offset -d 60",
        "skeleton-exact --layers polygons --side exterior",
        "skeleton-approx --layers polygons --step 2",
        "voronoi --layers objects",
        "draw --layers shape",
    ],
)
def test_all_results_of_one_drawing_register(run, tmp_path, part, made):
    run(f"{made} {part} -o made.svg")
    sides, layers = page(tmp_path / "made.svg")
    assert sides == SHEET
    assert layers.popitem()[1] == pytest.approx(RECTANGLE, abs=1e-3)


@pytest.mark.parametrize(("scale", "factor"), [("1:1", 1), ("1:2", 0.5), ("3", 3)])
def test_a_scale_keeps_the_page_of_the_drawing(run, tmp_path, part, scale, factor):
    run(f"skeleton-exact {part} --scale {scale} -o made.svg")
    sides, layers = page(tmp_path / "made.svg")
    assert sides == pytest.approx(np.array(SHEET) * factor)
    assert layers["polygons"] == pytest.approx(np.array(RECTANGLE) * factor, abs=1e-3)


@pytest.mark.parametrize("side", ["interior", "both"])
def test_a_frame_is_the_page(run, tmp_path, part, side):
    run(f"skeleton-exact {part} --frame 10,20,120,60 --side {side} -o made.svg")
    sides, layers = page(tmp_path / "made.svg")
    assert sides == (120, 60)
    assert layers["polygons"] == pytest.approx((10, 10, 90, 50), abs=1e-3)


@pytest.mark.parametrize(
    ("command", "data"),
    [
        *((command, "POLYGON ((2 3, 8 3, 8 5, 2 5, 2 3))") for command in ("skeleton-exact", "draw")),
        *((command, "x,y\n2,3\n8,3\n8,5\n") for command in ("delaunay", "alphashape -r 9 --layers points")),
    ],
)
def test_frames_are_pages_in_every_command(run, tmp_path, command, data):
    run(f"{command} - --scale 4 --frame 0,0,10,20 -o made.svg --y-up", data=data.encode())
    sides, _ = page(tmp_path / "made.svg")
    assert sides == (40, 80)


def dxf(folder, number):
    drawing = ezdxf.new(units=number)
    drawing.modelspace().add_lwpolyline([(0, 0), (10, 0), (10, 5), (0, 5)], close=True)
    drawing.saveas(folder / "part.dxf")


@pytest.mark.parametrize(("number", "millimeters"), [(4, 1), (5, 10), (1, 25.4)])
def test_drawings_in_dxf_are_drawn_at_their_size(run, tmp_path, number, millimeters):
    dxf(tmp_path, number)
    run("skeleton-exact part.dxf -o made.svg")
    sides, layers = page(tmp_path / "made.svg")
    assert sides == pytest.approx((10.4 * millimeters, 5.4 * millimeters))  # with a margin of 2 %
    left, top, right, bottom = layers["polygons"]
    assert (right - left, bottom - top) == pytest.approx((10 * millimeters, 5 * millimeters), abs=1e-3)


def test_a_drawing_without_a_unit_has_pixels(run, tmp_path):
    (tmp_path / "px.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="5 5 100 60"><path d="M10 10h50v20h-50z"/></svg>'
    )
    run("skeleton-exact px.svg -o made.svg")
    assert ET.parse(tmp_path / "made.svg").getroot().get("width") == "1000"
    run("skeleton-exact px.svg --unit mm -o made.svg")
    sides, layers = page(tmp_path / "made.svg")
    assert sides == (100, 60)
    assert layers["polygons"] == pytest.approx((5, 5, 55, 25), abs=1e-3)


def test_a_drawing_larger_than_any_page_has_pixels(run, tmp_path):
    dxf(tmp_path, 7)  # km
    run("skeleton-exact part.dxf -o made.svg")
    assert ET.parse(tmp_path / "made.svg").getroot().get("width") == "1000"


def test_images_to_scale_have_the_page_of_the_image(run, tmp_path):
    mask = np.zeros((20, 30), dtype=np.uint8)
    mask[5:10, 4:20] = 255
    Image.fromarray(mask).save(tmp_path / "mask.png")
    run("skeleton-exact mask.png --scale 2 -o made.svg")
    sides, layers = page(tmp_path / "made.svg")
    assert sides == (60, 40)
    assert layers["polygons"] == pytest.approx((8, 10, 40, 20), abs=1e-3)
