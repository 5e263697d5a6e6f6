"""Plots of alpha shapes: how they change with their radius, and how long their regions last."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from math import ceil, floor
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.inverse_functions import decimal_logarithm
from vorotool.render.canvas.styles import FAINT, INK, PALE, SEED, WHITE
from vorotool.types.table import Table

_FONT = ' font-family="Helvetica, Arial, sans-serif" font-size="13"'


def _head(width: int, height: int, font: str = "") -> list[str]:
    size = f'width="{width}" height="{height}"'
    return [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="0 0 {width} {height}"{font}>',
        f'<rect {size} fill="{WHITE}"/>',
    ]


def _axes(ticks: Iterable[tuple[float, float]], y: tuple[int, int, int], middle: float, font: str = "") -> list[str]:
    """Lines across a plot from its top to its floor, with their values below, and the name of the axis."""
    top, bottom, foot = y
    parts = [f'<g id="axes"{font} fill="{INK}">']
    for value, x in ticks:
        parts.append(f'<line x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{bottom}" stroke="{PALE}"/>')
        parts.append(f'<text x="{x:.1f}" y="{bottom + 18}" text-anchor="middle">{value:g}</text>')
    return [*parts, f'<text x="{middle:.0f}" y="{foot}" text-anchor="middle">r</text></g>']


# ---- curves over the radius ----------------------------------------------------------------------
CURVES = ("area", "perimeter", "regions", "cavities", "edges")
_PANEL, _GAP, _LEFT, _RIGHT, _TOP, _BOTTOM = 110, 26, 90, 20, 20, 44


def write_curves_svg(out: BinaryIO, curves: Table, *, width: int = 1000) -> None:
    """Plot each curve over r in a panel of its own; r on a logarithmic axis."""
    r = np.asarray(curves["r"], dtype=np.float64)
    shown = (r > 0) & np.isfinite(r)
    axis = _LogarithmicAxis(r[shown], width)
    height = _TOP + len(CURVES) * (_PANEL + _GAP) - _GAP + _BOTTOM
    parts = [
        *_head(width, height),
        *_axes(axis.ticks(), (_TOP, height - _BOTTOM, height - 8), (width + _LEFT) / 2, _FONT),
    ]
    for k, name in enumerate(CURVES):
        top = _TOP + k * (_PANEL + _GAP)
        parts += _panel(name, axis, np.asarray(curves[name], dtype=np.float64)[shown], top)
    out.write(("\n".join([*parts, "</svg>"]) + "\n").encode())


class _LogarithmicAxis:
    """The logarithmic axis of r: where values are, and which pixel each radius falls into."""

    def __init__(self, r: NDArray[np.float64], width: int) -> None:
        low, high = decimal_logarithm(r[[0, -1]]).tolist() if len(r) else (0.0, 1.0)
        margin = max((high - low) * 0.03, 0.05)
        self.low, self.high = low - margin, high + margin
        self.left, self.right = _LEFT, width - _RIGHT
        self.x = self.left + (decimal_logarithm(r) - self.low) / (self.high - self.low) * (self.right - self.left)

    def place(self, value: float) -> float:
        share = (float(decimal_logarithm(value)) - self.low) / (self.high - self.low)
        return self.left + share * (self.right - self.left)

    def ticks(self) -> list[tuple[float, float]]:
        """Powers of ten; where these are few, 2 and 5 times them too; at most about a dozen."""
        decades = range(floor(self.low), ceil(self.high) + 1)
        steps = (1,) if len(decades) > 5 else (1, 2, 5)
        every = max(1, len(decades) // 12)
        values = [float(f"{s}e{d}") for d in decades if d % every == 0 for s in steps]
        return [(value, self.place(value)) for value in values if self.low <= decimal_logarithm(value) <= self.high]


def _panel(name: str, axis: _LogarithmicAxis, values: NDArray[np.float64], top: int) -> list[str]:
    finite = values[np.isfinite(values)]
    most = float(finite.max(initial=0.0)) or 1.0
    bottom = top + _PANEL
    y = bottom - np.nan_to_num(values, posinf=most) / most * _PANEL
    return [
        f'<g id="{name}"{_FONT} fill="{INK}">',
        f'<line x1="{axis.left}" y1="{bottom}" x2="{axis.right}" y2="{bottom}" stroke="{FAINT}"/>',
        f'<text x="{axis.left - 8}" y="{bottom}" text-anchor="end">0</text>',
        f'<text x="{axis.left - 8}" y="{top + 5}" text-anchor="end">{most:.4g}</text>',
        f'<text x="{axis.left - 8}" y="{(top + bottom) / 2:.0f}" text-anchor="end" font-weight="bold">{name}</text>',
        f'<path fill="none" stroke="{SEED}" stroke-width="1.5" d="{_steps(axis, y, bottom)}"/>',
        "</g>",
    ]


def _steps(axis: _LogarithmicAxis, y: NDArray[np.float64], bottom: int) -> str:
    """A path of steps; of those within a quarter of a pixel the ends and the extremes."""
    path = [f"M{axis.left} {bottom}"]
    columns = np.floor(axis.x * 4).astype(np.int64)
    starts = np.flatnonzero(np.diff(columns, prepend=-1))
    for first, last in pairwise([*starts.tolist(), len(y)]):
        inside = y[first:last]
        path.append(f"H{axis.x[first]:.2f}V{inside[0]:.2f}")
        if last - first > 1:
            low, high = float(inside.min()), float(inside.max())
            path.append(f"V{low:.2f}V{high:.2f}V{inside[-1]:.2f}")
    path.append(f"H{axis.right}")
    return "".join(path)


# ---- how long regions last -----------------------------------------------------------------------
MOST = 40
"""Bars that are drawn: those of the regions that last longest."""
_ROW, _BAR, _NAMES, _SIZES, _TITLE, _FOOT = 18, 10, 70, 90, 34, 44
_TICKS = 10


def write_persistence_svg(out: BinaryIO, regions: Table, suggested: int, *, width: int = 1000) -> None:
    """Draw bars over r, the longest first; those of regions that stand out are darker."""
    length = np.asarray(regions["persistence"], dtype=np.float64)
    rows = np.argsort(-length, kind="stable")[:MOST]
    birth = np.asarray(regions["birth"], dtype=np.float64)
    end = birth + length
    axis = _LinearAxis(float(end[np.isfinite(end)].max(initial=0.0)), width)
    height = _TITLE + max(len(rows), 1) * _ROW + _FOOT
    parts = [
        *_head(width, height, _FONT),
        *_axes(axis.ticks(), (_TITLE - 4, height - _FOOT, height - 8), (axis.left + axis.right) / 2),
        f'<g id="regions" fill="{INK}">',
        f'<text x="{_NAMES}" y="20">{_title(len(length), suggested)}</text>',
    ]
    lives = np.ma.getmaskarray(np.ma.asanyarray(regions["death"]))
    for place, row in enumerate(rows.tolist()):
        name, size = int(regions["region"][row]), int(regions["points"][row])
        span = axis.place(birth[row]), axis.place(end[row])
        parts += _bar(place, span, f"{name}", f"{size} points", stands=place < suggested, lives=bool(lives[row]))
    out.write(("\n".join([*parts, "</g>", "</svg>"]) + "\n").encode())


def _title(count: int, suggested: int) -> str:
    if not count:
        return "there are no regions"
    shown = f"; the {MOST} that last longest are shown" if count > MOST else ""
    return f"{suggested} of {count} regions {'stands' if suggested == 1 else 'stand'} out{shown}"


def _bar(place: int, span: tuple[float, float], name: str, size: str, *, stands: bool, lives: bool) -> list[str]:
    top = _TITLE + place * _ROW + (_ROW - _BAR) / 2
    middle, color = top + _BAR / 2, SEED if stands else FAINT
    left, right = span
    parts = [
        f'<text x="{_NAMES - 8}" y="{middle + 4.5:.1f}" text-anchor="end">{name}</text>',
        f'<rect x="{left:.2f}" y="{top:.1f}" width="{max(right - left, 0.5):.2f}" height="{_BAR}" fill="{color}"/>',
    ]
    if lives:
        tip = f"M{right:.2f} {top - 3:.1f}l10 {_BAR / 2 + 3:.1f}l-10 {_BAR / 2 + 3:.1f}z"
        parts.append(f'<path d="{tip}" fill="{color}"/>')
    after = right + (14 if lives else 6)
    return [*parts, f'<text x="{after:.1f}" y="{middle + 4.5:.1f}">{size}</text>']


class _LinearAxis:
    """The linear axis of r, from 0 to the largest radius."""

    def __init__(self, largest: float, width: int) -> None:
        self.largest = largest if largest > 0 else 1.0
        self.left, self.right = _NAMES, max(width - _SIZES, _NAMES + 1)

    def place(self, value: float) -> float:
        return self.left + min(value / self.largest, 1.0) * (self.right - self.left)

    def ticks(self) -> list[tuple[float, float]]:
        """Multiples of 1, 2 or 5 times a power of ten, at most about ten."""
        power = floor(float(decimal_logarithm(self.largest / _TICKS)))
        decades = (float(f"{s}e{power + k}") for k in (0, 1) for s in (1, 2, 5))
        step = next((each for each in decades if self.largest / each <= _TICKS), self.largest)
        return [(k * step, self.place(k * step)) for k in range(floor(self.largest / step) + 1)]
