"""The layers of a triangulation's picture."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from vorotool.render.canvas.layers import Layer, Lines, Page, Points, Polygons, Texts, bounds_of
from vorotool.render.canvas.names import column_texts, without_empty
from vorotool.render.canvas.palettes import CELLS, INK, WHITE
from vorotool.render.label_images.png import checked_layers
from vorotool.types.axis import is_up
from vorotool.types.mesh.cells import CellSet
from vorotool.types.mesh.digital_triangulation import AnyTriangulation
from vorotool.types.mesh.proximity import ProximityGraph

LAYERS = ("triangles", "edges", "points", "labels")
"""From below."""


def mesh_layers(mesh: AnyTriangulation | ProximityGraph, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of a triangulation; lines and discs get finer where points are crowded."""
    wanted = checked_layers(layers, LAYERS)
    spacing = page.spacing(len(mesh.points))
    corners, rings = mesh.triangles.reshape(-1), 3 * np.arange(len(mesh.triangles) + 1)
    width = min(max(spacing / 24, 0.1), 1.5)
    made: dict[str, Layer] = {
        "triangles": Polygons("triangles", mesh.points, corners, rings, colors=[CELLS[4]]),
        "edges": Lines("edges", mesh.points, mesh.edges, INK, width),
        "points": Points("points", mesh.points, radius=min(max(spacing / 12, 0.3), 4.0)),
    }
    if "labels" in wanted:
        made["labels"] = site_names(mesh, page)
    return [made[name] for name in LAYERS if name in wanted]


def site_names(sites: AnyTriangulation | ProximityGraph | CellSet, page: Page) -> Texts:
    """Ids of the sites beside these, or what the column says that the page is to have."""
    points = sites.sites if isinstance(sites, CellSet) else sites.points
    texts = column_texts(sites.properties, page.style.label_by, sites.label_array.tolist())
    size = min(max(page.spacing(len(points)) / 4, 2.0), 16.0)
    return without_empty(Texts("labels", points, texts, size=size, halo=WHITE))


def mesh_page(
    mesh: AnyTriangulation | ProximityGraph,
    *,
    width: int = 1000,
    bounds: tuple[float, float, float, float] | None = None,
) -> Page:
    """The page of a picture: with all points of a triangulation, or with other bounds."""
    up = is_up(mesh)
    return Page(bounds or bounds_of([Points("points", mesh.points)]), width=width, y_up=up)
