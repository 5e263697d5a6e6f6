"""How often rings turn around places, by a tree of boxes around runs of edges: in memory linear in edges and places."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_FAN = 4
"""Runs of edges in a run of the next level."""

_PAIRS_AT_ONCE = 2**17
"""Of places and runs of edges."""


class _Runs(NamedTuple):
    """One level of the tree: the boxes of its runs, and the first edge of each."""

    low: Floats
    high: Floats
    first: Indices


def windings(rings: Sequence[Floats], places: Floats) -> Indices:
    """Count how often rings turn around places: by what a ray towards larger x crosses."""
    edges = _Edges(rings)
    found = np.zeros(len(places), dtype=np.int64)
    top = len(edges.levels) - 1
    waiting = [(top, np.arange(len(places)), np.zeros(len(places), dtype=np.int64))]
    while waiting:
        level, place, run = waiting.pop()
        if len(place) > _PAIRS_AT_ONCE:
            waiting += [(level, place[part], run[part]) for part in _halves(len(place))]
            continue
        here, runs = places[place], edges.levels[level]
        low, high = runs.low[run], runs.high[run]
        in_row = (low[:, 1] <= here[:, 1]) & (here[:, 1] < high[:, 1]) & (here[:, 0] < high[:, 0])
        place, run, here = place[in_row], run[in_row], here[in_row]
        is_left = here[:, 0] < low[in_row, 0]
        if level == 0:
            turns = edges.turns(run, here, is_left)
            np.add.at(found, place, turns)
            continue
        np.add.at(found, place[is_left], edges.rise(level, run[is_left], here[is_left, 1]))
        place, run = place[~is_left], run[~is_left]
        inner = (run[:, None] * _FAN + np.arange(_FAN)).reshape(-1)
        exists = inner < len(edges.levels[level - 1].first)
        waiting.append((level - 1, np.repeat(place, _FAN)[exists], inner[exists]))
    return found


def _halves(count: int) -> tuple[slice, slice]:
    return slice(0, count // 2), slice(count // 2, count)


class _Edges:
    """The edges of rings, one after the other, and the levels of their tree, from single edges upwards."""

    def __init__(self, rings: Sequence[Floats]) -> None:
        sizes = np.array([len(ring) for ring in rings], dtype=np.int64)
        self.start: Floats = np.concatenate(rings)
        self.end: Floats = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
        begins = np.repeat(self.start[np.cumsum(sizes) - sizes, 1], sizes)
        # by the edges before one, of whole rings and the begun one, a ray rises from the height of where that begins
        self._from, self._to = np.append(begins, 0.0), np.append(self.start[:, 1], 0.0)
        count = len(self.start)
        runs = _Runs(np.minimum(self.start, self.end), np.maximum(self.start, self.end), np.arange(count))
        self.levels = [runs]
        while len(runs.first) > 1:
            at = np.arange(0, len(runs.first), _FAN)
            low, high = np.minimum.reduceat(runs.low, at), np.maximum.reduceat(runs.high, at)
            runs = _Runs(low, high, runs.first[at])
            self.levels.append(runs)

    def turns(self, edge: Indices, here: Floats, is_left: NDArray[np.bool_]) -> Indices:
        """Give 1 for edges that rise over a ray, -1 for those that fall, 0 for those that it does not meet."""
        x, y = here.T
        (ax, ay), (bx, by) = self.start[edge].T, self.end[edge].T
        goes_up, goes_down = (ay <= y) & (by > y), (by <= y) & (ay > y)
        side = (bx - ax) * (y - ay) - (by - ay) * (x - ax)  # above 0: the place is left of the edge
        is_met = goes_up & (is_left | (side > 0))
        return np.asarray(is_met.astype(np.int64) - (goes_down & (is_left | (side < 0))))

    def rise(self, level: int, run: Indices, y: Floats) -> Indices:
        """Give the sum of the turns of all edges of a run that is right of its ray."""
        first = self.levels[level].first
        bounds = np.append(first, len(self.start))
        begin, end = bounds[run], bounds[run + 1]
        return self._risen(end, y) - self._risen(begin, y)

    def _risen(self, edge: Indices, y: Floats) -> Indices:
        """Give the sum of the turns of all edges before one."""
        return np.asarray((self._to[edge] > y).astype(np.int64) - (self._from[edge] > y))
