"""Pictures and pages of ``vorotool voronoi``."""

import json
import re
import warnings
from pathlib import Path

import imageio.v3 as iio
import numpy as np
import pytest
from PIL import Image

import vorotool
from vorotool import VorotoolWarning

LAKES = Path("data/great-lakes.geojson").resolve()
LABELS = np.kron(np.array([[0, 1, 0, 2], [0, 1, 0, 0], [3, 0, 0, 2]], dtype=np.uint8), np.ones((6, 6), dtype=np.uint8))


@pytest.fixture
def labels(folder):
    Image.fromarray(LABELS).save(folder / "labels.png")
    return folder / "labels.png"


def test_svg_is_that_of_the_library(run, folder):
    done = run("voronoi", LAKES, "-o", "a.svg", "--layers", "cells,edges,labels", "--max-distance", "2")
    assert done.code == 0
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        cells = vorotool.voronoi(vorotool.read(LAKES), max_distance=2)
    vorotool.write(cells, folder / "b.svg", layers=["cells", "edges", "labels"])
    text = (folder / "a.svg").read_text()
    assert text == (folder / "b.svg").read_text()
    assert re.search(r"A[\d.]+ [\d.]+ 0 0 ", text)


def test_names_legend_and_colors(run, folder):
    looks = ("--label-by", "name", "--legend", "--scale-bar", "--color", "objects=red", "--background", "none")
    assert run("voronoi", LAKES, "-o", "a.svg", *looks).code == 0
    text = (folder / "a.svg").read_text()
    assert all(f">{name}</text>" in text for name in ("Lake Huron", "objects", "cells"))
    assert '<g id="objects" fill="none" stroke="#ff0000"' in text
    assert run("voronoi", LAKES, "-o", "a.png", "--width", "200", *looks).code == 0
    assert iio.imread(folder / "a.png").shape[1:] == (200, 4)
    done = run("voronoi", LAKES, "-o", "a.svg", "--color", "walls=red")
    assert (done.code, "the picture has cells, edges, objects, labels" in done.err) == (2, True)


def test_borders_over_an_image(run, labels, folder):
    done = run("voronoi", labels, "--what", "edges", "--overlay", labels, "-o", "a.png", "--layers", "edges")
    assert done.code == 0
    picture = iio.imread(folder / "a.png")
    assert picture.shape[:2] == LABELS.shape
    assert (picture == picture[..., :1]).all()  # grey objects, and dark lines with white edges
    assert len(np.unique(picture)) > 3


@pytest.mark.parametrize("options", [("--pixel-size", "0.5um"), ("--clip", LAKES)])
def test_a_page_names_cells(run, folder, options):
    done = run("voronoi", LAKES, "-q", "-o", "a.html", *options)
    assert done.code == 0
    data = json.loads(re.search(r"const data = (.*);\n", (folder / "a.html").read_text())[1])
    assert data["ids"] == ["1", "2", "3"]
    columns = {each["name"]: each["values"] for each in data["columns"]}
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        cells = vorotool.voronoi(vorotool.read(LAKES), clip=vorotool.read(LAKES) if "--clip" in options else None)
    scale = 0.5 if "--pixel-size" in options else 1
    assert columns["own_area"] == pytest.approx(scale**2 * cells.own_areas)
    assert columns["max_distance"] == pytest.approx(scale * cells.reaches, abs=1e-9)
    assert columns["name"] == ["Lake Michigan", "Lake Superior", "Lake Huron"]


def test_tables_have_the_measures(run, labels):
    rows = run("voronoi", labels, "--what", "table").rows
    assert list(rows[0]) == ["label", "id", "area", "perimeter", "neighbors", "own_area", "max_distance", "components"]
    assert [float(row["own_area"]) for row in rows] == np.bincount(LABELS.ravel())[1:].tolist()
    rows = run("voronoi", labels, "--what", "neighbors", "--pixel-size", "2").rows
    assert list(rows[0]) == ["label_a", "label_b", "border_length", "distance"]
    assert [float(row["distance"]) for row in rows] == [
        12,
        0,
    ]  # 1 and 3 meet at a corner; 2 and 3 only beyond the image
