"""The layers of an alpha shape's picture."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.alpha.alpha_hull import alpha_hull
from vorotool.render.canvas.layers import Arcs, Layer, Lines, Page, Points, Polygons
from vorotool.render.canvas.styles import BOUNDARY, CELLS, FAINT, INK, PALE, SINGULAR
from vorotool.render.label_images.png import checked_layers
from vorotool.render.layers.mesh import mesh_page, site_names
from vorotool.types.alpha.complex import CLASSES
from vorotool.types.alpha.hull import AlphaHull
from vorotool.types.alpha.shape import AlphaShape

LAYERS = ("polygons", "delaunay", "interior", "boundary", "singular", "hull", "points", "labels")
"""From below."""


def alpha_layers(shape: AlphaShape, page: Page, layers: Iterable[str], *, hull: AlphaHull | None = None) -> list[Layer]:
    """Make layers of an alpha shape; lines and discs get finer where points are crowded."""
    wanted = checked_layers(layers, LAYERS)
    points = shape.points
    spacing = page.spacing(len(points))
    width = min(max(spacing / 16, 0.15), 2.0)
    made: dict[str, Layer] = {
        "polygons": _regions(shape),
        "delaunay": Lines("delaunay", points, shape.family.edges, PALE, width / 2),
        "interior": Lines("interior", points, _edges(shape, "interior"), FAINT, width / 2),
        "boundary": Lines("boundary", points, _edges(shape, "boundary"), BOUNDARY, width),
        "singular": Lines("singular", points, _edges(shape, "singular"), SINGULAR, width),
        "points": Points("points", points, radius=min(max(spacing / 12, 0.3), 4.0)),
    }
    if "hull" in wanted:
        hull = alpha_hull(shape) if hull is None else hull
        made["hull"] = Arcs("hull", hull.start, hull.end, hull.center, hull.ring_starts, CELLS[4], INK, width)
    if "labels" in wanted:
        made["labels"] = site_names(shape.family.mesh, page)
    return [made[name] for name in LAYERS if name in wanted]


def alpha_page(shape: AlphaShape, *, width: int = 1000) -> Page:
    """The page of a picture: that of the triangulation."""
    return mesh_page(shape.family.mesh, width=width)


def hull_layers(hull: AlphaHull, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of an alpha hull, and of the shape of its radius."""
    return alpha_layers(hull.shape, page, layers, hull=hull)


def hull_page(hull: AlphaHull, *, width: int = 1000) -> Page:
    """The page of a picture: that of the triangulation."""
    return alpha_page(hull.shape, width=width)


def _edges(shape: AlphaShape, name: str) -> NDArray[np.int32]:
    edges: NDArray[np.int32] = shape.family.edges[shape.edge_classes == CLASSES.index(name)]
    return edges


def _regions(shape: AlphaShape) -> Polygons:
    rings = shape.polygons
    corners = np.arange(len(rings.xy), dtype=np.int32)
    ids = [f"region-{number}" for number in range(1, len(rings) + 1)]
    first = rings.polygon_starts
    return Polygons("polygons", rings.xy, corners, rings.ring_starts, first, colors=[CELLS[4]], ids=ids)
