"""``--layers labels``: the ids of objects and sites, once each, in SVG and PNG."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

DOTS = Path(__file__).parents[3] / "data" / "dots.csv"


@pytest.fixture
def objects(folder):
    """Three objects, of which two touch, in an image that is too large for a number a pixel."""
    image = np.zeros((60, 80), np.uint16)
    image[5:25, 5:30] = 3
    image[5:25, 30:60] = 12
    image[35:55, 20:50] = 700
    np.save(folder / "objects.npy", image)
    return image


def texts(path):
    group = re.search(r'<g id="labels"[^>]*>\n(.*?)</g>', path.read_text(), re.DOTALL)
    return [] if group is None else re.findall(r'<text x="([\d.]+)" y="([\d.]+)">([^<]*)</text>', group[1])


@pytest.mark.parametrize("command", ["draw", "tessellate", "skeleton-exact", "skeleton-approx --step 2"])
def test_objects_have_their_ids_once(run, folder, objects, command):
    name, *options = command.split()
    layers = {"draw": "labels", "tessellate": "cells,seeds,labels"}.get(name, "polygons,skeleton,labels")
    assert run(name, "objects.npy", *options, "--layers", layers, "-o", "a.svg").code == 0
    assert sorted(text for _, _, text in texts(folder / "a.svg")) == ["12", "3", "700"]
    assert 'paint-order="stroke"' in (folder / "a.svg").read_text()


def test_ids_are_inside_their_objects(run, folder, objects):
    run("draw", "objects.npy", "--layers", "labels", "-o", "a.svg")
    scale = 1000 / (80 + 2 * 0.02 * 80)
    for x, y, text in texts(folder / "a.svg"):
        column, row = (int(float(k) / scale - 0.02 * 80) for k in (x, y))
        assert objects[row, column] == int(text)


@pytest.mark.parametrize("mode", [None, "pixels", "centroids", "components"])
def test_ids_of_a_tessellation_are_on_the_objects(run, folder, objects, mode):
    small = np.zeros((60, 80), np.uint16)
    small[5:11, 4:10] = 3
    small[50, 70:79] = 12
    np.save(folder / "small.npy", small)
    seeds = ("--seeds", mode) if mode else ()
    assert run("tessellate", "small.npy", *seeds, "--layers", "labels", "-o", "a.svg", "-f", "svg").code == 0
    scale = 1000 / (80 + 2 * 0.02 * 80)
    found = texts(folder / "a.svg")
    assert len(found) == (45 if mode == "pixels" else 2)
    for x, y, _ in found:
        column, row = (int(float(k) / scale - 0.02 * 80) for k in (x, y))
        assert small[row, column]


@pytest.mark.parametrize(
    ("command", "layers", "options"),
    [
        ("draw", "cells", ()),
        ("tessellate", "cells,seeds", ("--what", "color")),
        ("skeleton-exact", "polygons,skeleton", ()),
    ],
)
def test_png_pictures_show_them_too(run, folder, objects, command, layers, options):
    for name, chosen in (("without", layers), ("with", f"{layers},labels")):
        assert run(command, "objects.npy", *options, "--layers", chosen, "-o", f"{name}.png").code == 0
    without, named = (np.asarray(Image.open(folder / f"{name}.png").convert("RGB")) for name in ("without", "with"))
    changed = (without != named).any(axis=2)
    assert changed.any()
    kinds = {tuple(color) for color in np.unique(named[changed], axis=0).tolist()}
    assert (255, 255, 255) in kinds  # the halo
    assert min(map(sum, kinds)) < 110  # the letters


def test_over_a_dark_image_ids_can_be_read(run, folder, objects):
    Image.fromarray(np.zeros((60, 80), np.uint8)).save(folder / "dark.png")
    options = ("--what", "color", "--layers", "labels", "--overlay", "dark.png")
    assert run("tessellate", "objects.npy", *options, "-o", "a.png").code == 0
    shown = np.asarray(Image.open(folder / "a.png").convert("L"))
    assert np.unique(shown).tolist() == [0, 255]


def test_points_have_their_labels_beside_them(run, folder):
    for command, layers in (("delaunay", "edges,points"), ("alphashape", "polygons,points")):
        for fmt in ("svg", "png"):
            for name, chosen in (("without", layers), ("with", f"{layers},labels")):
                assert run(command, DOTS, "--layers", chosen, "-o", f"{name}.{fmt}", "--width", 500).code == 0
        assert len(texts(folder / "with.svg")) == 53
        assert (folder / "with.png").read_bytes() != (folder / "without.png").read_bytes()


def test_cells_of_points_have_one_text_each(run, folder):
    run("tessellate", DOTS, "--size", "512x512", "--layers", "cells,seeds,labels", "-o", "a.svg")
    assert sorted(int(text) for _, _, text in texts(folder / "a.svg")) == list(range(1, 54))


def test_pictures_without_a_choice_stay_as_they_were(run, folder, objects):
    for command in ("draw", "tessellate"):
        run(command, "objects.npy", "-o", "a.svg")
        assert texts(folder / "a.svg") == []
    np.save(folder / "small.npy", objects[:40, :40])
    run("draw", "small.npy", "-o", "small.svg")
    assert (folder / "small.svg").read_text().count("<text ") == 1600


def test_elements_keep_the_labels_of_the_paper(run, folder):
    (folder / "a.json").write_text("[[0,0],[9,0],[0,9]]")
    run("skeleton-exact", "a.json", "--what", "elements", "--layers", "elements,points,labels", "-o", "a.svg")
    assert len(texts(folder / "a.svg")) == 6
    assert "paint-order" not in (folder / "a.svg").read_text()


def test_ids_of_features_may_be_texts(run, folder):
    ring = [[0, 0], [9, 0], [0, 9], [0, 0]]
    far = [[x + 20, y] for x, y in ring]
    features = [
        {"type": "Feature", "id": "<lake> é", "geometry": {"type": "Polygon", "coordinates": [ring]}},
        {"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [far]}},
    ]
    (folder / "a.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    for fmt in ("svg", "png"):
        assert run("skeleton-exact", "a.geojson", "--layers", "polygons,labels", "-o", f"a.{fmt}").code == 0
    assert [text for _, _, text in texts(folder / "a.svg")] == ["&lt;lake&gt; é", "1"]
