"""The layers of pictures of necks, and of the parts between them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from vorotool import _core
from vorotool.render.canvas.layers import Layer, Lines, Page, Polygons
from vorotool.render.canvas.palettes import EDGE, FAINT, INK, RESULT, cell_color
from vorotool.render.label_images.png import checked_layers
from vorotool.render.layers.polygons import names_of_features, polygon_layers, polygon_page
from vorotool.render.layers.skeleton import skeleton_layers, skeleton_page
from vorotool.types.skeleton.necks import Necks
from vorotool.types.skeleton.parts import Parts

LAYERS = ("polygons", "skeleton", "necks", "labels")
"""Of necks, from below."""

PART_LAYERS = ("parts", "skeleton", "cuts", "labels")
"""Of parts."""

_WIDEST = 2.0
"""Cuts, in px."""


def neck_layers(necks: Necks, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of necks: lines from foot to foot, which get finer where there are many."""
    wanted = checked_layers(layers, LAYERS)
    made = skeleton_layers(necks.skeleton, page, [n for n in ("polygons", "skeleton") if n in wanted], color=FAINT)
    if "necks" in wanted:
        made.append(_cuts(necks, page, "necks", RESULT))
    return [*made, *skeleton_layers(necks.skeleton, page, ["labels"])] if "labels" in wanted else made


def part_layers(parts: Parts, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of parts, in colors that differ on both sides of a cut."""
    wanted = checked_layers(layers, PART_LAYERS)
    made: list[Layer] = []
    if "parts" in wanted:
        a, b = np.ascontiguousarray(parts.between.T).astype(np.uint32)
        colors = _core.graphs.color_graph(len(parts), a, b, None).astype(np.int64)
        palette = [cell_color(c) for c in range(int(colors.max(initial=0)) + 1)]
        width = min(max(page.spacing(max(len(parts.polygons.xy), 1)) / 16, 0.2), 1.0)
        made += [
            replace(layer, colors=palette, color_of=colors)
            for layer in polygon_layers(parts.polygons, width, name="parts", edge=EDGE)
            if isinstance(layer, Polygons)
        ]
    if "skeleton" in wanted:
        made += skeleton_layers(parts.necks.skeleton, page, ["skeleton"], color=FAINT)
    if "cuts" in wanted:
        made.append(_cuts(parts.necks, page, "cuts", INK))
    return [*made, names_of_features(parts.polygons, page)] if "labels" in wanted else made


def _cuts(necks: Necks, page: Page, name: str, color: str) -> Lines:
    pairs = np.arange(2 * len(necks), dtype=np.int32).reshape(-1, 2)
    width = min(max(page.spacing(max(len(necks), 1)) / 16, 0.3), _WIDEST)
    return Lines(name, necks.feet.reshape(-1, 2), pairs, color, width)


def neck_page(necks: Necks, *, width: int = 1000) -> Page:
    """The page of a picture: that of the skeleton."""
    return skeleton_page(necks.skeleton, width=width)


def part_page(parts: Parts, *, width: int = 1000) -> Page:
    """The page of a picture: that of the pieces."""
    return polygon_page(parts.polygons, width=width)
