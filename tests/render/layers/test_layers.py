"""Pictures of alpha shapes, cells, meshes and skeletons."""

from __future__ import annotations

import io
import re
import xml.etree.ElementTree as ET
from itertools import pairwise

import numpy as np
import pytest
import shapely
from PIL import Image

import vorotool
from support.documents import DATA
from support.families.point_families import FAMILIES, draw
from support.few import few
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool import (
    UsageError,
    alpha_complex,
    alpha_curves,
    alpha_hull,
    alpha_shape,
    cell_colors,
    delaunay,
    voronoi_cells,
)
from vorotool.formats.images.png_writer import write_png
from vorotool.render.canvas.layers import Arcs, Curves, Lines, Page, Polygons, page_of
from vorotool.render.canvas.png import layer_bands
from vorotool.render.canvas.svg import write_layers_svg
from vorotool.render.layers.mesh import (
    alpha_layers,
    cell_lines,
    cell_polygons,
    mesh_layers,
)
from vorotool.render.layers.skeleton import diagram_layers, skeleton_layers
from vorotool.render.pages.plots import CURVES, write_curves_svg
from vorotool.types.fields import with_y_axis
from vorotool.types.table import Table

ALPHA_LAYERS = ("polygons", "delaunay", "interior", "boundary", "singular", "hull", "points", "labels")
MESH_LAYERS = ("triangles", "edges", "points", "labels")
SKELETON_LAYERS = ("polygons", "elements", "points", "skeleton", "exact", "nodes", "labels")
NS = "{http://www.w3.org/2000/svg}"


