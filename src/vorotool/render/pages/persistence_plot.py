"""A plot of how long the regions of alpha shapes last: a bar for each, from its birth to its death."""

from __future__ import annotations

from math import floor
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.inverse_functions import decimal_logarithm
from vorotool.render.canvas.styles import FAINT, INK, PALE, SEED, WHITE
from vorotool.types.table import Table

MOST = 40
"""Bars that are drawn: those of the regions that last longest."""
_ROW, _BAR, _LEFT, _RIGHT, _TOP, _BOTTOM = 18, 10, 70, 90, 34, 44
_TICKS = 10


def write_persistence_svg(out: BinaryIO, regions: Table, suggested: int, *, width: int = 1000) -> None:
    """Draw bars over r, the longest first; those of regions that stand out are darker."""
    length = np.asarray(regions["persistence"], dtype=np.float64)
    rows = np.argsort(-length, kind="stable")[:MOST]
    birth = np.asarray(regions["birth"], dtype=np.float64)
    end = birth + length
    axis = _Axis(float(end[np.isfinite(end)].max(initial=0.0)), width)
    height = _TOP + max(len(rows), 1) * _ROW + _BOTTOM
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
        'font-family="Helvetica, Arial, sans-serif" font-size="13">',
        f'<rect width="{width}" height="{height}" fill="{WHITE}"/>',
        *axis.lines(height),
        f'<g id="regions" fill="{INK}">',
        f'<text x="{_LEFT}" y="20">{_title(len(length), suggested)}</text>',
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
    top = _TOP + place * _ROW + (_ROW - _BAR) / 2
    middle, color = top + _BAR / 2, SEED if stands else FAINT
    left, right = span
    parts = [
        f'<text x="{_LEFT - 8}" y="{middle + 4.5:.1f}" text-anchor="end">{name}</text>',
        f'<rect x="{left:.2f}" y="{top:.1f}" width="{max(right - left, 0.5):.2f}" height="{_BAR}" fill="{color}"/>',
    ]
    if lives:
        tip = f"M{right:.2f} {top - 3:.1f}l10 {_BAR / 2 + 3:.1f}l-10 {_BAR / 2 + 3:.1f}z"
        parts.append(f'<path d="{tip}" fill="{color}"/>')
    after = right + (14 if lives else 6)
    return [*parts, f'<text x="{after:.1f}" y="{middle + 4.5:.1f}">{size}</text>']


class _Axis:
    """The linear axis of r, from 0 to the largest radius."""

    def __init__(self, largest: float, width: int) -> None:
        self.largest = largest if largest > 0 else 1.0
        self.left, self.right = _LEFT, max(width - _RIGHT, _LEFT + 1)

    def place(self, value: float) -> float:
        return self.left + min(value / self.largest, 1.0) * (self.right - self.left)

    def lines(self, height: int) -> list[str]:
        floor_y, parts = height - _BOTTOM, [f'<g id="axes" fill="{INK}">']
        for value in self.ticks().tolist():
            x = self.place(value)
            parts.append(f'<line x1="{x:.1f}" y1="{_TOP - 4}" x2="{x:.1f}" y2="{floor_y}" stroke="{PALE}"/>')
            parts.append(f'<text x="{x:.1f}" y="{floor_y + 18}" text-anchor="middle">{value:g}</text>')
        middle = (self.left + self.right) / 2
        parts.append(f'<text x="{middle:.0f}" y="{height - 8}" text-anchor="middle">r</text></g>')
        return parts

    def ticks(self) -> NDArray[np.float64]:
        """Multiples of 1, 2 or 5 times a power of ten, at most about ten."""
        power = floor(float(decimal_logarithm(self.largest / _TICKS)))
        decades = (float(f"{s}e{power + k}") for k in (0, 1) for s in (1, 2, 5))
        step = next((each for each in decades if self.largest / each <= _TICKS), self.largest)
        return np.arange(floor(self.largest / step) + 1, dtype=np.float64) * step
