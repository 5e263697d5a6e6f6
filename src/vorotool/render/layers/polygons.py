"""The layers of a picture of polygons and lines."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.numeric.ragged import starts_of
from vorotool.render.canvas.layers import Layer, Lines, Page, Points, Polygons, Texts, bounds_of, name_size
from vorotool.render.canvas.names import column_texts, without_empty
from vorotool.render.canvas.palettes import FAINT, LIGHT, RESULT, WHITE
from vorotool.render.label_images.png import checked_layers
from vorotool.types.axis import is_up
from vorotool.types.polygons.polygon_set import PolygonSet

SHAPE_LAYERS = ("shape", "labels")


def polygon_layers(
    polygons: PolygonSet, width: float, *, name: str = "polygons", edge: str | None = None
) -> list[Layer]:
    """Closed rings filled, open lines drawn."""
    closed = ~polygons.is_line[polygons.ring_polygon]
    corner_is_closed = np.repeat(closed, np.diff(polygons.ring_starts))
    corners = np.flatnonzero(corner_is_closed).astype(np.int32)
    sizes = np.diff(polygons.ring_starts)[closed]
    per_polygon = np.bincount(polygons.ring_polygon[closed], minlength=len(polygons))
    filled = Polygons(
        name,
        polygons.xy,
        corners,
        starts_of(sizes),
        first_rings=starts_of(per_polygon),
        colors=[LIGHT],
        is_alone=covered(polygons),
        edge=edge,
        width=width,
    )
    first = np.flatnonzero(~corner_is_closed)
    last = np.isin(first, polygons.ring_starts[1:] - 1)
    pairs = np.stack([first[~last], first[~last] + 1], axis=1).astype(np.int32)
    lines = Lines("lines", polygons.xy, pairs, edge or FAINT, width)
    return [filled, lines] if len(pairs) else [filled]


def covered(polygons: PolygonSet) -> NDArray[np.bool_] | None:
    """(p,) polygons of which a part lies in another one, too; None if there are none."""
    if len(polygons) < 2 or polygons.connectivity is not None or polygons.is_line.all():
        return None
    placed, *_ = _core.arrangement.place_on_lattice(polygons.xy, 0, None)
    rings = polygons.ring_starts, polygons.ring_kind, polygons.ring_polygon
    try:
        graph = _core.arrangement.make_planar_graph(placed, *rings, None)
    except (_core.arrangement.TooManyCrossingsError, _core.arrangement.TooManyOverlapsError):
        return np.ones(len(polygons), dtype=bool)
    counts = np.diff(graph["face_starts"])
    several = graph["face_polygon"][np.repeat(counts > 1, counts)]
    if not several.size:
        return None
    found = np.zeros(len(polygons), dtype=bool)
    found[several] = True
    return found


def shape_layers(polygons: PolygonSet, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Polygons and lines as what is shown: filled, with outlines, which get finer where there are many vertices."""
    wanted = checked_layers(layers, SHAPE_LAYERS)
    width = min(max(page.spacing(max(len(polygons.xy), 1)) / 16, 0.2), 1.5)
    made = polygon_layers(polygons, width, name="shape", edge=RESULT) if "shape" in wanted else []
    return [*made, names_of_features(polygons, page)] if "labels" in wanted else made


def feature_names(polygons: PolygonSet, page: Page) -> list[str]:
    """Ids of the features, else their numbers from 0, or what the column says that the page is to have."""
    assert polygons.feature is not None  # PolygonSet has filled it in
    _, first = np.unique(polygons.feature, return_index=True)
    ids = [None] * len(polygons) if polygons.ids is None else polygons.ids
    names = [index if ids[index] is None else ids[index] for index in first.tolist()]
    columns = polygons.properties if page.style.label_by is not None else {}
    chosen = {name: [values[index] for index in first.tolist()] for name, values in columns.items()}
    return column_texts(chosen, page.style.label_by, names)


def names_of_features(polygons: PolygonSet, page: Page) -> Texts:
    """Names of features: inside the largest polygon, in the middle of the longest line, on the first point."""
    import shapely

    from vorotool.types.polygons.conversion import to_shapely

    assert polygons.feature is not None  # PolygonSet has filled it in
    shapes = np.asarray(to_shapely(polygons), dtype=object)
    measure = np.where(polygons.is_line, shapely.length(shapes), shapely.area(shapes))
    order = np.lexsort((np.arange(len(shapes)), -measure, polygons.is_line, polygons.feature))
    _, best = np.unique(polygons.feature[order], return_index=True)
    chosen, is_line = shapes[order[best]], polygons.is_line[order[best]]
    inside = np.empty(len(chosen), dtype=object)
    inside[is_line] = shapely.line_interpolate_point(chosen[is_line], 0.5, normalized=True)
    inside[~is_line] = shapely.point_on_surface(chosen[~is_line])
    places = np.stack([shapely.get_x(inside), shapely.get_y(inside)], axis=1)
    has_none = np.isnan(places).any(axis=1)  # of a polygon without area
    corners = polygons.xy[polygons.ring_starts[polygons.polygon_starts[:-1]]]
    places[has_none] = corners[order[best]][has_none]
    names = feature_names(polygons, page)
    return without_empty(Texts("labels", places, names, size=name_size(page, len(names)), halo=WHITE, is_centered=True))


def polygon_page(polygons: PolygonSet, *, width: int = 1000) -> Page:
    """The page of a picture, as of `mesh_page`: with all polygons and lines."""
    up = is_up(polygons)
    return Page(bounds_of([Points("shown", polygons.xy)]), width=width, y_up=up)


shape_page = polygon_page
