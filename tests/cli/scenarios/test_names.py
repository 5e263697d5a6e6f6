"""``--layers labels``: the ids of objects and sites, once each, in SVG and PNG."""

import json
import re

import numpy as np
import pytest


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


@pytest.mark.parametrize("command", ["draw", "skeleton-exact"])
def test_objects_have_their_ids_once(run, folder, objects, command):
    run(f"{command} objects.npy --layers {'labels' if command == 'draw' else 'polygons,skeleton,labels'} -o a.svg")
    assert sorted(text for _, _, text in texts(folder / "a.svg")) == ["12", "3", "700"]
    assert 'paint-order="stroke"' in (folder / "a.svg").read_text()


def test_ids_are_inside_their_objects(run, folder, objects):
    run("draw objects.npy --layers labels -o a.svg")
    scale = 1000 / (80 + 2 * 0.02 * 80)
    for x, y, text in texts(folder / "a.svg"):
        column, row = (int(float(k) / scale - 0.02 * 80) for k in (x, y))
        assert objects[row, column] == int(text)


def test_ids_of_features_may_be_texts(run, folder):
    ring = [[0, 0], [9, 0], [0, 9], [0, 0]]
    far = [[x + 20, y] for x, y in ring]
    features = [
        {"type": "Feature", "id": "<lake> é", "geometry": {"type": "Polygon", "coordinates": [ring]}},
        {"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [far]}},
    ]
    (folder / "a.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    for fmt in ("svg", "png"):
        run(f"skeleton-exact a.geojson --layers polygons,labels -o a.{fmt}")
    assert [text for _, _, text in texts(folder / "a.svg")] == ["&lt;lake&gt; é", "1"]
