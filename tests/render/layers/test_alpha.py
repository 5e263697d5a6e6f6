"""Pictures of alpha shapes: layers, arcs, and the plot of curves."""

from __future__ import annotations

import io
import re
import xml.etree.ElementTree as ET
from itertools import pairwise

import numpy as np
import pytest

from support.families.point_families import draw
from vorotool import UsageError, alpha_complex, alpha_curves, alpha_hull, alpha_shape
from vorotool.render.canvas.layers import Arcs, Lines, Page, Polygons
from vorotool.render.canvas.svg import write_layers_svg
from vorotool.render.layers.alpha import LAYERS, alpha_layers
from vorotool.render.layers.mesh import mesh_page
from vorotool.render.pages.alpha_plot import CURVES, write_curves_svg
from vorotool.types.table import Table

NS = "{http://www.w3.org/2000/svg}"


def test_every_edge_is_in_the_layer_of_its_class():
    family = alpha_complex(draw("uniform", 80, 0))
    shape = alpha_shape(family, r=float(family.spectrum[len(family.spectrum) // 2]))
    hull = alpha_hull(shape)
    layers = alpha_layers(shape, mesh_page(family.mesh), LAYERS, hull=hull)
    assert [layer.name for layer in layers] == list(LAYERS)
    counts = {layer.name: len(layer.pairs) for layer in layers if isinstance(layer, Lines)}
    found = np.bincount(shape.edge_classes, minlength=4).tolist()
    assert [counts[name] for name in ("singular", "boundary", "interior")] == found[1:]
    assert counts["delaunay"] == len(family)
    regions = next(layer for layer in layers if layer.name == "polygons")
    assert isinstance(regions, Polygons)
    assert len(regions.ring_limits) - 1 == shape.region_count
    with pytest.raises(UsageError, match="cells"):
        alpha_layers(shape, mesh_page(family.mesh), ["cells"])


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
    out = io.BytesIO()
    write_layers_svg(out, [arcs], page)
    path = ET.fromstring(out.getvalue()).find(f"{NS}g/{NS}path").attrib["d"]
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
    out = io.BytesIO()
    write_curves_svg(out, curves, width=600)
    root = ET.fromstring(out.getvalue())
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
    out = io.BytesIO()
    write_curves_svg(out, Table({name: np.empty(0) for name in ("r", *CURVES)}))
    ET.fromstring(out.getvalue())
