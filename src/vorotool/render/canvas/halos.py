"""Edges of lines and points, white or around light ones dark, which show on dark and on light ground with them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from vorotool.render.canvas.layers import Arcs, Curves, Layer, Lines, Points
from vorotool.render.canvas.styles import edge_color


def halo_width(width: float) -> float:
    """Give the width of a line with an edge of up to 1 px on both sides: many fine lines leave no more room."""
    return width + min(2.0, 2 * width)


def with_halos(layers: Sequence[Layer]) -> list[Layer]:
    """Put an edge beneath each layer of lines and of points, so that they show on dark and on light ground."""
    made: list[Layer] = []
    for layer in layers:
        name = f"{layer.name}-halo"
        if isinstance(layer, Arcs):
            made.append(
                replace(layer, name=name, width=halo_width(layer.width), edge=edge_color(layer.edge), fill=None)
            )
        elif isinstance(layer, Lines | Curves):
            made.append(replace(layer, name=name, width=halo_width(layer.width), color=edge_color(layer.color)))
        elif isinstance(layer, Points):
            made.append(replace(layer, halo=edge_color(layer.color)))
            continue
        made.append(layer)
    return made
