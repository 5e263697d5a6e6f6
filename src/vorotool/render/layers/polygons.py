"""The layers of pictures of polygons and lines, and of what is drawn with those that it is of."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.numeric.arrays import Indices, mask_of, starts_of
from vorotool.render.canvas.layers import (
    Arcs,
    Layer,
    Lines,
    Makers,
    Page,
    Points,
    Polygons,
    Texts,
    circles,
    column_texts,
    made_layers,
    name_size,
    without_empty,
)
from vorotool.render.canvas.styles import FAINT, LIGHT, RESULT, SEED, WHITE
from vorotool.types.distances.distances import Distances
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.discs import Discs
from vorotool.types.skeleton.offsets import Offsets


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
    found = mask_of(several, len(polygons))
    return found


def shape_layers(polygons: PolygonSet, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Polygons and lines as what is shown: filled, with outlines, which get finer where there are many vertices."""
    width = min(max(page.spacing(len(polygons.xy)) / 16, 0.2), 1.5)
    make: Makers = {
        "shape": lambda: polygon_layers(polygons, width, name="shape", edge=RESULT),
        "labels": lambda: [names_of_features(polygons, page)],
    }
    return made_layers(layers, make)


def feature_names(polygons: PolygonSet, page: Page) -> list[str]:
    """Ids of the features, else their numbers from 0, or what the column says that the page is to have."""
    _, first = np.unique(polygons.feature, return_index=True)
    ids = [None] * len(polygons) if polygons.ids is None else polygons.ids
    names = [index if ids[index] is None else ids[index] for index in first.tolist()]
    columns = polygons.properties if page.style.label_by is not None else {}
    chosen = {name: [values[index] for index in first.tolist()] for name, values in columns.items()}
    return column_texts(chosen, page.style.label_by, names)


def name_places(shapes: NDArray[np.object_], owner: NDArray[np.integer]) -> tuple[NDArray[np.float64], Indices]:
    """Choose a place for each owner in order, and the shape that it is in: the largest area, else the longest line."""
    import shapely

    dimension = shapely.get_dimensions(shapes)
    measure = np.where(dimension == 1, shapely.length(shapes), shapely.area(shapes))
    order = np.lexsort((np.arange(len(shapes)), -measure, -dimension, owner))
    chosen = order[np.unique(owner[order], return_index=True)[1]]
    inside, is_line = shapely.point_on_surface(shapes[chosen]), dimension[chosen] == 1
    inside[is_line] = shapely.line_interpolate_point(shapes[chosen[is_line]], 0.5, normalized=True)
    return np.stack([shapely.get_x(inside), shapely.get_y(inside)], axis=1), chosen


def names_of_features(polygons: PolygonSet, page: Page) -> Texts:
    """Names of features: inside the largest polygon, in the middle of the longest line, on the first point."""
    from vorotool.types.polygons.shapely_geometry import to_shapely

    places, chosen = name_places(to_shapely(polygons), polygons.feature)
    has_none = np.isnan(places).any(axis=1)  # of a polygon without area
    corners = polygons.xy[polygons.ring_starts[polygons.polygon_starts[:-1]]]
    places[has_none] = corners[chosen][has_none]
    names = feature_names(polygons, page)
    return without_empty(Texts("labels", places, names, size=name_size(page, len(names)), halo=WHITE, is_centered=True))


# ---- what is drawn with the polygons that it is of: discs, offset curves, distances
def disc_layers(discs: Discs, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of discs: the polygons light gray, circles, and where they touch."""
    spacing = page.spacing(len(discs))
    width = min(max(spacing / 16, 0.2), 1.5)
    make: Makers = {
        "polygons": lambda: [*polygon_layers(discs.polygons, width), *_points(discs, spacing)],
        "discs": lambda: [circles("discs", discs.xy, discs.radius, RESULT, width)],
        "feet": lambda: [Points("feet", discs.feet, SEED, min(max(spacing / 16, 0.3), 3.0))],
        "labels": lambda: [names_of_features(discs.polygons, page)],
    }
    return made_layers(layers, make)


def _points(discs: Discs, spacing: float) -> list[Layer]:
    """Shapes of one place."""
    polygons = discs.polygons
    alone = polygons.ring_starts[:-1][np.diff(polygons.ring_starts) == 1]
    return [Points("points", polygons.xy[alone], SEED, min(max(spacing / 16, 0.3), 3.0))] if len(alone) else []


def offset_layers(offsets: Offsets, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of offset curves; lines get finer where there are many."""
    width = min(max(page.spacing(len(offsets.site)) / 16, 0.2), 1.5)
    pieces, is_left = (offsets.start, offsets.end, offsets.center), offsets.piece_distance > 0
    make: Makers = {
        "polygons": lambda: polygon_layers(offsets.polygons, width),
        "offset": lambda: [Arcs("offset", *pieces, offsets.ring_starts, None, RESULT, width, is_left)],
        "labels": lambda: [names_of_features(offsets.polygons, page)],
    }
    return made_layers(layers, make)


def distance_layers(found: Distances, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of two shapes, and of the lines between the places that are as far apart as they are."""
    first, second = found.shapes
    lines = Lines.between("distances", found.places, RESULT, 2.0)
    make: Makers = {
        "first": lambda: _shape("first", first, page, FAINT),
        "second": lambda: _shape("second", second, page, SEED),
        "distances": lambda: [lines, Points("places", lines.points, RESULT, 3.0)],
    }
    return made_layers(layers, make)


def _shape(name: str, polygons: PolygonSet, page: Page, color: str) -> list[Layer]:
    """Polygons with their outlines, lines, and points as discs; of more than one kind, all but the first by theirs."""
    width = min(max(page.spacing(len(polygons.xy)) / 16, 0.2), 1.5)
    filled, *lines = polygon_layers(polygons, width, name=name, edge=color)
    drawn: list[tuple[str, Layer]] = [] if polygons.is_line.all() else [("polygons", filled)]
    drawn += [("lines", layer) for layer in lines]
    is_lone = polygons.is_line[polygons.ring_polygon] & (np.diff(polygons.ring_starts) == 1)
    if is_lone.any():
        places = polygons.xy[polygons.ring_starts[:-1][is_lone]]
        drawn.append(("points", Points(name, places, color, 2 * width + 0.5)))
    return [replace(layer, name=f"{name}-{kind}" if i else name) for i, (kind, layer) in enumerate(drawn)]
