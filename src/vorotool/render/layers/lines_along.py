"""The layers of pictures of lines along skeletons: centerlines, skeletons with their ends, smooth lines."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.skeleton.centerline import Centerlines
from vorotool.geometry.skeleton.led_on import LedOn
from vorotool.geometry.skeleton.skeleton import Skeleton
from vorotool.geometry.skeleton.smooth_lines import SmoothLines
from vorotool.render.canvas.cubic_curves import CubicCurves
from vorotool.render.canvas.layers import Curves, Layer, Page
from vorotool.render.layers.skeleton import skeleton_layers


def line_layers(
    lines: LedOn | SmoothLines,
    page: Page,
    layers: Iterable[str],
    *,
    points: NDArray[np.float64] | None = None,
    exact: Skeleton | None = None,
) -> list[Layer]:
    """Make layers of lines along skeletons: those of the skeleton, but "skeleton" are the lines.

    Parameters
    ----------
    lines : Centerlines, ExtendedSkeleton or SmoothLines
        What to draw.
    page : Page
        Where it will be drawn.
    layers, points, exact
        As of `vorotool.render.layers.skeleton.skeleton_layers`.

    Raises
    ------
    UsageError
        If a layer is unknown.

    Examples
    --------
    >>> from vorotool import centerline, skeleton_exact, smooth
    >>> from vorotool.render.layers.skeleton import skeleton_page
    >>> lines = smooth(centerline(skeleton_exact([[0, 0], [4, 0], [0, 3]])), 0.1)
    >>> [layer.name for layer in line_layers(lines, skeleton_page(lines.path), ["skeleton", "polygons"])]
    ['polygons', 'centerline']
    """
    near_to = lines.lines if isinstance(lines, SmoothLines) else lines
    name = "centerline" if isinstance(near_to, Centerlines) else "skeleton"
    made = skeleton_layers(lines.path, page, layers, name=name, points=points, exact=exact)

    def shown(layer: Layer) -> Layer:
        if not isinstance(layer, Curves) or layer.name != name:
            return layer
        return _smooth(layer, lines) if isinstance(lines, SmoothLines) else _led_on(layer, lines)

    return [shown(layer) for layer in made]


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
    """With the name, colour and width of another layer."""
    control = smoothed.control.reshape(-1, 2)
    first = 4 * np.arange(len(smoothed.control), dtype=np.int32)
    # the end of a curve is the begin of the next one on the same line
    goes_on = np.ones(len(first), dtype=bool)
    goes_on[smoothed.start[1:] - 1] = False
    last = np.where(goes_on, first + 4, first + 3)
    pairs = np.stack([first, last], axis=1).astype(np.int32)
    return CubicCurves(layer.name, control, pairs, first + 1, layer.colour, layer.width, second=first + 2)
