"""``--label-by``, ``--legend``, ``--scale-bar``, ``--aspect``, ``--extent``: what is drawn, and what is refused."""

import math
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from shapely import Polygon, box

import vorotool
from support.families.geojson import collection
from vorotool.render.canvas.insets import rounded_length

NS = "{http://www.w3.org/2000/svg}"


@pytest.fixture
def folder(tmp_path):
    rows = [{"name": "Huron & <co>", "depth": 2.0}, {"name": None, "depth": 7.5}]
    (tmp_path / "shapes.geojson").write_text(collection([box(0, 0, 40, 30), box(60, 0, 100, 30)], rows))
    (tmp_path / "dots.csv").write_text("x,y,town\n0,0,Ulm\n9,0,\n9,7,Bern\n2,8,Genf\n")
    (tmp_path / "world.csv").write_text("lon,lat\n0,60\n10,60\n10,64\n0,64\n5,61\n")
    labels = np.zeros((50, 100), np.uint8)
    labels[10:20, 20:40], labels[30:45, 60:70] = 4, 9
    Image.fromarray(labels).save(tmp_path / "labels.png")
    return tmp_path


def groups(text):
    return {group.get("id"): group for group in ET.fromstring(text).iter(f"{NS}g")}


def texts(text, name="labels"):
    return [each.text for each in groups(text)[name]]


NAMED = [
    (["skeleton-exact", "shapes.geojson"], "name", ["Huron & <co>"]),
    (["skeleton-exact", "shapes.geojson", "--what", "points", "--every", "9"], "depth", ["2", "7.5"]),
    (["draw", "shapes.geojson"], "depth", ["2", "7.5"]),
    (["delaunay", "dots.csv"], "town", ["Ulm", "Bern", "Genf"]),
    (["tessellate", "dots.csv", "--size", "10x10"], "town", ["Ulm", "Bern", "Genf"]),
]


@pytest.mark.parametrize(("command", "column", "expected"), NAMED)
def test_objects_are_named_by_a_column(run, folder, command, column, expected):
    done = run(*command, "-f", "svg", "-q", "--label-by", column)
    assert sorted(texts(done.out)) == sorted(expected)
    assert groups(done.out)["labels"].get("paint-order") == "stroke"
    plain = [*command, "-q", *(["--what", "color"] if command[0] == "tessellate" else ["--width", "300"])]
    run(*plain, "-o", "plain.png")
    run(*plain, "--label-by", column, "-o", "named.png")
    assert Path("plain.png").read_bytes() != Path("named.png").read_bytes()


def test_names_lie_in_their_polygons(run, folder):
    bent = Polygon([(0, 0), (9, 0), (9, 9), (8, 9), (8, 1), (0, 1)])  # the centroid is outside
    Path("bent.geojson").write_text(collection([bent], [{"name": "L"}]))
    done = run("draw bent.geojson --label-by name -f svg")
    (text,) = groups(done.out)["labels"]
    x, y = float(text.get("x")), float(text.get("y")) - 0.36 * 16
    scale = 1000 / (9 + 2 * 0.18)
    x, y = x / scale - 0.18, 9.18 - y / scale
    assert (0 < x < 9 and 0 < y < 1) or (8 < x < 9 and 0 < y < 9)


def test_legend_has_a_row_a_layer(run, folder):
    done = run("delaunay dots.csv --layers cells,edges,points,labels --legend -f svg")
    assert texts(done.out, "legend-names") == ["points", "edges", "cells"]
    found = groups(done.out)
    assert found["legend-points"].get("fill") == found["points"].get("fill")
    assert found["legend-edges"].get("stroke") == found["edges"].get("stroke")
    drawn = run("tessellate labels.png -f svg --what color --legend --color seeds=red -q")
    assert texts(drawn.out, "legend-names") == ["seeds", "cells"]
    assert groups(drawn.out)["legend-seeds"].get("stroke") == "#ff0000"


def bar_of(text):
    """Length in px, and what is written over it."""
    found = groups(text)
    numbers = [float(number) for number in re.findall(r"[\d.]+", found["scale-bar"][0].get("d"))]
    return max(numbers[0::2]) - min(numbers[0::2]), found["scale-bar-length"][0].text


