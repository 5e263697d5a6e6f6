"""The layers of pictures of polygons and lines, and of what is drawn with those that it is of."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.numeric.arrays import starts_of
from vorotool.render.canvas.layers import (
    Arcs,
    Layer,
    Lines,
    Page,
    Points,
    Polygons,
    Texts,
    bounds_of,
    circles,
    name_size,
)
from vorotool.render.canvas.names import column_texts, without_empty
from vorotool.render.canvas.styles import FAINT, LIGHT, RESULT, SEED, WHITE
from vorotool.render.label_images.png import checked_layers
from vorotool.types.distances.distances import Distances
from vorotool.types.fields import is_up
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.discs import Discs
from vorotool.types.skeleton.offsets import Offsets

SHAPE_LAYERS = ("shape", "labels")
DISC_LAYERS = ("polygons", "discs", "feet", "labels")
OFFSET_LAYERS = ("polygons", "offset", "labels")
DISTANCE_LAYERS = ("first", "second", "distances")

_FINE = 2.0**-10
"""Of the extent: chords of arcs whose bounds are shown."""


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

    from vorotool.types.polygons.shapely_geometry import to_shapely

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


# ---- what is drawn with the polygons that it is of: discs, offset curves, distances
def disc_layers(discs: Discs, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of discs: the polygons light gray, circles, and where they touch."""
    wanted = checked_layers(layers, DISC_LAYERS)
    spacing = page.spacing(max(len(discs), 1))
    width = min(max(spacing / 16, 0.2), 1.5)
    made: dict[str, list[Layer]] = {
        "polygons": [*polygon_layers(discs.polygons, width), *_points(discs, spacing)],
        "discs": [circles("discs", discs.xy, discs.radius, RESULT, width)],
        "feet": [Points("feet", discs.feet, SEED, min(max(spacing / 16, 0.3), 3.0))],
    }
    if "labels" in wanted:
        made["labels"] = [names_of_features(discs.polygons, page)]
    return [layer for name in DISC_LAYERS if name in wanted for layer in made[name]]


def _points(discs: Discs, spacing: float) -> list[Layer]:
    """Shapes of one place."""
    polygons = discs.polygons
    alone = polygons.ring_starts[:-1][np.diff(polygons.ring_starts) == 1]
    return [Points("points", polygons.xy[alone], SEED, min(max(spacing / 16, 0.3), 3.0))] if len(alone) else []


def disc_page(discs: Discs, *, width: int = 1000) -> Page:
    """The page of a picture, as of `mesh_page`: with all polygons and discs."""
    across = discs.radius[:, None]
    shown = [Points("shown", places) for places in (discs.polygons.xy, discs.xy - across, discs.xy + across)]
    return Page(bounds_of(shown), width=width, y_up=is_up(discs))


def offset_layers(offsets: Offsets, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of offset curves; lines get finer where there are many."""
    wanted = checked_layers(layers, OFFSET_LAYERS)
    width = min(max(page.spacing(max(len(offsets.site), 1)) / 16, 0.2), 1.5)
    curves = Arcs(
        "offset",
        offsets.start,
        offsets.end,
        offsets.center,
        offsets.ring_starts,
        None,
        RESULT,
        width,
        offsets.piece_distance > 0,
    )
    made: dict[str, list[Layer]] = {"polygons": polygon_layers(offsets.polygons, width), "offset": [curves]}
    if "labels" in wanted:
        made["labels"] = [names_of_features(offsets.polygons, page)]
    return [layer for name in OFFSET_LAYERS if name in wanted for layer in made[name]]


def offset_page(offsets: Offsets, *, width: int = 1000) -> Page:
    """The page of a picture, as of `mesh_page`: with all polygons and curves."""
    corners = np.concatenate([offsets.polygons.xy, offsets.start])
    tolerance = _FINE * (float(np.ptp(corners, axis=0).max()) or 1.0) if len(corners) else 1.0
    shown = [Points("shown", offsets.polygons.xy), Points("shown", offsets.flattened(tolerance).xy)]
    return Page(bounds_of(shown), width=width, y_up=is_up(offsets))


def distance_layers(found: Distances, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of two shapes, and of the lines between the places that are as far apart as they are."""
    wanted = checked_layers(layers, DISTANCE_LAYERS)
    made: list[Layer] = []
    for name, polygons, color in zip(DISTANCE_LAYERS, found.shapes, (FAINT, SEED), strict=False):
        if name in wanted:
            made += _shape(name, polygons, page, color)
    if "distances" in wanted:
        places = found.places.reshape(-1, 2)
        pairs = np.arange(len(places), dtype=np.int32).reshape(-1, 2)
        made += [Lines("distances", places, pairs, RESULT, 2.0), Points("places", places, RESULT, 3.0)]
    return made


def _shape(name: str, polygons: PolygonSet, page: Page, color: str) -> list[Layer]:
    """Polygons with their outlines, lines, and points as discs; of more than one kind, all but the first by theirs."""
    width = min(max(page.spacing(max(len(polygons.xy), 1)) / 16, 0.2), 1.5)
    filled, *lines = polygon_layers(polygons, width, name=name, edge=color)
    drawn: list[tuple[str, Layer]] = [] if polygons.is_line.all() else [("polygons", filled)]
    drawn += [("lines", layer) for layer in lines]
    is_lone = polygons.is_line[polygons.ring_polygon] & (np.diff(polygons.ring_starts) == 1)
    if is_lone.any():
        places = polygons.xy[polygons.ring_starts[:-1][is_lone]]
        drawn.append(("points", Points(name, places, color, 2 * width + 0.5)))
    return [replace(layer, name=f"{name}-{kind}" if i else name) for i, (kind, layer) in enumerate(drawn)]


def distance_page(found: Distances, *, width: int = 1000) -> Page:
    """The page of a picture, as of `polygon_page`: with both shapes."""
    shown = [Points("shown", polygons.xy) for polygons in found.shapes]
    return Page(bounds_of(shown), width=width, y_up=is_up(found))
