"""The order of borders and cuts around the places where they meet."""

from __future__ import annotations

from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import VerificationError
from vorotool.types.voronoi.voronoi_map import OUTSIDE

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

UNKNOWN = -2

_MOST_TRIED = 7
"""Ends at one place, of which all orders are tried."""

_NEAR = 2.0**-6
"""Of a right angle, within which two directions may be taken for the other way round where the sites say so."""


def quarters(way: Floats) -> Floats:
    """(k,) numbers from 0 to 4 that rise with the angle of directions, by one a right angle."""
    x, y = way.T
    size = np.abs(x) + np.abs(y)
    size = np.where(size > 0, size, 1)
    turned = np.where(y >= 0, 1 - x / size, 3 + x / size)
    made: Floats = np.where(turned >= 4, 0, turned)
    return made


def order_around(tail: Indices, angle: Floats, left: Indices, right: Indices) -> Indices:
    """(h,) numbers that rise counter-clockwise among the ends that leave a place."""
    sorting = np.lexsort((angle, tail))
    starts = np.flatnonzero(np.diff(tail[sorting], prepend=-1))
    sizes = np.diff(starts, append=len(tail))
    order = np.empty(len(tail), dtype=np.int64)
    after = np.arange(1, len(tail) + 1)
    if len(starts):
        after[starts + sizes - 1] = starts
    thin = _is_thin_inside(angle[sorting], left[sorting], right[sorting], after)
    sorting[thin], sorting[after[thin]] = sorting[after[thin]], sorting[thin]
    order[sorting] = np.arange(len(tail))
    agree = _agree(left[sorting], right[sorting][after])
    for k in np.unique(np.repeat(np.arange(len(starts)), sizes)[~agree]).tolist():
        own = sorting[starts[k] : starts[k] + sizes[k]]
        order[own] = starts[k] + _tried(own, angle, left, right)
    return order


def _is_thin_inside(angle: Floats, left: Indices, right: Indices, after: Indices) -> Indices:
    """List ends of limits with less than a right angle of their cell up to the next end: they come after that one."""
    # A disc around a site touches each limit from inside, so that a cell has at least half a turn between two of them;
    # where discs touch each other, limits leave in one direction, with what is beyond both between them.
    turn = (angle[after] - angle) % 4
    is_border = (left[:, 0] == right[:, 0]) & (left[:, 0] == left[after, 0]) & (left[after, 0] == right[after, 0])
    is_inside = (right[:, 1] == OUTSIDE) & (left[:, 1] >= 0) & (right[after, 1] >= 0) & (left[after, 1] == OUTSIDE)
    return np.flatnonzero(is_border & is_inside & (turn < 1))


def _agree(left: Indices, right: Indices) -> NDArray[np.bool_]:
    known = (left[:, 1] != UNKNOWN) & (right[:, 1] != UNKNOWN)
    same: NDArray[np.bool_] = (left[:, 0] == right[:, 0]) & ((left[:, 1] == right[:, 1]) | ~known)
    return same


def _tried(own: Indices, angle: Floats, left: Indices, right: Indices) -> Indices:
    """The rank of each of the ends at one place, whose first one stays."""
    count = len(own)
    if count <= _MOST_TRIED:
        for rest in permutations(range(1, count)):
            order = np.array([0, *rest])
            turns = np.diff(angle[own[order]], append=angle[own[0]] + 4)
            turns = (turns + _NEAR) % 4 - _NEAR
            one = own[order]
            after = np.roll(np.arange(count), -1)
            is_thin = _is_thin_inside(angle[one], left[one], right[one], after).size > 0
            if abs(turns.sum() - 4) < 1 and not is_thin and _agree(left[one], right[one][after]).all():
                rank = np.empty(count, dtype=np.int64)
                rank[order] = np.arange(count)
                return rank
    raise VerificationError(
        "the clip, an enclosure or the frame coincides with a cell border to within rounding: shift it slightly"
    )
