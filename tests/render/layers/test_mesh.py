"""The layers of a triangulation's picture."""

from __future__ import annotations

import numpy as np
import pytest

from support.families.point_families import FAMILIES, draw
from support.few import few
from vorotool import UsageError, delaunay
from vorotool.render.canvas.png import layer_bands
from vorotool.render.layers.mesh import mesh_layers, mesh_page
from vorotool.types.fields import with_y_axis

LAYERS = ("triangles", "edges", "points", "labels")

pytestmark = pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")


def test_layers_come_from_below_in_one_order():
    mesh = delaunay([[0, 0], [4, 0], [0, 3], [9, 9]])
    page = mesh_page(mesh)
    assert [layer.name for layer in mesh_layers(mesh, page, reversed(LAYERS))] == list(LAYERS)
    triangles, edges, points, labels = mesh_layers(mesh, page, LAYERS)
    assert triangles.corners.reshape(-1, 3).tolist() == mesh.triangles.tolist()
    assert edges.pairs is mesh.edges
    assert points.points is mesh.points
    assert labels.texts == ["1", "2", "3", "4"]
    with pytest.raises(UsageError, match="'hull'"):
        mesh_layers(mesh, page, ["hull"])


def test_crowded_points_have_fine_lines():
    few, many = (delaunay(draw("uniform", n, 1)) for n in (50, 50_000))
    for before, after in zip(
        *(mesh_layers(mesh, mesh_page(mesh), ["edges", "points"]) for mesh in (few, many)), strict=True
    ):
        assert getattr(before, "width", 0) > getattr(after, "width", 0) or before.radius > after.radius


@pytest.mark.parametrize("name", few(FAMILIES, 5))
def test_every_family_can_be_drawn(name):
    mesh = delaunay(draw(name, 60, 2))
    page = mesh_page(with_y_axis(mesh, "up"), width=200)
    image = np.concatenate(list(layer_bands(mesh_layers(mesh, page, LAYERS), page)))
    assert image.shape == (page.height, 600)
    assert (image < 200).any()
