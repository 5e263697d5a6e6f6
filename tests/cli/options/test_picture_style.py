"""``--scale``, ``--unit``, ``--background``, ``--color``, ``--line-width``: what they do, and what is refused."""

import re

import numpy as np
import pytest
from PIL import Image

import vorotool

PICTURES = {
    "skeleton-exact": ["shapes.json"],
    "skeleton-approx": ["shapes.json", "--step", "1"],
    "delaunay": ["dots.csv"],
    "alphashape": ["dots.csv", "-r", "9"],
    "draw": ["shapes.json"],
}
LAYER = {"delaunay": "edges", "alphashape": "boundary", "draw": "shape"}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "shapes.json").write_text("[[[0, 0], [40, 0], [40, 30], [0, 30]]]")
    (tmp_path / "dots.csv").write_text("0,0\n9,0\n9,7\n2,8\n5,3\n")
    logo = '<svg xmlns="http://www.w3.org/2000/svg" width="50mm" viewBox="0 0 50 40"><path d="M2 2h40v30h-40z"/></svg>'
    (tmp_path / "logo.svg").write_text(logo)
    return tmp_path


@pytest.mark.parametrize("command", PICTURES)
def test_looks(run, folder, command):
    layer = LAYER.get(command, "skeleton")
    plain = run(command, *PICTURES[command], "-f", "svg")
    assert plain.code == 0, plain.err
    style = ["--color", f"{layer}=navy", "--line-width", f"{layer}=0.25", "--background", "none"]
    done = run(command, *PICTURES[command], "-f", "svg", *style)
    assert done.code == 0, done.err
    assert 'stroke="#000080"' in done.out or 'fill="#000080"' in done.out
    assert 'stroke-width="0.25"' in done.out
    assert "<rect" in plain.out
    assert "<rect" not in done.out
    paths = [re.findall(r' d="([^"]*)"', text) for text in (plain.out, done.out)]
    assert paths[0] == paths[1]


@pytest.mark.parametrize(
    ("source", "options", "size"),
    [
        ("shapes.json", ["--scale", "0.5"], 20),
        ("shapes.json", ["--scale", "1:10", "--unit", "cm"], 40),
        ("shapes.json", ["--unit", "in"], 1016),
        ("logo.svg", ["--scale", "1:2"], 20),
        ("logo.svg", ["--scale", "3"], 120),
        ("logo.svg", ["--scale", "1:1", "--unit", "cm"], 400),
    ],
)
@pytest.mark.parametrize("what", [[], ["--what", "offset", "-d", "-1"], ["--what", "shape"]])
def test_pictures_to_scale(run, folder, source, options, size, what):
    done = run("skeleton-exact", source, *what, "-o", "out.svg", "--background", "none", "-q", *options)
    assert done.code == 0, done.err
    shapes = vorotool.read("out.svg")
    assert shapes.unit == "mm"
    assert np.ptp(shapes.ring(0), axis=0) == pytest.approx([size, 0.75 * size], abs=1e-3)


def test_colors_of_png(run, folder):
    done = run(
        "draw", "shapes.json", "-o", "out.png", "--color", "shape=#123456", "--background", "#abcdef", "--width", "400"
    )
    assert done.code == 0, done.err
    pixels = np.asarray(Image.open("out.png").convert("RGB"))
    assert pixels[1, 1].tolist() == [0xAB, 0xCD, 0xEF]
    assert pixels[pixels.shape[0] // 2, 200].tolist() == [0x12, 0x34, 0x56]


def test_many(run, folder):
    (folder / "more.json").write_text("[[[0, 0], [4, 0], [0, 3]]]")
    style = ["--color", "skeleton=red", "--color", "polygons=blue", "--scale", "2"]
    done = run("skeleton-exact", "shapes.json", "more.json", "--out-dir", "out", "-f", "svg", "-q", *style, "-j", "2")
    assert done.code == 0, done.err
    alone = run("skeleton-exact", "more.json", "-f", "svg", *style)
    assert (folder / "out/more.svg").read_text() == alone.out
    again = run("skeleton-exact", "shapes.json", "more.json", "--out-dir", "out", "-f", "svg", *style, "--resume")
    assert again.code == 0, again.err


REFUSED = [
    (["-f", "json", "--scale", "2"], "--scale"),
    (["-f", "png", "--scale", "2"], "--scale"),
    (["-f", "svg", "--scale", "2", "--width", "100"], "--width"),
    (["-f", "svg", "--scale", "2", "--unit", "mm"], "--scale"),
    (["-f", "svg", "--scale", "1:2"], "--scale"),
    (["-f", "svg", "--scale", "1e9"], "the page would be"),
    (["-f", "svg", "--color", "cells=red"], "--color"),
    (["-f", "svg", "--scale", "2:1"], "'2:1'"),
    (["-f", "svg", "--color", "skeleton=nocolor"], "'nocolor'"),
    (["-f", "svg", "--color", "red"], "'red'"),
    (["-f", "svg", "--line-width", "skeleton=-1"], "'-1'"),
]


@pytest.mark.parametrize(("options", "message"), REFUSED)
def test_what_is_refused(run, folder, options, message):
    done = run("skeleton-exact", "shapes.json", *options)
    assert done.code == 2
    assert message in done.err
    assert not done.out


def test_label_images_have_no_layers_to_color(run, folder):
    Image.fromarray(np.array([[0, 3], [7, 7]], dtype=np.uint8)).save("labels.png")
    done = run("draw", "labels.png", "-f", "svg", "--scale", "2")
    assert done.code == 2
    assert "--scale" in done.err


def test_pictures_over_images_keep_their_size(run, folder):
    Image.new("RGB", (50, 40)).save("photo.png")
    done = run("draw", "shapes.json", "-f", "svg", "--overlay", "photo.png", "--scale", "2")
    assert (done.code, "--overlay" in done.err) == (2, True)
    done = run("draw", "shapes.json", "-f", "svg", "--overlay", "photo.png", "--background", "red")
    assert (done.code, "--background" in done.err) == (2, True)
    done = run("draw", "shapes.json", "-f", "svg", "--overlay", "photo.png", "--color", "shape=red")
    assert (done.code, "#ff0000" in done.out) == (0, True)
