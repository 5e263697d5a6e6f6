"""The layers of a picture of places along a skeleton."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from vorotool.render.canvas.layers import Layer, Lines, Page, Points
from vorotool.render.canvas.palettes import FAINT, RESULT, SEED
from vorotool.render.label_images.png import checked_layers
from vorotool.render.layers.skeleton import skeleton_layers, skeleton_page
from vorotool.types.skeleton.points_along import SkeletonPoints

LAYERS = ("polygons", "skeleton", "transects", "points", "labels")
"""From below."""


def point_layers(points: SkeletonPoints, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of places along a skeleton; discs and lines get finer where there are many."""
    wanted = checked_layers(layers, LAYERS)
    spacing = page.spacing(max(len(points), 1))
    below = [name for name in ("polygons", "skeleton") if name in wanted]
    made = skeleton_layers(points.skeleton, page, below, color=FAINT)
    if "transects" in wanted:
        ends = points.transects().feet.reshape(-1, 2)
        pairs = np.arange(len(ends), dtype=np.int32).reshape(-1, 2)
        made.append(Lines("transects", ends, pairs, RESULT, min(max(spacing / 24, 0.2), 1.5)))
    if "points" in wanted:
        made.append(Points("points", points.xy, SEED, min(max(spacing / 16, 0.3), 3.0)))
    if "labels" in wanted:
        made += skeleton_layers(points.skeleton, page, ["labels"])
    return made


def point_page(points: SkeletonPoints, *, width: int = 1000) -> Page:
    """The page of a picture: that of the skeleton."""
    return skeleton_page(points.skeleton, width=width)
