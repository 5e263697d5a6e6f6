"""Pages of a scale, and the legend and the scale bar of a picture: layers in px of its page."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from decimal import Decimal
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError, option
from vorotool.render.canvas.layers import MARGIN, Arcs, Curves, Layer, Lines, Page, Points, Polygons, Texts
from vorotool.render.canvas.styles import FAINT, INK, WHITE, PictureStyle, ScaleBar, edge_color, is_light

LETTERS = 1 / 60
"""Size of letters, as a part of the page's width."""

LEAST, LARGEST = 10.0, 16.0
"""Size of letters in px."""

ADVANCE = 0.62
"""From one letter to the next, as a part of their size."""

LONGEST = 0.25
"""Of a scale bar, as a part of the page's width."""


def insets(layers: Sequence[Layer], page: Page) -> list[Layer]:
    """Make the legend and the scale bar that the style of a page asks for."""
    style = page.style
    made: list[Layer] = []
    if style.has_legend:
        made += _legend(layers, page)
    if style.scale_bar is not None:
        made += _scale_bar(style.scale_bar, page)
    return made


def rounded_length(longest: float) -> float:
    """Give the largest length of 1, 2 or 5 times a power of ten that is at most so long."""
    power = Decimal(longest).adjusted()
    return max(length for k in (power - 1, power, power + 1) for length in _lengths(k) if length <= longest)


def _lengths(power: int) -> Iterable[float]:
    return (float(f"{number}e{power}") for number in (1, 2, 5))


def letter_size(page: Page) -> float:
    """Give the size of letters on a page, in px."""
    return min(max(page.width * LETTERS, LEAST), LARGEST)


def box(name: str, low: tuple[float, float], high: tuple[float, float], fill: str, edge: str | None) -> Polygons:
    """Give a rectangle between two of its corners, as a layer of a name."""
    corners = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    return Polygons(name, corners, np.arange(4, dtype=np.int32), np.array([0, 4]), colors=[fill], edge=edge, width=1.0)


def _line(name: str, places: NDArray[np.float64], color: str, width: float) -> Lines:
    pairs = np.stack([np.arange(len(places) - 1), np.arange(1, len(places))], axis=1).astype(np.int32)
    return Lines(name, places, pairs, color, width)


def _legend(layers: Sequence[Layer], page: Page) -> list[Layer]:
    """A box in the upper right corner with a row for each layer that is no text, the topmost first."""
    shown = [layer for layer in reversed(layers) if not isinstance(layer, Texts)]
    if not shown:
        return []
    size = letter_size(page)
    row, gap = 1.6 * size, 0.6 * size
    longest = max(len(layer.name) for layer in shown)
    across, down = 2 * gap + 2.4 * size + ADVANCE * size * longest, 2 * gap + row * len(shown)
    left, top = page.width - across - gap, gap
    made: list[Layer] = [box("legend", (left, top), (left + across, top + down), WHITE, FAINT)]
    for number, layer in enumerate(shown):
        middle = top + gap + row * (number + 0.5)
        made += _sample(layer, left + gap, middle, size)
    places = np.array([[left + gap + 2.4 * size, top + gap + row * (k + 0.5)] for k in range(len(shown))])
    names = [layer.name for layer in shown]
    return [*made, Texts("legend-names", places, names, size=size, is_centered=True, is_led=True)]


def _sample(layer: Layer, left: float, middle: float, size: float) -> list[Layer]:
    """A small piece of a layer, as wide as two letters are high."""
    name, right = f"legend-{layer.name}", left + 2 * size
    ends = np.array([[left, middle], [right, middle]])
    if isinstance(layer, Points):
        return [replace(layer, name=name, points=ends.mean(axis=0, keepdims=True), radius=max(layer.radius, 2.0))]
    if isinstance(layer, Polygons) or (isinstance(layer, Arcs) and layer.fill is not None):
        fill = layer.fill if isinstance(layer, Arcs) else _fill(layer)
        low, high = (left, middle - 0.5 * size), (right, middle + 0.5 * size)
        return [box(name, low, high, fill or WHITE, FAINT if layer.edge in (None, WHITE) else layer.edge)]
    if isinstance(layer, Curves):
        control = np.array([-1], dtype=np.int32)
        pairs = np.array([[0, 1]], dtype=np.int32)
        straight = Curves(name, ends, pairs, control, layer.color, max(layer.width, 1.0), layer.is_broken)
        return [straight]
    assert isinstance(layer, Lines | Arcs)  # texts have no row
    color = layer.edge if isinstance(layer, Arcs) else layer.color
    return [_line(name, ends, color, max(layer.width, 1.0))]


def _fill(layer: Polygons) -> str:
    """The first color that is used."""
    return layer.colors[0 if layer.color_of is None or not len(layer.color_of) else int(layer.color_of[0])]


def _scale_bar(bar: ScaleBar, page: Page) -> list[Layer]:
    """A line with serifs in the lower left corner, and its length over it; white on dark ground."""
    size = letter_size(page)
    unit = page.length(1.0) / bar.factor  # px of a unit of the bar
    longest = LONGEST * page.width / unit if unit > 0 else 0.0
    if not 0 < longest < float("inf"):
        raise UsageError(f"no length fits as a scale bar: leave out {option('--scale-bar', 'scale_bar=True')}")
    length = rounded_length(longest)
    left, low, serif = 2 * size, page.height - 2 * size, 0.3 * size
    right = left + length * unit
    places = np.array([[left, low - serif], [left, low], [right, low], [right, low - serif]])
    ground = page.style.ground
    usual = INK if page.backdrop is not None or ground is None or is_light(ground) else WHITE
    color = page.style.of("scale-bar")[0] or usual
    lines = _line("scale-bar", places, color, 2.0)
    over = np.array([[(left + right) / 2, low - 1.1 * size]])
    name = f"{length:.10g} {bar.unit}" if bar.unit else f"{length:.10g}"
    return [
        replace(lines, name="scale-bar-halo", color=edge_color(color), width=5.0),
        lines,
        Texts("scale-bar-length", over, [name], color, size, edge_color(color), is_centered=True),
    ]


PX = 96 / 25.4
"""Of a millimeter."""

LARGEST_PAGE = 1e6
"""Millimeters: a kilometer of paper."""

LEAST_PAGE = 1e-3
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
        if not (isfinite(scale) and min(sides) > 0 and LEAST_PAGE <= max(sides) <= LARGEST_PAGE):
            raise UsageError(
                f"the page would be {sides[0]:.3g} mm by {sides[1]:.3g} mm: choose another {option('--scale')}, from "
                f"{LEAST_PAGE:g} to {LARGEST_PAGE:g} mm"
            )
        self._sides = sides
        self.scale = scale * PX
        self.width, self.height = (side * PX for side in sides)  # type: ignore[assignment]

    @property
    def size(self) -> str:
        """Attributes of its size."""
        across, down = (short(side) for side in self._sides)
        return f'width="{across}mm" height="{down}mm"'

    @property
    def extent(self) -> str:
        """Its width and height in px, as a viewBox has them."""
        return f"{short(self.width)} {short(self.height)}"


def short(number: float, decimals: int = 6) -> str:
    """Write a number with so many decimals at most."""
    return f"{number:.{decimals}f}".rstrip("0").rstrip(".")


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
