"""A page that shows the alpha shapes of all radii: one file, which needs nothing else."""

from __future__ import annotations

from math import isfinite
from sys import float_info
from typing import BinaryIO

import numpy as np

from vorotool.errors import LimitError
from vorotool.numeric.numbers import nearest_double
from vorotool.products.formats import AS_PICTURE
from vorotool.render.pages.alpha_plot import CURVES
from vorotool.render.pages.page_data import Extent, packed, write_page
from vorotool.types.alpha.complex import AlphaComplex, Radius
from vorotool.types.axis import is_up
from vorotool.types.box import bounds
from vorotool.types.table import Table

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
