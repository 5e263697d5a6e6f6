"""Pages on which lengths of the data have a size on paper, and pages of legends in pixels."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError, option
from vorotool.render.canvas.layers import MARGIN, Arcs, Curves, Layer, Lines, Page, Points, Polygons, Texts
from vorotool.render.canvas.styles import PictureStyle, edge_color

PX = 96 / 25.4
"""Of a millimeter."""

LARGEST = 1e6
"""Millimeters: a kilometer of paper."""

LEAST = 1e-3
"""Millimeters: what is smaller has no digits left."""


class ScaledPage(Page):
    """A page whose lengths are those of the data, by a scale; a px is 1/96 in."""

    decimals = 4

    def __init__(
        self, bounds: tuple[float, float, float, float], *, y_up: bool, millimeters: float, margin: float = MARGIN
    ) -> None:
        super().__init__(bounds, width=1000, y_up=y_up)
        low, high = np.ldexp(np.array(bounds, dtype=np.float64), -self._exponent).reshape(2, 2)
        span = high - low
        with np.errstate(over="ignore", under="ignore"):
            scale = float(np.ldexp(millimeters, self._exponent))
            sides = [float(side) for side in (span + 2 * margin * (span.max() or 1.0)) * scale]
        if not (isfinite(scale) and min(sides) > 0 and LEAST <= max(sides) <= LARGEST):
            raise UsageError(
                f"the page would be {sides[0]:.3g} mm by {sides[1]:.3g} mm: choose another {option('--scale')}, from "
                f"{LEAST:g} to {LARGEST:g} mm"
            )
        self._sides = sides
        self.scale = scale * PX
        self.width, self.height = (side * PX for side in sides)  # type: ignore[assignment]

    @property
    def size(self) -> str:
        """Attributes of its size."""
        across, down = (_short(side) for side in self._sides)
        return f'width="{across}mm" height="{down}mm"'

    @property
    def extent(self) -> str:
        """Its width and height in px, as a viewBox has them."""
        return f"{_short(self.width)} {_short(self.height)}"


def _short(number: float) -> str:
    return f"{number:.6f}".rstrip("0").rstrip(".")


def styled_layers(layers: Iterable[Layer], style: PictureStyle) -> list[Layer]:
    """Give layers the colors and widths that are chosen for them."""
    made = [_styled(layer, *style.of(layer.name)) for layer in layers]
    return [layer for layer in made if not (isinstance(layer, Lines | Curves) and layer.width == 0)]


def _styled(layer: Layer, color: str | None, width: float | None) -> Layer:
    if width == 0 and isinstance(layer, Polygons):
        layer = replace(layer, edge=None)
    elif width is not None and not isinstance(layer, Points | Texts):
        layer = replace(layer, width=width)
    if color is None:
        return layer
    if isinstance(layer, Arcs):
        return replace(layer, edge=color)
    if isinstance(layer, Polygons):  # areas of many colors keep them: what is chosen is that of their outlines
        return replace(layer, colors=[color]) if len(layer.colors) == 1 else replace(layer, edge=color)
    if isinstance(layer, Points | Texts) and layer.halo is not None:
        return replace(layer, color=color, halo=edge_color(color))
    return replace(layer, color=color)


class PixelPage(Page):
    """The page of what is placed in px of another page, such as a legend."""

    def __init__(self, page: Page) -> None:
        super().__init__((0.0, 0.0, float(page.width), float(page.height)), width=page.width, y_up=False)
        self.width, self.height, self.style, self.decimals = page.width, page.height, page.style, page.decimals

    def place(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 2) px from the left and from the top: the points themselves."""
        return points

    def length(self, distance: float) -> float:
        """Px of a distance."""
        return distance