def test_every_edge_is_in_the_layer_of_its_class():
    family = alpha_complex(draw("uniform", 80, 0))
    shape = alpha_shape(family, r=float(family.spectrum[len(family.spectrum) // 2]))
    hull = alpha_hull(shape)
    layers = alpha_layers(shape, page_of(family.mesh), ALPHA_LAYERS, hull=hull)
    assert [layer.name for layer in layers] == list(ALPHA_LAYERS)
    counts = {layer.name: len(layer.pairs) for layer in layers if isinstance(layer, Lines)}
    found = np.bincount(shape.edge_classes, minlength=4).tolist()
    assert [counts[name] for name in ("singular", "boundary", "interior")] == found[1:]
    assert counts["delaunay"] == len(family)
    regions = next(layer for layer in layers if layer.name == "polygons")
    assert isinstance(regions, Polygons)
    assert len(regions.ring_limits) - 1 == shape.region_count
    refused(UsageError, "cells", alpha_layers, shape, page_of(family.mesh), ["cells"])


def bulge(path, sweep):
    """Middle of a half circle from (x0, y0) to (x1, y1), as SVG draws it: on its left as seen for sweep 0."""
    (x0, y0), (x1, y1) = path
    turn = 1 if sweep else -1
    return ((x0 + x1) / 2 + turn * (y1 - y0) / 2, (y0 + y1) / 2 - turn * (x1 - x0) / 2)


@pytest.mark.parametrize("y_up", [True, False])
def test_an_arc_turns_clockwise_in_the_data(y_up):
    """From (-1, 0) over (0, 1) to (1, 0) around the origin, and back below."""
    start, end = np.array([[-1.0, 0], [1, 0]]), np.array([[1.0, 0], [-1, 0]])
    arcs = Arcs("hull", start, end, np.zeros((2, 2)), np.array([0, 2]), "#ffffff", "#000000")
    page = Page((-1, -1, 1, 1), width=104, y_up=y_up)
    path = ET.fromstring(bytes_of(write_layers_svg, [arcs], page)).find(f"{NS}g/{NS}path").attrib["d"]
    steps = re.findall(r"A([\d.]+) [\d.]+ 0 0 (\d) ([\d.]+) ([\d.]+)", path)
    assert [float(step[0]) for step in steps] == [page.length(1.0)] * 2
    places = page.place(start).tolist()
    top = bulge([places[0], places[1]], int(steps[0][1]))
    np.testing.assert_allclose(top, page.place(np.array([[0.0, 1.0]]))[0], atol=1e-9)
    chords = arcs.chords(3.1e-4)
    assert np.hypot(*chords.points.T) == pytest.approx(1)
    assert chords.points[32].tolist() == pytest.approx([0, 1])
    assert chords.points[96].tolist() == pytest.approx([0, -1])


def steps_of(path):
    """Corners of a path of M, H and V."""
    x = y = 0.0
    for command, values in re.findall(r"([MHV])([-\d. ]+)", path):
        numbers = [float(value) for value in values.split()]
        if command == "M":
            x, y = numbers
        elif command == "H":
            x = numbers[0]
        else:
            y = numbers[0]
        yield x, y


@pytest.mark.parametrize("n", [3, 50, 3000])
def test_the_plot_shows_every_curve_to_its_last_value(n):
    curves = alpha_curves(alpha_complex(draw("uniform", n, 1)))
    root = ET.fromstring(bytes_of(write_curves_svg, curves, width=600))
    for name in CURVES:
        group = root.find(f"{NS}g[@id='{name}']")
        corners = list(steps_of(group.find(f"{NS}path").attrib["d"]))
        floor = float(group.find(f"{NS}line").attrib["y1"])
        values = np.asarray(curves[name], float)
        heights = np.array([floor - y for _, y in corners])
        most = values.max() or 1.0
        assert heights.max() == pytest.approx(values.max() / most * 110, abs=0.02)
        assert heights[-1] == pytest.approx(values[-1] / most * 110, abs=0.02)
        assert len(corners) < 4 * 4 * 600
        assert all(a[0] <= b[0] for a, b in pairwise(corners))


def test_a_plot_of_nothing():
    ET.fromstring(bytes_of(write_curves_svg, Table({name: np.empty(0) for name in ("r", *CURVES)})))


@pytest.mark.parametrize("name", ["uniform", "grid", "collinear", "exact_circle"])
def test_neighboring_cells_never_share_a_color(name):
    mesh = delaunay(np.unique(draw(name, 200, 3), axis=0))
    colors = cell_colors(mesh)
    assert colors.min() >= 1
    assert colors.max() <= 6
    shapes = voronoi_cells(mesh).to_shapely()
    a, b = shapely.STRtree(shapes).query(shapes, predicate="touches")
    beside = shapely.length(shapely.intersection(shapes[a], shapes[b])) > 0
    assert beside.any()
    assert (colors[a[beside]] != colors[b[beside]]).all()


def test_no_cells_draw_nothing():
    cells = voronoi_cells(np.empty((0, 2)))
    page = page_of(cells)
    assert len(cell_lines(cells, page).pairs) == 0
    assert len(cell_polygons(cells, np.empty(0, np.uint32), page).corners) == 0


pytestmark = pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")


def test_layers_come_from_below_in_one_order():
    mesh = delaunay([[0, 0], [4, 0], [0, 3], [9, 9]])
    page = page_of(mesh)
    assert [layer.name for layer in mesh_layers(mesh, page, reversed(MESH_LAYERS))] == list(MESH_LAYERS)
    triangles, edges, points, labels = mesh_layers(mesh, page, MESH_LAYERS)
    assert triangles.corners.reshape(-1, 3).tolist() == mesh.triangles.tolist()
    assert edges.pairs is mesh.edges
    assert points.points is mesh.points
    assert labels.texts == ["1", "2", "3", "4"]
    refused(UsageError, "'hull'", mesh_layers, mesh, page, ["hull"])


def test_crowded_points_have_fine_lines():
    few, many = (delaunay(draw("uniform", n, 1)) for n in (50, 50_000))
    layers = (mesh_layers(mesh, page_of(mesh), ["edges", "points"]) for mesh in (few, many))
    for before, after in zip(*layers, strict=True):
        assert getattr(before, "width", 0) > getattr(after, "width", 0) or before.radius > after.radius


@pytest.mark.parametrize("name", few(FAMILIES, 5))
def test_every_family_can_be_drawn(name):
    mesh = delaunay(draw(name, 60, 2))
    page = page_of(with_y_axis(mesh, "up"), width=200)
    image = np.concatenate(list(layer_bands(mesh_layers(mesh, page, MESH_LAYERS), page)))
    assert image.shape == (page.height, 600)
    assert (image < 200).any()


SHAPES = vorotool.read(DATA / "two-shapes.json")
MADE = vorotool.skeleton_exact(SHAPES)
PAGE = page_of(MADE)


def svg_of(layers, page=PAGE):
    return bytes_of(write_layers_svg, layers, page).decode()


def test_every_parabola_is_one_quadratic_curve():
    text = svg_of(skeleton_layers(MADE, PAGE, ["skeleton"]))
    paths = "".join(re.findall(r' d="([^"]*)"', text))
    assert paths.count("Q") == np.count_nonzero(MADE.is_parabola)
    assert paths.count("L") == np.count_nonzero(~MADE.is_parabola)
    joined = (MADE.arcs[1:, 0] == MADE.arcs[:-1, 1]).sum()
    assert paths.count("M") == len(MADE) - joined


def test_layers_are_groups_from_below():
    text = svg_of(skeleton_layers(MADE, PAGE, reversed(SKELETON_LAYERS), exact=MADE))
    assert text.count("stroke-dasharray") == 1
    assert re.findall(r'<g id="(\w+)"', text) == list(SKELETON_LAYERS)
    assert re.findall(r'<g id="(\w+)"', svg_of(diagram_layers(MADE, PAGE, ["skeleton"]))) == ["diagram"]
    refused(UsageError, "cells", skeleton_layers, MADE, PAGE, ["cells"])


def test_png_follows_the_curve():
    """A parabola from (0, 0) over (5, 10) to (10, 0) passes (5, 5), where its control triangle does not."""
    points = np.array([[0.0, 0.0], [10.0, 0.0], [5.0, 10.0]])
    layer = Curves("curve", points, np.array([[0, 1]], np.int32), np.array([2], np.int32), "#000000", 2)
    page = Page((0, 0, 10, 10), width=104, y_up=False)
    data = bytes_of(write_png, layer_bands([layer], page), (page.height, page.width), rgb=True)
    dark = np.asarray(Image.open(io.BytesIO(data)).convert("L")) < 128
    middle = page.place(np.array([[5.0, 5.0]]))[0]
    rows = np.flatnonzero(dark[:, int(middle[0])])
    assert np.abs(rows + 0.5 - middle[1]).max() <= 1.5
