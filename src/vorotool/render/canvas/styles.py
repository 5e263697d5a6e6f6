"""What a picture looks like where somebody chooses: its ground, the colors and the widths of its layers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import NamedTuple

from vorotool.plain import plain
from vorotool.render.canvas.palettes import WHITE

DRAWN_AS = {"lines": "polygons", "centerline": "skeleton", "diagram": "skeleton", "object-points": "objects"}
"""Names of layers in pictures that are chosen by another name, if not by their own."""


class ScaleBar(NamedTuple):
    """What the length of a scale bar is written in: so many of a unit are one of the data."""

    factor: float
    unit: str | None


@plain
class PictureStyle:
    """What of a picture is not left to what draws it."""

    ground: str | None = WHITE  # color of what lies beneath all layers, `#rrggbb`; None is nothing
    colors: Mapping[str, str] = field(default_factory=dict)  # of layers, by their names
    widths: Mapping[str, float] = field(default_factory=dict)  # of the lines of layers, in px
    has_legend: bool = False  # names of the layers stand in a corner, each with its color
    scale_bar: ScaleBar | None = None  # a length stands in another one
    label_by: str | None = None  # column of properties that names objects, instead of their ids

    def of(self, layer: str) -> tuple[str | None, float | None]:
        """Give color and width of a layer, None where they are left to what draws it."""
        other = DRAWN_AS.get(layer, layer)
        return self.colors.get(layer, self.colors.get(other)), self.widths.get(layer, self.widths.get(other))

    @property
    def has_insets(self) -> bool:
        """Whether there is anything in the corners."""
        return self.has_legend or self.scale_bar is not None

    def width_of(self, layer: str, usual: float = 1.0) -> float:
        """Give the width of a layer's lines, or a usual one."""
        chosen = self.of(layer)[1]
        return usual if chosen is None else chosen
