"""The order of borders and cuts around the places where they meet."""

from __future__ import annotations

from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import VerificationError

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
    order[sorting] = np.arange(len(tail))
    after = np.arange(1, len(tail) + 1)
    if len(starts):
        after[starts + sizes - 1] = starts
    agree = _agree(left[sorting], right[sorting][after])
    for k in np.unique(np.repeat(np.arange(len(starts)), sizes)[~agree]).tolist():
        own = sorting[starts[k] : starts[k] + sizes[k]]
        order[own] = starts[k] + _tried(own, angle, left, right)
    return order


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
            if abs(turns.sum() - 4) < 1 and _agree(left[one], right[np.roll(one, -1)]).all():
                rank = np.empty(count, dtype=np.int64)
                rank[order] = np.arange(count)
                return rank
    raise VerificationError(
        "a cut runs along a border as far as doubles tell: move the clip, the enclosures or the frame a little"
    )
