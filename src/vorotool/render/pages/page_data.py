"""Data in pages of HTML: one file each, which needs nothing else."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

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
