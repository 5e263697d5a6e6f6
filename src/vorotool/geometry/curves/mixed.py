"""Straight lines, parabolas and circular arcs together as polylines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.curves.circular_arcs import chords_of
from vorotool.geometry.curves.flatten import polylines
from vorotool.geometry.ragged import starts_of

Floats = NDArray[np.float64]


def mixed_polylines(
    source: Floats,
    control: Floats,
    target: Floats,
    is_bent: NDArray[np.bool_],
    centre: Floats,
    is_left: NDArray[np.bool_],
    tolerance: float,
) -> tuple[Floats, NDArray[np.int64]]:
    """Give polylines of curves, of which each may be of another kind.

    Parameters
    ----------
    source, control, target : (k, 2) float64 array
        As of `polylines`.
    is_bent : (k,) bool array
        Whether each is a parabola.
    centre, is_left
        As of `chords_of`; the centre of what is no circular arc is NaN.
    tolerance : float
        How far a polyline may be from its curve.

    Returns
    -------
    points : (n, 2) float64 array
        Places along each curve, its ends included.
    start : (k + 1,) int64 array
        Where the points of each curve begin.

    Examples
    --------
    >>> none, source, target = np.full((1, 2), np.nan), np.array([[1.0, 0.0]]), np.array([[-1.0, 0.0]])
    >>> half, around = np.array([True]), np.zeros((1, 2))
    >>> mixed_polylines(source, none, target, ~half, around, half, 0.5)[0].tolist()
    [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]]
    """
    others, start = polylines(source, control, target, is_bent, tolerance)
    is_round = ~np.isnan(centre[:, 0])
    if not is_round.any():
        return others, start
    inner, first = chords_of(source[is_round], target[is_round], centre[is_round], is_left[is_round], tolerance)
    sizes = np.diff(start)
    of_others = np.repeat(~is_round, sizes)
    sizes[is_round] = np.diff(first) + 1
    starts, of_arcs = starts_of(sizes), np.repeat(is_round, sizes)
    points = np.empty((starts[-1], 2))
    points[~of_arcs] = others[of_others]
    of_arcs[starts[1:] - 1] = False
    points[of_arcs] = inner
    points[starts[1:] - 1] = target
    return points, starts
