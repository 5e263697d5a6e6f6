"""Data in self-contained HTML pages, and the page of the alpha shapes of all radii."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from sys import float_info
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from vorotool.errors import LimitError
from vorotool.numeric.numbers import nearest_double
from vorotool.products.formats import AS_PICTURE
from vorotool.render.pages.alpha_plot import CURVES
from vorotool.types.alpha.complex import AlphaComplex, Radius
from vorotool.types.axis import is_up
from vorotool.types.box import bounds
from vorotool.types.table import Table

_PLACE = "/*DATA*/null"


def write_page(out: BinaryIO, name: str, data: Mapping[str, Any]) -> None:
    """Write the page of a name with its data."""
    before, after = Path(__file__).with_name(name).read_text(encoding="utf-8").split(_PLACE)
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    out.write(f"{before}{text.replace('<', chr(92) + 'u003c')}{after}".encode())  # no text ends the script


class Extent:
    """What a page shows; its coordinates begin in the upper left corner, in parts of the larger side."""

    def __init__(self, low: ArrayLike, high: ArrayLike, *, y_up: bool) -> None:
        box = np.array([low, high], dtype=np.float64)
        self._exponent = int(np.frexp(np.abs(box).max())[1])  # a power of two keeps differences within range
        (self._left, top), (_, bottom) = np.ldexp(box, -self._exponent)
        span = np.ldexp(box[1], -self._exponent) - np.ldexp(box[0], -self._exponent)
        self._side, self._top, self._y_up = float(span.max()) or 1.0, bottom if y_up else top, y_up
        self.sides = {"width": float(span[0]) / self._side or 1e-9, "height": float(span[1]) / self._side or 1e-9}

    def places(self, xy: NDArray[np.float64]) -> str:
        """Give coordinates as text."""
        x, y = np.ldexp(xy, -self._exponent).T
        down = self._top - y if self._y_up else y - self._top
        return packed(np.stack([x - self._left, down], axis=1) / self._side, "<f4")


def json_value(value: Any) -> Any:
    """Give a number or a text as JSON has them; what is missing or no number is None."""
    if value is np.ma.masked:
        return None
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, float):
        return value if isfinite(value) else None
    return value if value is None or isinstance(value, bool | int | str) else str(value)


def packed(values: ArrayLike, dtype: DTypeLike) -> str:
    """Give the bytes of an array as text."""
    return b64encode(np.ascontiguousarray(values, dtype=dtype).tobytes()).decode()


MOST_POINTS = 100_000
"""Some 30 MB of data: browsers draw so many in about a second."""

PAGE = "alpha_page.html"


def check_html_size(family: AlphaComplex) -> None:
    """Refuse a page that no browser would draw."""
    if len(family.points) > MOST_POINTS:
        raise LimitError(
            f"{len(family.points)} points are too many for a page, at most {MOST_POINTS}: use {AS_PICTURE}"
        )


def write_alpha_html(out: BinaryIO, family: AlphaComplex, curves: Table, *, r: Radius | None = None) -> None:
    """Write a page with a slider over r: the shape, the classes of its edges, and curves."""
    check_html_size(family)
    points, mesh = family.points, family.mesh
    low, high = bounds(points) if len(points) else (np.zeros(2), np.zeros(2))
    extent = Extent(low, high, y_up=is_up(mesh))
    whole = {"edges": family.edges, "triangles": mesh.triangles}
    whole |= {name: getattr(family, name) for name in ("rank_min", "rank_mid", "rank_max", "triangle_rank")}
    data = {
        "r": _first_radius(family, r),
        **extent.sides,
        "xy": extent.places(points),
        **{name: packed(values, "<i4") for name, values in whole.items()},
        "spectrum": packed(family.spectrum, "<f8"),
        "curves": {name: packed(curves[name], "<f8") for name in CURVES},
    }
    write_page(out, PAGE, data)


def _first_radius(family: AlphaComplex, r: Radius | None) -> float:
    """The radius, or one beyond all where it is infinite."""
    finite = family.spectrum[np.isfinite(family.spectrum)]
    largest = float(finite[-1]) if len(finite) else 1.0
    if r is None:
        return float(finite[len(finite) // 2]) if len(finite) else largest
    chosen = nearest_double(r)
    return chosen if isfinite(chosen) else min(2 * largest, float_info.max)
