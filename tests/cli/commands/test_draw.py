"""``vorotool draw``."""

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
import tifffile
from PIL import Image

from support.documents import DATA

SVG = "{http://www.w3.org/2000/svg}"
SHAPES = DATA / "two-shapes.json"


def test_the_picture_is_that_of_tessellate(run, folder):
    run("tessellate dots.csv -o labels.png")
    run("tessellate dots.csv --what color --layers cells -o a.png")
    run("draw labels.png -o b.png")
    assert (folder / "a.png").read_bytes() == (folder / "b.png").read_bytes()


def test_sparse_labels_have_the_colors_of_dense_ones(run, folder):
    dense = np.kron(np.arange(12, dtype=np.uint32).reshape(3, 4), np.ones((20, 30), np.uint32))
    np.save(folder / "dense.npy", dense)
    np.save(folder / "sparse.npy", dense * np.uint32(390_000_000))
    for name in ("dense", "sparse"):
        run(f"draw {name}.npy -o {name}.svg --layers cells")
    drawn = [(folder / f"{name}.svg").read_text("latin-1") for name in ("dense", "sparse")]
    assert re.sub('id="cell-[0-9]+"', "", drawn[0]) == re.sub('id="cell-[0-9]+"', "", drawn[1])
    run("tessellate sparse.npy --seeds labels --what color -o c.svg")


@pytest.mark.parametrize(
    ("options", "count", "layer", "other", "words"),
    [
        ("", '"arcs": 43', "skeleton", "cells", "nodes, labels"),
        ("--what offset -d -20,10", '"shapes": 5', "offset", "nodes", "polygons, offset, labels"),
    ],
)
def test_results_are_drawn_as_by_the_command_that_makes_them(run, folder, options, count, layer, other, words):
    run(f"skeleton-exact {SHAPES} {options} -o made.json")
    for fmt, width in (("svg", ()), ("png", ("--width", 200))):
        run(f"skeleton-exact {SHAPES} {options} -o made.{fmt}", *width)
        run(f"draw made.json -o drawn.{fmt}", *width, "--stats", f"{fmt}.json")
        assert (folder / f"drawn.{fmt}").read_bytes() == (folder / f"made.{fmt}").read_bytes()
    for said in ("json", "geojson"):  # an object is of either kind: its type tells
        run(f"draw made.json --input-format {said} -o said.svg")
        assert (folder / "said.svg").read_bytes() == (folder / "made.svg").read_bytes()
    assert count in (folder / "svg.json").read_text()
    assert re.findall(r'<g id="(\w+)"', run(f"draw made.json --layers {layer} -f svg").out) == [layer]
    run(f"draw made.json --layers {other} -o a.svg", code=2, says=words)
    run("draw made.json --page 1 -o a.svg", code=2)
    (folder / "made.json").write_text((folder / "made.json").read_text()[:-50])
    run("draw made.json -o a.svg", code=3, says="made.json")


def test_an_array_of_two_columns_is_an_image(run, folder):
    np.save(folder / "two.npy", np.array([[1, 2], [1, 2], [3, 3]], dtype=np.uint8))
    run("draw two.npy -o a.png")
    assert np.asarray(Image.open(folder / "a.png")).shape == (3, 2)
    np.save(folder / "four.npy", np.zeros((2, 3, 4, 5), dtype=np.uint8))
    assert "cannot be drawn" not in run("draw four.npy -o a.png", code=3, says="four.npy").err


@pytest.mark.parametrize(
    ("content", "code", "words"),
    [
        (b"", 3, "a.json"),
        (b'{"polygons":[]}', 0, "warning: the picture is empty: the input (polygons or lines)"),
        (b'{"type":"FeatureCollection","features":[]}', 0, "warning: the picture is empty"),
        (b'{"type":"vorotool.offsets","version":2}', 3, "vorotool.offsets"),
    ],
)
def test_what_is_said_of_shapes(run, folder, content, code, words):
    (folder / "a.json").write_bytes(content)
    run("draw a.json -o a.svg", code=code, says=words)
    assert (folder / "a.svg").exists() == (code == 0)


@pytest.mark.parametrize(("dtype", "value"), [(bool, 1), (np.uint8, 255), (np.uint16, 1)])
def test_objects_of_a_mask_have_their_own_colors(run, folder, dtype, value):
    mask = np.zeros((50, 60), np.uint16)
    mask[5:20, 5:20] = mask[5:20, 35:50] = mask[30:45, 5:50] = value
    np.save(folder / "mask.npy", mask.astype(dtype))
    done = run("draw mask.npy --layers cells,labels -o a.svg")
    note = f"note: {value} is the only value besides 0, and read as a mask: each of its objects is drawn separately\n"
    assert done.err == (note if dtype == np.uint16 else "")
    cells = re.findall(r'<path id="(cell-\d+)" fill="(#\w+)"', (folder / "a.svg").read_text())
    assert [name for name, _ in cells] == ["cell-1", "cell-2", "cell-3"]
    assert len({color for _, color in cells}) == 3
    np.save(folder / "labels.npy", np.where(mask, 7, 0).astype(np.uint8))
    done = run("draw labels.npy -f svg")
    assert (re.findall("cell-[0-9]+", done.out), done.err) == (["cell-7"], "")


# ---- --pixel-size ------------------------------------------------------------------------------------
def bar(svg):
    """What stands at the scale bar."""
    (text,) = (each for each in ET.fromstring(svg).iter(f"{SVG}g") if each.get("id") == "scale-bar-length")
    return text.find(f"{SVG}text").text


def test_scale_bars_of_label_images_have_the_unit_of_pixels(run, tmp_path):
    labels = np.repeat(np.arange(1, 5, dtype=np.uint8), 100).reshape(4, 100).repeat(20, axis=0)
    tifffile.imwrite(tmp_path / "plain.tif", labels)
    tifffile.imwrite(tmp_path / "sized.tif", labels, imagej=True, resolution=(2, 2), metadata={"unit": "um"})
    for options, length in (
        ("plain.tif --pixel-size 0.325um", "5 µm"), ("sized.tif --pixel-size auto", "10 µm"), ("plain.tif", "20 px"),
    ):  # fmt: skip
        assert bar(run(f"draw {options} --scale-bar -f svg").out) == length
    run("draw plain.tif --pixel-size auto --scale-bar -o none.svg", code=3, says="pixel size")


def test_scale_bars_of_shapes_have_the_unit_of_coordinates(run):
    square = b"POLYGON ((0 0, 100 0, 100 100, 0 100, 0 0))"
    assert bar(run("draw - --pixel-size 2mm --scale-bar -f svg", data=square).out) == "50 mm"
    drawn = run("draw - --pixel-size 2mm --scale 1:4 -f svg", data=square).out
    assert ET.fromstring(drawn).get("width") == "52mm"
