"""The layers of a picture of two shapes, and of how far they are apart."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from vorotool.render.canvas.layers import Layer, Lines, Page, Points, bounds_of
from vorotool.render.canvas.palettes import FAINT, RESULT, SEED
from vorotool.render.label_images.png import checked_layers
from vorotool.render.layers.polygons import polygon_layers
from vorotool.types.axis import is_up
from vorotool.types.distances.distances import Distances
from vorotool.types.polygons.polygon_set import PolygonSet

LAYERS = ("first", "second", "distances")
"""From below."""


def distance_layers(found: Distances, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of two shapes, and of the lines between the places that are as far apart as they are."""
    wanted = checked_layers(layers, LAYERS)
    made: list[Layer] = []
    for name, polygons, color in zip(LAYERS, found.shapes, (FAINT, SEED), strict=False):
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
