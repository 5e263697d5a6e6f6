"""Chords of circular arcs, by halving: square roots alone give the same bits on every machine."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats
from vorotool.numeric.coordinate_grid import record_deviation
from vorotool.numeric.ragged import starts_of

MOST_HALVINGS = 12
"""Of an arc: 4^12 times nearer than its chord."""


def chords_of(
    start: Floats, end: Floats, center: Floats, is_left: NDArray[np.bool_], tolerance: float | Floats
) -> tuple[Floats, NDArray[np.int64]]:
    """Replace arcs by chords between places on them, each at most a quarter of a circle."""
    halvings = _halvings(start, end, center, tolerance)
    first = starts_of(2**halvings)
    points = np.empty((first[-1], 2))
    points[first[:-1]] = start
    for count in range(1, int(halvings.max(initial=0)) + 1):
        arcs = np.flatnonzero(halvings == count)
        inner = _halved(start[arcs], end[arcs], center[arcs], is_left[arcs], count)
        points[(first[arcs, None] + np.arange(1, 2**count)).reshape(-1)] = inner.reshape(-1, 2)
    return points, first


def middles_of(start: Floats, end: Floats, center: Floats, is_long: NDArray[np.bool_]) -> Floats:
    """Middles of arcs that turn left, over half a circle where they are long."""
    u, v = start - center, end - center
    is_wide = (u * v).sum(axis=1) < 0  # then the chord tells more than the sum of the ends
    across = np.stack([(v - u)[:, 1], (u - v)[:, 0]], axis=1)
    middle = np.where(is_wide[:, None], across, np.where(is_long[:, None], -u - v, u + v))
    square = np.maximum((middle * middle).sum(axis=1), np.finfo(float).tiny)
    return np.asarray(center + np.sqrt((u * u).sum(axis=1) / square)[:, None] * middle)


def _halvings(start: Floats, end: Floats, center: Floats, tolerance: float | Floats) -> NDArray[np.int64]:
    """(k,) how often each arc is halved."""
    is_arc = ~np.isnan(center[:, 0])
    a, b = np.where(is_arc[:, None], [start - center, end - center], 0)
    square = (a * a).sum(axis=1)
    quarter = np.square(b - a).sum(axis=1) / 4
    halvings = np.zeros(len(a), dtype=np.int64)
    is_wide = (a * b).sum(axis=1) < 0
    for _ in range(MOST_HALVINGS):
        radius = np.sqrt(square)
        # the height of the arc over its chord, and a quarter of the square of the chord of its half
        height = quarter / np.maximum(radius + np.sqrt(np.maximum(square - quarter, 0)), np.finfo(float).tiny)
        more = is_arc & (is_wide | (height > tolerance))
        if not more.any():
            record_deviation(height[is_arc])
            break
        halvings += more
        quarter = np.where(more, radius * height / 2, quarter)
        is_wide[:] = False
    return halvings


def _halved(start: Floats, end: Floats, center: Floats, is_left: NDArray[np.bool_], count: int) -> Floats:
    """(k, 2^count - 1, 2) places inside arcs that divide them evenly."""
    ways = np.empty((len(start), 2**count + 1, 2))
    ways[:, 0], ways[:, -1] = start - center, end - center
    radius = np.sqrt(np.square(ways[:, 0]).sum(axis=1))
    step = 2**count
    while step > 1:
        a, b = ways[:, :-1:step], ways[:, step::step]
        middle = a + b
        if step == 2**count:  # of a wide arc the chord tells more than the sum of its ends
            across = (b - a)[..., ::-1] * np.where(is_left[:, None, None], [1, -1], [-1, 1])
            middle = np.where((a * b).sum(axis=-1, keepdims=True) < 0, across, middle)
        scale = radius[:, None] / np.sqrt((middle * middle).sum(axis=-1))
        ways[:, step // 2 :: step] = scale[..., None] * middle
        step //= 2
    places: Floats = center[:, None] + ways[:, 1:-1]
    return places
