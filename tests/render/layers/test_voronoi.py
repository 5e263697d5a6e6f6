"""Pictures of Voronoi maps: what is drawn is where the cells are, with their curves."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import imageio.v3 as iio
import numpy as np
import pytest
import shapely
import svgelements
from tests.support.families.site_families import mixed_sites

import vorotool
from support.oracles.voronoi_oracle import quietly
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool import UsageError, voronoi
from vorotool.render.canvas.layers import CurvedPolygons, Curves, Texts, page_of
from vorotool.render.canvas.styles import cell_color
from vorotool.render.canvas.svg import write_layers_svg
from vorotool.render.layers.voronoi import map_colors, voronoi_layers

SVG = "{http://www.w3.org/2000/svg}"

LAYERS = ("cells", "edges", "objects", "labels")


def drawn(cells, *layers, width=1000):
    page = page_of(cells, width=width)
    return voronoi_layers(cells, page, layers), page


def svg_of(layers, page):
    return ElementTree.fromstring(bytes_of(write_layers_svg, layers, page).decode())


def outline(path):
    """Places along a path, ring by ring, as another library takes it."""
    rings = []
    for part in svgelements.Path(path).as_subpaths():
        sides = [each for each in part if isinstance(each, svgelements.QuadraticBezier | svgelements.Arc)]
        t = np.linspace(0, 1, 65 if sides else 2)
        rings.append(np.concatenate([each.npoint(t[:-1]) for each in part if not isinstance(each, svgelements.Move)]))
    return rings


def signed_area(ring):
    x, y = ring.T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("limit", [None, 7])
def test_paths_have_the_areas_of_cells(seed, limit):
    cells = quietly(mixed_sites(np.random.default_rng(seed), 9), max_distance=limit)
    layers, page = drawn(cells, "cells")
    scale = page.length(1.0)
    found = np.zeros(len(cells))
    for path in svg_of(layers, page).iter(f"{SVG}path"):
        number = int(path.get("id").split("-")[1]) - 1
        found[number] -= sum(map(signed_area, outline(path.get("d"))))
    np.testing.assert_allclose(found / scale**2, cells.areas, atol=2e-4 * cells.areas.sum())


def test_curves_are_drawn_as_such():
    sites = [shapely.LineString([(0, 0), (8, 0)]), shapely.Point(4, 2)]
    text = ElementTree.tostring(svg_of(*drawn(voronoi(sites, max_distance=1.5), "cells", "edges"))).decode()
    assert text.count("Q") == 3  # of both cells, and between them
    assert len(re.findall(r"A[\d.]+ [\d.]+ 0 0 [01] ", text)) > 6
    straight = ElementTree.tostring(svg_of(*drawn(voronoi([[0, 0], [4, 1]]), "cells", "edges"))).decode()
    assert not re.search('"[^"]*d="M[^"]*[QA]', straight)


@pytest.mark.parametrize("limit", [None, 6])
def test_pixels_have_the_colors_of_their_cells(tmp_path, limit):
    cells = quietly(mixed_sites(np.random.default_rng(2), 12), max_distance=limit)
    vorotool.write(cells, tmp_path / "a.png", layers=["cells"], background="#000000", width=500)
    pixels = iio.imread(tmp_path / "a.png")
    page = page_of(cells, width=500)
    x, y, w, h = cells.frame
    places = np.array([x, y]) + np.random.default_rng(0).random((800, 2)) * [w, h]
    shapes = cells.to_shapely()
    points = shapely.points(places)
    near = 3 * page.distance(1.0)
    clear = shapely.distance(shapely.boundary(shapes)[:, None], points).min(axis=0) > near
    assert clear.sum() > 300
    colors = [bytes.fromhex(cell_color(each)[1:]) for each in map_colors(cells).tolist()]
    column, row = np.floor(page.place(places[clear])).astype(int).T
    found = np.full(len(places), -1)
    at, cell = shapely.STRtree(shapes).query(points, predicate="within")
    found[at] = cell
    expected = [list(colors[k]) if k >= 0 else [0, 0, 0] for k in found[clear].tolist()]
    np.testing.assert_array_equal(pixels[row, column], expected)


@pytest.mark.parametrize("seed", range(4))
def test_neighbors_never_share_a_color(seed):
    sites = mixed_sites(np.random.default_rng(seed), 40)
    cells = quietly(sites, by=[k % 25 for k in range(40)])
    colors = map_colors(cells)
    pairs = np.stack([cells.neighbors[name] - 1 for name in ("label_a", "label_b")])
    assert (colors[pairs[0]] != colors[pairs[1]]).all()
    assert 1 <= colors.min() <= colors.max() <= 12


def test_layers_of_all_kinds_of_sites():
    sites = [shapely.box(0, 0, 2, 2), shapely.LineString([(4, 0), (4, 3), (6, 3)]), shapely.Point(8, 1)]
    cells = voronoi(sites)
    layers, _ = drawn(cells, *LAYERS)
    assert [layer.name for layer in layers] == ["cells", "edges", "object-areas", "objects", "object-points", "labels"]
    assert isinstance(layers[0], CurvedPolygons)
    assert isinstance(layers[1], Curves)
    outlines = layers[3].points[layers[3].pairs]
    assert np.hypot(*(outlines[:, 1] - outlines[:, 0]).T).sum() == 8 + 5
    names = layers[5]
    assert isinstance(names, Texts)
    assert names.texts == ["1", "2", "3"]
    assert names.is_centered
    assert all(shapely.distance(sites[:2], shapely.points(names.points[:2])) < 1e-9)
    assert names.points[2, 0] == 8  # above the disc
    assert names.points[2, 1] > 1
    assert names.points[1].tolist() == [4, 2.5]
    points, _ = drawn(voronoi([[0, 0], [4, 1]]), "objects", "labels")
    assert [layer.name for layer in points] == ["objects", "labels"]
    assert not points[1].is_centered


def test_colors_and_widths_are_those_chosen(tmp_path):
    cells = voronoi([shapely.box(0, 0, 2, 2), shapely.Point(8, 1)])
    style = {"color": {"edges": "navy", "objects": "red"}, "line_width": {"edges": 3}, "background": "none"}
    vorotool.write(cells, tmp_path / "a.svg", what="edges", **style)
    text = (tmp_path / "a.svg").read_text()
    assert '<g id="edges" fill="none" stroke="#000080" stroke-width="3"' in text
    assert '<g id="objects" fill="none" stroke="#ff0000"' in text
    assert '<g id="object-points" fill="#ff0000"' in text
    assert "<rect" not in text


@pytest.mark.parametrize("sites", [[], [[0, 0]], [[0, 0], [0, 0]], [BOX := shapely.box(0, 0, 1, 1), BOX]])
@pytest.mark.parametrize("fmt", ["svg", "png"])
def test_few_and_empty_cells(tmp_path, sites, fmt):
    cells = voronoi(sites)
    vorotool.write(cells, tmp_path / f"a.{fmt}", layers=LAYERS, width=200)
    if fmt == "svg":
        ElementTree.fromstring((tmp_path / "a.svg").read_text())
    else:
        assert iio.imread(tmp_path / "a.png").shape[1] == 200


def test_names_say_what_a_column_says(tmp_path):
    lakes = vorotool.read("data/great-lakes.geojson")
    cells = quietly(lakes)
    vorotool.write(cells, tmp_path / "a.svg", label_by="name", legend=True, scale_bar=True)
    text = (tmp_path / "a.svg").read_text()
    for name in ("Lake Superior", "Lake Huron", "Lake Michigan", "object-areas"):
        assert f">{name}</text>" in text
    with pytest.raises(UsageError, match="expected a column of the input, name"):
        vorotool.write(cells, tmp_path / "a.svg", label_by="depth")
    refused(UsageError, "'walls'", vorotool.write, cells, tmp_path / "a.svg", layers=["walls"])
