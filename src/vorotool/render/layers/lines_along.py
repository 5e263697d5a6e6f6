"""The layers of pictures of lines along skeletons: centerlines, skeletons with their ends, smooth lines."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool.render.canvas.cubic_curves import CubicCurves
from vorotool.render.canvas.layers import Curves, Layer, Page
from vorotool.render.layers.skeleton import skeleton_layers, skeleton_page
from vorotool.types.skeleton.centerline import Centerlines
from vorotool.types.skeleton.led_on import LedOn
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.skeleton.smooth_lines import SmoothLines


def line_layers(
    lines: LedOn | SmoothLines,
    page: Page,
    layers: Iterable[str],
    *,
    points: NDArray[np.float64] | None = None,
    exact: Skeleton | None = None,
) -> list[Layer]:
    """Make layers of lines along skeletons: those of the skeleton, but "skeleton" are the lines."""
    near_to = lines.lines if isinstance(lines, SmoothLines) else lines
    name = "centerline" if isinstance(near_to, Centerlines) else "skeleton"
    made = skeleton_layers(lines.path, page, layers, name=name, points=points, exact=exact)

    def shown(layer: Layer) -> Layer:
        if not isinstance(layer, Curves) or layer.name != name:
            return layer
        return _smooth(layer, lines) if isinstance(lines, SmoothLines) else _led_on(layer, lines)

    return [shown(layer) for layer in made]


def line_page(lines: LedOn | SmoothLines, *, width: int = 1000) -> Page:
    """The page of a picture: that of the skeleton."""
    return skeleton_page(lines.path, width=width)


def _led_on(curves: Curves, lines: LedOn) -> Curves:
    """With the straight lines that lead to the boundary."""
    first, last = lines.extended
    nodes = np.concatenate([lines.end_nodes[first, 0], lines.end_nodes[last, 1]])
    ends = np.concatenate([lines.ends[first, 0], lines.ends[last, 1]])
    pairs = np.stack([nodes, len(curves.points) + np.arange(len(ends))], axis=1)
    return replace(
        curves,
        points=np.concatenate([curves.points, ends]),
        pairs=np.concatenate([curves.pairs, pairs]).astype(np.int32),
        control=np.concatenate([curves.control, np.full(len(ends), -1, dtype=np.int32)]),
    )


def _smooth(layer: Curves, smoothed: SmoothLines) -> CubicCurves:
    """With the name, color and width of another layer."""
    control = smoothed.control.reshape(-1, 2)
    first = 4 * np.arange(len(smoothed.control), dtype=np.int32)
    # the end of a curve is the begin of the next one on the same line
    goes_on = np.ones(len(first), dtype=bool)
    goes_on[smoothed.start[1:] - 1] = False
    last = np.where(goes_on, first + 4, first + 3)
    pairs = np.stack([first, last], axis=1).astype(np.int32)
    return CubicCurves(layer.name, control, pairs, first + 1, layer.color, layer.width, second=first + 2)
