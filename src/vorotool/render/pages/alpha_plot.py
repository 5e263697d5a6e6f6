"""A plot of how alpha shapes change with their radius."""

from __future__ import annotations

from itertools import pairwise
from math import ceil, floor
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.inverse_functions import decimal_logarithm
from vorotool.render.canvas.styles import FAINT, INK, PALE, SEED, WHITE
from vorotool.types.table import Table

CURVES = ("area", "perimeter", "regions", "cavities", "edges")
_PANEL, _GAP, _LEFT, _RIGHT, _TOP, _BOTTOM = 110, 26, 90, 20, 20, 44


def write_curves_svg(out: BinaryIO, curves: Table, *, width: int = 1000) -> None:
    """Plot each curve over r in a panel of its own; r on a logarithmic axis."""
    r = np.asarray(curves["r"], dtype=np.float64)
    shown = (r > 0) & np.isfinite(r)
    r = r[shown]
    height = _TOP + len(CURVES) * (_PANEL + _GAP) - _GAP + _BOTTOM
    axis = _Axis(r, width)
    font = 'font-family="Helvetica, Arial, sans-serif" font-size="13"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">',
        f'<rect width="{width}" height="{height}" fill="{WHITE}"/>',
        f'<g id="axes" {font} fill="{INK}">',
    ]
    floor_y = height - _BOTTOM
    for value in axis.ticks():
        x = axis.place(value)
        parts.append(f'<line x1="{x:.1f}" y1="{_TOP}" x2="{x:.1f}" y2="{floor_y}" stroke="{PALE}"/>')
        parts.append(f'<text x="{x:.1f}" y="{floor_y + 18}" text-anchor="middle">{value:g}</text>')
    parts.append(f'<text x="{(width + _LEFT) / 2:.0f}" y="{height - 8}" text-anchor="middle">r</text></g>')
    for k, name in enumerate(CURVES):
        top = _TOP + k * (_PANEL + _GAP)
        parts += _panel(name, axis, np.asarray(curves[name], dtype=np.float64)[shown], top, width, font)
    out.write(("\n".join([*parts, "</svg>"]) + "\n").encode())


class _Axis:
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

    def ticks(self) -> list[float]:
        """Powers of ten; where these are few, 2 and 5 times them too; at most about a dozen."""
        decades = range(floor(self.low), ceil(self.high) + 1)
        steps = (1,) if len(decades) > 5 else (1, 2, 5)
        every = max(1, len(decades) // 12)
        values = [float(f"{s}e{d}") for d in decades if d % every == 0 for s in steps]
        return [value for value in values if self.low <= decimal_logarithm(value) <= self.high]


def _panel(name: str, axis: _Axis, values: NDArray[np.float64], top: int, width: int, font: str) -> list[str]:
    finite = values[np.isfinite(values)]
    most = float(finite.max(initial=0.0)) or 1.0
    bottom = top + _PANEL
    y = bottom - np.nan_to_num(values, posinf=most) / most * _PANEL
    return [
        f'<g id="{name}" {font} fill="{INK}">',
        f'<line x1="{axis.left}" y1="{bottom}" x2="{axis.right}" y2="{bottom}" stroke="{FAINT}"/>',
        f'<text x="{axis.left - 8}" y="{bottom}" text-anchor="end">0</text>',
        f'<text x="{axis.left - 8}" y="{top + 5}" text-anchor="end">{most:.4g}</text>',
        f'<text x="{axis.left - 8}" y="{(top + bottom) / 2:.0f}" text-anchor="end" font-weight="bold">{name}</text>',
        f'<path fill="none" stroke="{SEED}" stroke-width="1.5" d="{_steps(axis, y, bottom)}"/>',
        "</g>",
    ]


def _steps(axis: _Axis, y: NDArray[np.float64], bottom: int) -> str:
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
