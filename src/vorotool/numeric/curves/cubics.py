"""Cubic Bézier curves: places on them, parts of them, and polylines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.flatten import MOST_PIECES
from vorotool.numeric.ragged import owners, starts_of, within

Floats = NDArray[np.float64]


def places_at(control: Floats, t: Floats) -> Floats:
    """(n, 2) places on curves, each at its parameter."""
    a, b, c, d = np.moveaxis(control, 1, 0)
    t = t[:, None]
    u = 1 - t
    places: Floats = u * u * u * a + 3 * t * u * (u * b + t * c) + t * t * t * d
    return places


def parts_between(control: Floats, first: Floats, last: Floats) -> Floats:
    """(n, 4, 2) control points of the parts of curves from one parameter to another."""
    made = np.empty_like(control)
    for k, parameters in enumerate(((first,) * 3, (first, first, last), (first, last, last), (last,) * 3)):
        points = np.moveaxis(control, 1, 0)
        for t in parameters:  # the blossom
            points = points[:-1] + t[:, None] * (points[1:] - points[:-1])
        made[:, k] = points[0]
    return made


def cubic_polylines(control: Floats, tolerance: float | Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Curves as polylines, divided evenly in their parameter."""
    second = control[:, 2:] - 2 * control[:, 1:-1] + control[:, :-2]
    bend = np.sqrt((second * second).sum(axis=2)).max(axis=1, initial=0.0)
    pieces = np.clip(np.ceil(np.sqrt(0.75 * bend / tolerance)), 1, MOST_PIECES).astype(np.int64)
    curve = owners(pieces + 1)
    points = places_at(control[curve], within(pieces + 1) / pieces[curve])
    start = starts_of(pieces + 1)
    points[start[:-1]], points[start[1:] - 1] = control[:, 0], control[:, 3]
    return points, start