BARS = [
    (["delaunay", "dots.csv"], 1000 / (9 * 1.04), "2"),
    (["delaunay", "dots.csv", "--pixel-size", "3mm"], 1000 / (9 * 1.04) / 3, "5 mm"),
    (["skeleton-exact", "labels.png", "--pixel-size", "0.325um"], 10 / 0.325, "5 µm"),
    (["skeleton-exact", "labels.png"], 10, "20 px"),
    (["tessellate", "labels.png", "--what", "color", "--pixel-size", "0.5um"], 1000 / 104 / 0.5, "10 µm"),
    (["draw", "labels.png"], 1000 / 104, "20 px"),
]


@pytest.mark.parametrize(("command", "unit", "name"), BARS)
def test_scale_bars_are_as_long_as_they_say(run, folder, command, unit, name):
    done = run(*command, "-f", "svg", "--scale-bar", "-q")
    length, written = bar_of(done.out)
    assert written == name
    assert length == pytest.approx(float(name.split()[0]) * unit, abs=0.02)


def test_rounded_lengths():
    for longest in 10 ** np.random.default_rng(0).uniform(-30, 30, 40):
        length = rounded_length(longest)
        assert re.match(r"[125]\.0*e", f"{length:e}")
        assert longest / 2.5 < length * (1 + 1e-12)
        assert length <= longest


def test_longitude_and_latitude_have_no_bar_and_an_aspect(run, folder):
    words = "no scale bar is drawn: the length of a degree of longitude"
    done = run("delaunay world.csv -f svg --scale-bar", says=words)
    assert "scale-bar" not in groups(done.out)
    root = ET.fromstring(done.out)
    aspect = 1 / math.cos(math.radians(62))
    across, down = 10 * 1.04, 4 * aspect + 0.02 * 2 * 10
    assert int(root.get("height")) == round(1000 * down / across)
    square = ET.fromstring(run("delaunay world.csv -f svg --aspect 1").out)
    assert int(square.get("height")) == round(1000 * 4.4 / 10.4)
    run("delaunay world.csv -o out.png -q")
    with Image.open("out.png") as image:
        assert image.size == (1000, int(root.get("height")))
    mesh = vorotool.read("world.csv", geometry="points")
    vorotool.write(vorotool.delaunay(mesh), "out.svg")
    assert Path("out.svg").read_text() == run("delaunay world.csv -f svg").out


# ---- options of pictures ----------------------------------------
PICTURES = {
    "skeleton-exact": ["shapes.json"],
    "delaunay": ["dots.csv"],
    "alphashape": ["dots.csv", "-r", "9"],
    "draw": ["shapes.json"],
}
LAYER = {"delaunay": "edges", "alphashape": "boundary", "draw": "shape"}


@pytest.fixture
def folder_of_picture_style(tmp_path):
    (tmp_path / "shapes.json").write_text("[[[0, 0], [40, 0], [40, 30], [0, 30]]]")
    (tmp_path / "dots.csv").write_text("0,0\n9,0\n9,7\n2,8\n5,3\n")
    logo = '<svg xmlns="http://www.w3.org/2000/svg" width="50mm" viewBox="0 0 50 40"><path d="M2 2h40v30h-40z"/></svg>'
    (tmp_path / "logo.svg").write_text(logo)
    return tmp_path


@pytest.mark.parametrize("command", PICTURES)
def test_looks(run, folder_of_picture_style, command):
    layer = LAYER.get(command, "skeleton")
    plain = run(command, *PICTURES[command], "-f", "svg")
    style = ["--color", f"{layer}=navy", "--line-width", f"{layer}=0.25", "--background", "none"]
    done = run(command, *PICTURES[command], "-f", "svg", *style)
    assert 'stroke="#000080"' in done.out or 'fill="#000080"' in done.out
    assert 'stroke-width="0.25"' in done.out
    assert "<rect" in plain.out
    assert "<rect" not in done.out
    paths = [re.findall(r' d="([^"]*)"', text) for text in (plain.out, done.out)]
    assert paths[0] == paths[1]
