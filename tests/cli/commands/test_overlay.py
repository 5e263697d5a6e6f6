"""``--overlay``: pictures of every command over an image, at its size."""

import re

import numpy as np
import pytest
import tifffile
from PIL import Image
from scipy import ndimage

from support.documents import DATA

BLOBS = DATA / "blobs.png"
COMMANDS = {
    "tessellate": (BLOBS, "--what", "color"),
    "delaunay cells": (BLOBS, "--what", "cells"),
    "delaunay digital": (BLOBS, "--method", "digital"),
    "alphashape": (BLOBS, "--what", "polygons", "-q"),
    "skeleton-exact": (BLOBS,),
    "draw": (DATA / "cells.png",),
}


@pytest.fixture
def photo(folder):
    """A grey picture of the size of the mask."""
    Image.fromarray(np.full((200, 300), 77, dtype=np.uint8)).save(folder / "photo.png")
    ramp = np.linspace(0, 255, 300).astype(np.uint8)[None].repeat(200, axis=0)
    Image.fromarray(np.stack([ramp, ramp // 2, 255 - ramp], axis=2)).save(folder / "photo.png")
    return folder / "photo.png"


def test_a_point_is_drawn_where_its_pixel_is(run, folder, photo):
    (folder / "dots.csv").write_text("x,y\n10,20\n150.5,100\n")
    run("delaunay dots.csv --layers points --overlay photo.png -o a.svg")
    places = re.findall(r'<circle cx="([\d.]+)" cy="([\d.]+)"', (folder / "a.svg").read_text())
    assert places == [("10.5", "20.5"), ("151", "100.5")]


def test_labels_in_a_window_lie_there(run, folder, photo):
    (folder / "dots.csv").write_text("x,y\n12,22\n")
    options = ("--window", "10,20,5,5", "--what", "color", "--layers", "cells", "--overlay", "photo.png")
    run("tessellate dots.csv", *options, "-o", "a.png")
    made, image = (np.asarray(Image.open(folder / path)) for path in ("a.png", "photo.png"))
    y, x = np.nonzero((made != image).any(axis=2))
    assert (x.min(), x.max(), y.min(), y.max()) == (10, 14, 20, 24)
    run("tessellate dots.csv", *options, "-o", "a.svg")
    assert 'translate(10 20)"' in (folder / "a.svg").read_text()


def test_the_diagram_is_drawn_over_the_image(run, folder, photo):
    run(f"tessellate {BLOBS} --what diagram --overlay photo.png -o a.png")
    made, image = (np.asarray(Image.open(folder / path)) for path in ("a.png", "photo.png"))
    changed = (made != image).any(axis=2)
    is_line, is_edge = (made == 0).all(axis=2), (made == 255).all(axis=2)
    assert not (changed & ~is_line & ~is_edge).any()
    assert 0.01 < is_line.mean() < 0.1
    assert (is_edge == ndimage.binary_dilation(is_line, np.ones((3, 3))) & ~is_line).all()


LINES = {
    "delaunay cells": (BLOBS, "--what", "cells", "--layers", "diagram"),
    "alphashape hull": (BLOBS, "-q", "--what", "hull", "--layers", "hull"),
    "skeleton-exact": (BLOBS,),
    "skeleton-exact offset": (BLOBS, "--what", "offset", "-d", "-3"),
    "tessellate": (BLOBS, "--what", "diagram"),
}


@pytest.mark.parametrize("ground", [0, 255])
@pytest.mark.parametrize("name", LINES)
def test_lines_show_on_dark_and_on_light_ground(run, folder, name, ground):
    Image.fromarray(np.full((200, 300), ground, np.uint8)).save(folder / "even.png")
    run(name.split()[0], *LINES[name], "--overlay", "even.png", "-o", "a.png")
    grey = np.asarray(Image.open(folder / "a.png").convert("L")).astype(int)
    assert (np.abs(grey - ground) > 100).mean() > 0.002


def test_geojson_over_an_image_has_y_downwards(run, folder, photo):
    square = '{"type": "Polygon", "coordinates": [[[0, 0], [20, 0], [20, 10], [0, 10], [0, 0]]]}'
    (folder / "a.geojson").write_text(square)
    run("skeleton-exact a.geojson -q --overlay photo.png -o a.png")
    made, image = (np.asarray(Image.open(folder / path)) for path in ("a.png", "photo.png"))
    y, x = np.nonzero((made != image).any(axis=2))
    assert (x.max() <= 22, y.max() <= 12) == (True, True)  # with the edge of the lines


@pytest.mark.parametrize("name", ["tessellate", "alphashape", "draw"])
def test_an_image_of_another_size_is_noted(run, folder, photo, name):
    Image.new("L", (50, 40)).save(folder / "small.png")
    said = run(name.split()[0], *COMMANDS[name], "--overlay", "photo.png", "-o", "a.png").err
    done = run(name.split()[0], *COMMANDS[name], "--overlay", "small.png", "-o", "a.png")
    with Image.open(COMMANDS[name][0]) as image:
        size = " x ".join(map(str, image.size))
    words = f"note: small.png has 50 x 40 pixels, the input {size}: "
    assert words in done.err or "-q" in COMMANDS[name]
    assert ("the input" in said) == (size != "300 x 200")


# ---- colors of the image, and of what is drawn


@pytest.mark.parametrize("kind", ["palette", "miniswhite"])
def test_an_overlaid_tiff_is_drawn_as_it_is_seen(run, folder, kind):
    values = np.arange(60_000, dtype=np.uint32).reshape(200, 300) % 256
    ramp = np.arange(256, dtype=np.uint16) * 257
    colors = np.stack([ramp, ramp[::-1], ramp // 2]) if kind == "palette" else np.stack([ramp[::-1]] * 3)
    more = {"colormap": colors} if kind == "palette" else {}
    tifffile.imwrite(folder / "seen.tif", values.astype(np.uint8), photometric=kind, **more)
    (folder / "dots.csv").write_text("x,y\n0,0\n")
    run("delaunay dots.csv --layers points --overlay seen.tif -o a.png")
    made = np.asarray(Image.open(folder / "a.png"))
    assert (made[10:] == (colors >> 8).astype(np.uint8).T[values[10:]]).all()


def test_areas_over_each_other_mix_with_the_image_as_in_svg(run, folder, photo):
    (folder / "two.wkt").write_text(
        "POLYGON ((50 50,90 50,90 90,50 90,50 50))\nPOLYGON ((200 50,240 50,240 90,200 90,200 50))\n"
    )
    cell, inside = (100, 70), (70, 70)  # x and y beside and in the first one
    run("voronoi two.wkt --frame 0,0,300,200 --overlay photo.png -o a.svg")
    fills = re.findall(r'id="cell-1"[^>]* fill="#(\w{6})"', (folder / "a.svg").read_text())
    color = np.array(list(bytes.fromhex(fills[0])))
    run("voronoi two.wkt --frame 0,0,300,200 --overlay photo.png -o a.png")
    made, image = (np.asarray(Image.open(folder / path)).astype(float) for path in ("a.png", "photo.png"))
    assert np.abs(made[cell[::-1]] - (image[cell[::-1]] + color) / 2).max() <= 1
    assert np.abs(made[inside[::-1]] - ((image[inside[::-1]] + color) / 2 + 255) / 2).max() <= 1


def test_objects_over_regions_mix_with_the_image_as_in_svg(run, folder, photo):
    labels = np.zeros((200, 300), np.uint8)
    labels[50:90, 50:90], labels[50:90, 200:240] = 1, 2
    Image.fromarray(labels).save(folder / "labels.png")
    typed = "tessellate labels.png --what color --layers cells,objects --color objects=#204060 --overlay photo.png -o"
    run(f"{typed} a.svg")
    fills = re.findall(r'id="cell-1" fill="#(\w{6})"', (folder / "a.svg").read_text())
    color = np.array(list(bytes.fromhex(fills[0])))
    run(f"{typed} a.png")
    made, image = (np.asarray(Image.open(folder / path)).astype(float) for path in ("a.png", "photo.png"))
    assert np.abs(made[70, 30] - (image[70, 30] + color) / 2).max() <= 1
    assert np.abs(made[70, 70] - ((image[70, 70] + color) / 2 + (0x20, 0x40, 0x60)) / 2).max() <= 1
