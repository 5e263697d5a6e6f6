"""Closed walks made simple rings, and the areas of these."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.ragged import following, owners

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


def repeats(point: Indices, start: Indices) -> NDArray[np.bool_]:
    """(c,) whether each contour visits a point twice.

    Parameters
    ----------
    point : (n,) int64 array
        Numbers of places; -1 is none that is known.
    start : (c + 1,) int64 array
        Where each contour begins.

    Examples
    --------
    >>> repeats(np.array([4, 5, 4, 5, 6, -1, -1]), np.array([0, 3, 7])).tolist()
    [True, False]
    """
    contour = owners(np.diff(start))
    known = np.flatnonzero(point >= 0)
    known = known[np.lexsort((point[known], contour[known]))]
    twice = (np.diff(point[known]) == 0) & (np.diff(contour[known]) == 0)
    found = np.zeros(len(start) - 1, dtype=bool)
    found[contour[known[1:][twice]]] = True
    return found


def cut_at_repetitions(names: list[int]) -> list[list[int]]:
    """Indices of each part of a closed walk between two visits of one name; -1 is no name.

    Examples
    --------
    >>> cut_at_repetitions([7, 5, 6, 5, -1])
    [[1, 2], [0, 3, 4]]
    """
    parts: list[list[int]] = []
    path: list[int] = []
    at: dict[int, int] = {}
    for index, name in enumerate(names):
        if name in at:
            cut = at[name]
            parts.append(path[cut:])
            for passed in path[cut:]:
                at.pop(names[passed], None)
            del path[cut:]
        if name >= 0:
            at[name] = len(path)
        path.append(index)
    return [*parts, path]


def twice_areas(xy: Floats, start: Indices) -> Floats:
    """(r,) of rings, positive counter-clockwise.

    Examples
    --------
    >>> twice_areas(np.array([[0, 0], [4, 0], [0, 3], [0, 0], [0, 1], [1, 0.0]]), np.array([0, 3, 6])).tolist()
    [12.0, -1.0]
    """
    first = np.repeat(xy[start[:-1]], np.diff(start), axis=0)
    (x, y), (u, v) = (xy - first).T, (xy[following(start)] - first).T
    areas: Floats = np.add.reduceat(x * v - y * u, start[:-1]) if len(xy) else np.zeros(0)
    return areas
