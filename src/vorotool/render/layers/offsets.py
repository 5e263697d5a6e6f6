"""The layers of a picture of offset curves."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from vorotool.render.canvas.layers import Arcs, Layer, Page, Points, bounds_of
from vorotool.render.canvas.palettes import RESULT
from vorotool.render.label_images.png import checked_layers
from vorotool.render.layers.polygons import names_of_features, polygon_layers
from vorotool.types.axis import is_up
from vorotool.types.skeleton.offsets import Offsets

LAYERS = ("polygons", "offset", "labels")
"""From below."""

_FINE = 2.0**-10
"""Of the extent: chords of arcs whose bounds are shown."""


def offset_layers(offsets: Offsets, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of offset curves; lines get finer where there are many."""
    wanted = checked_layers(layers, LAYERS)
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
    return [layer for name in LAYERS if name in wanted for layer in made[name]]


def offset_page(offsets: Offsets, *, width: int = 1000) -> Page:
    """The page of a picture, as of `mesh_page`: with all polygons and curves."""
    corners = np.concatenate([offsets.polygons.xy, offsets.start])
    tolerance = _FINE * (float(np.ptp(corners, axis=0).max()) or 1.0) if len(corners) else 1.0
    shown = [Points("shown", offsets.polygons.xy), Points("shown", offsets.flattened(tolerance).xy)]
    return Page(bounds_of(shown), width=width, y_up=is_up(offsets))
