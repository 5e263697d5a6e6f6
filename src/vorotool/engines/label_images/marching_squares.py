"""Contours of marching squares, from the cracks between the pixels inside and outside.

scikit-image's `find_contours` takes 11 times as long for a mask (`tests/benchmarks/libraries.py contours`), for labels
each by itself, and does not tell which contour is a hole in which.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, option
from vorotool.numeric.ragged import following, starts_of, within
from vorotool.plain import plain

_CRACKS = option("--outline crack", 'outline="crack"')

Corners = NDArray[np.int32]
Rings = tuple[NDArray[np.float64], NDArray[np.int64]]
"""Vertices, and where each ring begins among them."""


@plain(eq=False)
class GrayLevel:
    """Gray values, of which those above a level are inside; none is at the level."""

    values: NDArray[Any]  # (H, W) array: finite
    level: float  # between two values


def gray_level(gray: NDArray[Any], threshold: float) -> GrayLevel:
    """Give the level of a threshold: where pixels have just this value, half-way to the next larger one."""
    if gray.dtype.kind == "f" and not np.isfinite(gray).all():
        raise InputError("the image holds NaN or infinite values: contours need finite values; use " + _CRACKS)
    above = gray > threshold
    if above.any() and (gray == threshold).any():
        return GrayLevel(gray, threshold + (float(gray[above].min()) - threshold) / 2)
    return GrayLevel(gray, threshold)


def half_way_contours(corners: Corners, start: NDArray[np.int64]) -> Rings:
    """Contours of a mask or of labels: through the middles of the cracks between pixels."""
    a, b = corners.astype(np.int64), corners[following(start)].astype(np.int64)
    way = np.sign(b - a)
    is_long = np.abs(b - a).sum(axis=1) > 1
    count = 1 + is_long
    at = starts_of(count)
    doubled = np.empty((at[-1], 2), dtype=np.int64)  # the first and the last middle along each crack
    doubled[at[:-1]] = 2 * a + way
    doubled[(at[:-1] + 1)[is_long]] = (2 * b - way)[is_long]
    start = at[start]
    kept = ~_is_straight(doubled, start)
    first = starts_of(kept)
    return doubled[kept] / 2 - 0.5, first[start]


def gray_contours(corners: Corners, start: NDArray[np.int64], gray: GrayLevel) -> Rings:
    """Contours of gray values: a vertex where the line between two pixels' centers reaches the level."""
    a, b = corners.astype(np.int64), corners[following(start)].astype(np.int64)
    length = np.abs(b - a).sum(axis=1)
    way = np.repeat(np.sign(b - a), length, axis=0)
    here = np.repeat(a, length, axis=0) + within(length)[:, None] * way
    after = np.minimum(here, here + way)  # the pixel below or on the right of each crack of unit length
    across = (way == 0).astype(np.int64)
    before = after - across
    height, width = gray.values.shape
    is_inner = ((before >= 0) & (after < [width, height])).all(axis=1)
    share = np.full(len(here), 0.5)
    low, high = (gray.values[places[is_inner, 1], places[is_inner, 0]].astype(float) for places in (before, after))
    crosses = (low > gray.level) != (high > gray.level)
    share[is_inner] = np.divide(gray.level - low, high - low, out=np.full(len(low), 0.5), where=crosses)
    return before + share[:, None] * across, starts_of(length)[start]


def _is_straight(places: NDArray[np.int64], start: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether all rings that have a place go straight through it."""
    after = following(start)
    before = np.empty_like(after)
    before[after] = np.arange(len(places))
    (ax, ay), (bx, by) = (places - places[before]).T, (places[after] - places).T
    turns = ax * by != ay * bx
    _, place = np.unique(places[:, 1] << 32 | places[:, 0] & 0xFFFFFFFF, return_inverse=True)
    straight: NDArray[np.bool_] = np.bincount(place, turns)[place] == 0
    return straight
