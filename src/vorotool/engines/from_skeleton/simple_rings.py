"""Closed walks made simple rings, and the areas of these."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, Indices, following, owners


def repeats(point: Indices, start: Indices) -> NDArray[np.bool_]:
    """(c,) whether each contour visits a point twice."""
    contour = owners(np.diff(start))
    known = np.flatnonzero(point >= 0)
    known = known[np.lexsort((point[known], contour[known]))]
    twice = (np.diff(point[known]) == 0) & (np.diff(contour[known]) == 0)
    found = np.zeros(len(start) - 1, dtype=bool)
    found[contour[known[1:][twice]]] = True
    return found


def cut_at_repetitions(names: list[int]) -> list[list[int]]:
    """Indices of each part of a closed walk between two visits of one name; -1 is no name."""
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
    """(r,) of rings, positive counter-clockwise."""
    first = np.repeat(xy[start[:-1]], np.diff(start), axis=0)
    (x, y), (u, v) = (xy - first).T, (xy[following(start)] - first).T
    areas: Floats = np.add.reduceat(x * v - y * u, start[:-1]) if len(xy) else np.zeros(0)
    return areas
