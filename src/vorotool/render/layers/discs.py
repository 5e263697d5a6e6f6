"""The layers of a picture of discs."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from vorotool.render.canvas.circles import circles
from vorotool.render.canvas.layers import Layer, Page, Points, bounds_of
from vorotool.render.canvas.palettes import RESULT, SEED
from vorotool.render.label_images.png import checked_layers
from vorotool.render.layers.polygons import names_of_features, polygon_layers
from vorotool.types.axis import is_up
from vorotool.types.skeleton.discs import Discs

LAYERS = ("polygons", "discs", "feet", "labels")
"""From below."""


def disc_layers(discs: Discs, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of discs: the polygons light grey, circles, and where they touch."""
    wanted = checked_layers(layers, LAYERS)
    spacing = page.spacing(max(len(discs), 1))
    width = min(max(spacing / 16, 0.2), 1.5)
    made: dict[str, list[Layer]] = {
        "polygons": [*polygon_layers(discs.polygons, width), *_points(discs, spacing)],
        "discs": [circles("discs", discs.xy, discs.radius, RESULT, width)],
        "feet": [Points("feet", discs.feet, SEED, min(max(spacing / 16, 0.3), 3.0))],
    }
    if "labels" in wanted:
        made["labels"] = [names_of_features(discs.polygons, page)]
    return [layer for name in LAYERS if name in wanted for layer in made[name]]


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
