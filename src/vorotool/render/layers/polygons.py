"""The layers of a picture of polygons and lines."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.ragged import starts_of
from vorotool.render.canvas.layers import Layer, Lines, Page, Points, Polygons, bounds_of
from vorotool.render.canvas.palettes import FAINT, LIGHT, RESULT
from vorotool.render.label_images.png import checked_layers

SHAPE_LAYERS = ("shape",)


def polygon_layers(
    polygons: PolygonSet, width: float, *, name: str = "polygons", edge: str | None = None
) -> list[Layer]:
    """Closed rings filled, open lines drawn.

    Parameters
    ----------
    polygons : PolygonSet
        What to draw.
    width : float
        Of lines, in px.
    name : str
        Of the layer of closed rings.
    edge : str, optional
        Colour of their outlines, and of lines.

    Examples
    --------
    >>> square = PolygonSet([[0, 0], [1, 0], [1, 1], [0, 1]], [0, 4], [0], [0])
    >>> [layer.name for layer in polygon_layers(square, 1.0)]
    ['polygons']
    """
    closed = ~polygons.is_line[polygons.ring_polygon]
    corner_is_closed = np.repeat(closed, np.diff(polygons.ring_start))
    corners = np.flatnonzero(corner_is_closed).astype(np.int32)
    sizes = np.diff(polygons.ring_start)[closed]
    per_polygon = np.bincount(polygons.ring_polygon[closed], minlength=len(polygons))
    filled = Polygons(
        name,
        polygons.xy,
        corners,
        starts_of(sizes),
        first_rings=starts_of(per_polygon),
        colours=[LIGHT],
        is_alone=covered(polygons),
        edge=edge,
        width=width,
    )
    first = np.flatnonzero(~corner_is_closed)
    last = np.isin(first, polygons.ring_start[1:] - 1)
    pairs = np.stack([first[~last], first[~last] + 1], axis=1).astype(np.int32)
    lines = Lines("lines", polygons.xy, pairs, edge or FAINT, width)
    return [filled, lines] if len(pairs) else [filled]


def covered(polygons: PolygonSet) -> NDArray[np.bool_] | None:
    """(p,) polygons of which a part lies in another one, too; None if there are none.

    Examples
    --------
    >>> box = [[0, 0], [4, 0], [4, 4], [0, 4]]
    >>> covered(PolygonSet([*box, [1, 1], [2, 1], [1, 2]], [0, 4, 7], [0, 0], [0, 1])).tolist()
    [True, True]
    """
    if len(polygons) < 2 or polygons.connectivity is not None or polygons.is_line.all():
        return None
    placed, *_ = _core.arrangement.place_on_lattice(polygons.xy, 0, None)
    rings = polygons.ring_start, polygons.ring_kind, polygons.ring_polygon
    try:
        graph = _core.arrangement.make_planar_graph(placed, *rings, None)
    except (_core.arrangement.TooManyCrossingsError, _core.arrangement.TooManyOverlapsError):
        return np.ones(len(polygons), dtype=bool)
    counts = np.diff(graph["face_start"])
    several = graph["face_polygon"][np.repeat(counts > 1, counts)]
    if not several.size:
        return None
    found = np.zeros(len(polygons), dtype=bool)
    found[several] = True
    return found


def shape_layers(polygons: PolygonSet, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Polygons and lines as what is shown: filled, with outlines, which get finer where there are many vertices.

    Parameters
    ----------
    polygons : PolygonSet
        What to draw.
    page : Page
        Where it will be drawn.
    layers : iterable of str
        "shape", if at all.

    Raises
    ------
    UsageError
        If a layer is unknown.
    """
    if "shape" not in checked_layers(layers, SHAPE_LAYERS):
        return []
    width = min(max(page.spacing(max(len(polygons.xy), 1)) / 16, 0.2), 1.5)
    return polygon_layers(polygons, width, name="shape", edge=RESULT)


def polygon_page(polygons: PolygonSet, *, width: int = 1000, y_up: bool | None = None) -> Page:
    """The page of a picture, as of `mesh_page`: with all polygons and lines."""
    up = polygons.y_up if y_up is None else y_up
    return Page(bounds_of([Points("shown", polygons.xy)]), width=width, y_up=up)
