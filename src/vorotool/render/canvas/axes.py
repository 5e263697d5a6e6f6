"""Layers drawn on axes of matplotlib, in the coordinates of the data."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from vorotool.convert.extras import needed
from vorotool.numeric.curves.inverse_functions import PI, cosine_and_sine
from vorotool.render.canvas.layers import Arcs, CurvedPolygons, Curves, Layer, Lines, Page, Points, Polygons, Texts

if TYPE_CHECKING:
    from matplotlib.axes import Axes

POINTS_A_PX = 0.72
"""Of a figure of matplotlib's usual 100 px an inch."""

FINENESS = 0.25
"""Px: how far lines may be from the curves that they stand for."""


def draw_on_axes(ax: Axes, layers: Iterable[Layer], page: Page, **style: Any) -> None:
    """Draw layers from below."""
    for each in layers:
        layer = each.chords(page.distance(FINENESS)) if isinstance(each, Arcs | CurvedPolygons) else each
        if not len(layer.points):
            continue
        if isinstance(layer, Texts):
            _write_texts(ax, layer)
        elif isinstance(layer, Points):
            side = 2 * layer.radius * POINTS_A_PX
            ax.scatter(
                *layer.points.T, **{"s": side * side, "c": layer.color, "linewidths": 0, "label": layer.name, **style}
            )
        elif isinstance(layer, Polygons):
            _fill(ax, layer, style)
        else:
            _draw_lines(ax, layer, page, style)


def _draw_lines(ax: Axes, layer: Lines | Curves, page: Page, style: dict[str, Any]) -> None:
    lines = layer.chords(page.distance(FINENESS)) if isinstance(layer, Curves) else layer
    given = {"colors": layer.color, "linewidths": layer.width * POINTS_A_PX, "capstyle": "round", "label": layer.name}
    if isinstance(layer, Curves) and layer.is_broken:
        given["linestyles"] = "dashed"
    collections = needed("matplotlib.collections", "plot", "plots")
    ax.add_collection(collections.LineCollection(lines.points[lines.pairs], **_chosen(given, style)))


def _fill(ax: Axes, layer: Polygons, style: dict[str, Any]) -> None:
    """Fill the polygons of each color as one path: each ring goes back to its first vertex."""
    path_of = needed("matplotlib.path", "plot", "plots").Path
    patch_of = needed("matplotlib.patches", "plot", "plots").PathPatch
    starts = np.asarray(layer.rings, dtype=np.int64)
    sizes = np.diff(starts)
    closed = np.insert(layer.corners, starts[1:], layer.corners[starts[:-1]])
    first = starts[:-1] + np.arange(len(sizes))
    codes = np.full(len(closed), path_of.LINETO, dtype=np.uint8)
    codes[first], codes[first + sizes] = path_of.MOVETO, path_of.CLOSEPOLY
    ring_polygon = layer.polygon_of_ring
    color = np.zeros(len(ring_polygon), dtype=np.int64)
    if layer.color_of is not None:
        color = np.asarray(layer.color_of)[ring_polygon]
    of_vertex = np.repeat(color, sizes + 1)
    edge = {"linewidth": 0} if layer.edge is None else {"linewidth": layer.width * POINTS_A_PX, "edgecolor": layer.edge}
    for number in np.unique(color).tolist():
        own = of_vertex == number
        given = {"facecolor": layer.colors[number], **edge, "label": layer.name}
        ax.add_patch(patch_of(path_of(layer.points[closed[own]], codes[own]), **_chosen(given, style)))


_SAME = {
    "linewidth": ("linewidth", "linewidths", "lw"),
    "linewidths": ("linewidth", "linewidths", "lw"),
    "colors": ("color", "colors", "edgecolor", "edgecolors"),
    "edgecolor": ("color", "edgecolor", "edgecolors", "ec"),
    "facecolor": ("color", "facecolor", "facecolors", "fc"),
}
"""What is given by the user for one of ours, by any of its names."""


def _chosen(given: dict[str, Any], style: dict[str, Any]) -> dict[str, Any]:
    """Our style, but what the user chooses."""
    kept = {name: value for name, value in given.items() if not any(each in style for each in _SAME.get(name, (name,)))}
    return {**kept, **style}


def _write_texts(ax: Axes, layer: Texts) -> None:
    for (x, y), text in zip(layer.points.tolist(), layer.texts, strict=True):
        away = (0, 0) if layer.is_centered else (0, layer.size / 2)
        ax.annotate(
            text,
            (x, y),
            xytext=away,
            textcoords="offset points",
            size=layer.size * POINTS_A_PX,
            color=layer.color,
            ha="center",
            va="center" if layer.is_centered else "bottom",
        )


def settle_axes(ax: Axes, *, y_up: bool, is_geographic: bool) -> None:
    """Give axes equal scales, longitudes by the cosine of the middle latitude, and y as in our pictures."""
    ax.autoscale_view()
    if ax.yaxis_inverted() == y_up:
        ax.invert_yaxis()
    middle = sum(ax.get_ylim()) / 2
    if is_geographic and abs(middle) < 89:
        ax.set_aspect(1 / float(cosine_and_sine(abs(middle) / 180 * PI)[0]))
    else:
        ax.set_aspect(1.0)
