"""A page that shows the alpha shapes of all radii: one file, which needs nothing else."""

from __future__ import annotations

import json
from base64 import b64encode
from math import isfinite
from pathlib import Path
from sys import float_info
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import LimitError
from vorotool.numeric.numbers import nearest_double
from vorotool.products.formats import AS_PICTURE
from vorotool.types.alpha.complex import AlphaComplex, Radius
from vorotool.types.axis import is_up
from vorotool.types.box import bounds
from vorotool.types.table import Table

MOST_POINTS = 100_000
"""Some 30 MB of data: browsers draw so many in about a second."""

PAGE = "alpha_page.html"
_CURVES = ("area", "perimeter", "regions", "cavities", "edges")
_PLACE = "/*DATA*/null"


def check_html_size(family: AlphaComplex) -> None:
    """Refuse a page that no browser would draw."""
    if len(family.points) > MOST_POINTS:
        raise LimitError(
            f"{len(family.points)} points are too many for a page, at most {MOST_POINTS}: use {AS_PICTURE}"
        )


def write_alpha_html(out: BinaryIO, family: AlphaComplex, curves: Table, *, r: Radius | None = None) -> None:
    """Write a page with a slider over r: the shape, the classes of its edges, and curves."""
    check_html_size(family)
    page = Path(__file__).with_name(PAGE).read_text(encoding="utf-8")
    before, after = page.split(_PLACE)
    up = is_up(family.mesh)
    data = json.dumps(_data(family, curves, _first_radius(family, r), up), separators=(",", ":"), allow_nan=False)
    out.write(f"{before}{data}{after}".encode())


def _first_radius(family: AlphaComplex, r: Radius | None) -> float:
    """The radius, or one beyond all where it is infinite."""
    finite = family.spectrum[np.isfinite(family.spectrum)]
    largest = float(finite[-1]) if len(finite) else 1.0
    if r is None:
        return float(finite[len(finite) // 2]) if len(finite) else largest
    chosen = nearest_double(r)
    return chosen if isfinite(chosen) else min(2 * largest, float_info.max)


def _data(family: AlphaComplex, curves: Table, r: float, y_up: bool) -> dict[str, Any]:
    """Arrays as the page decodes them; coordinates from the upper left corner, in parts of the larger side."""
    with np.errstate(over="ignore"):
        exponent = int(np.frexp(np.abs(family.points).max(initial=0.0))[1])
    points = np.ldexp(family.points, -exponent)
    low, high = bounds(points) if len(points) else np.zeros((2, 2))
    span = high - low
    size = float(span.max()) or 1.0
    places = np.stack([points[:, 0] - low[0], (high[1] - points[:, 1]) if y_up else (points[:, 1] - low[1])], axis=1)
    return {
        "r": r,
        "width": float(span[0]) / size or 1e-9,
        "height": float(span[1]) / size or 1e-9,
        "xy": _packed(places / size, "<f4"),
        "edges": _packed(family.edges, "<i4"),
        "triangles": _packed(family.mesh.triangles, "<i4"),
        "rank_min": _packed(family.rank_min, "<i4"),
        "rank_mid": _packed(family.rank_mid, "<i4"),
        "rank_max": _packed(family.rank_max, "<i4"),
        "triangle_rank": _packed(family.triangle_rank, "<i4"),
        "spectrum": _packed(family.spectrum, "<f8"),
        "curves": {
            name: _packed(curves[name], "<f8") for name in ("area", "perimeter", "regions", "cavities", "edges")
        },
    }


def _packed(values: NDArray[Any], dtype: DTypeLike) -> str:
    return b64encode(np.ascontiguousarray(values, dtype=dtype).tobytes()).decode()
