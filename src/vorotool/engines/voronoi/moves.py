"""From the lattice to the input: vertices of a map at vertices of the input get the coordinates of these."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.ragged import ranges
from vorotool.plain import plain

if TYPE_CHECKING:
    from vorotool.engines.voronoi.assembly import Arcs, Rings

Indices = NDArray[np.int64]
Floats = NDArray[np.float64]


@plain(eq=False)
class Moves:
    """Where some of many places are in the input."""

    at: Indices  # (k,) int64 array: their numbers
    xy: Floats  # (k, 2) float64 array: where each is

    def renumbered(self, number: Indices) -> Moves:
        """Give places other numbers; those below 0 are left out."""
        at = number[self.at]
        return Moves(at[at >= 0], self.xy[at >= 0])


def moved_vertices(arcs: Arcs, rings: Rings) -> Floats:
    """(v, 2) vertices of a map, where the input has them; on rings so thin that they might turn over none is moved."""
    at, xy = arcs.moves.at, arcs.moves.xy
    made = arcs.vertices.copy()
    if not at.size:
        return made
    made[at] = xy
    most = float(np.sqrt(np.square(xy - arcs.vertices[at]).sum(axis=1).max()))
    size = np.diff(rings.start)
    around = np.add.reduceat(_lengths(arcs)[rings.half_edge >> 1], rings.start[:-1])
    thin = np.flatnonzero(np.abs(rings.area) <= 2 * most * (around + size * most))
    kept = arcs.ends[rings.half_edge[ranges(rings.start[:-1][thin], size[thin])] >> 1]
    made[kept] = arcs.vertices[kept]
    return made


def _lengths(arcs: Arcs) -> Floats:
    """(a,) at least the lengths of arcs."""
    source, target = (arcs.vertices.take(end, axis=0) for end in arcs.ends.T)
    length = _norm(target - source)
    bent = np.flatnonzero(~np.isnan(arcs.control[:, 0]))
    control = arcs.control[bent]
    length[bent] = _norm(control - source[bent]) + _norm(target[bent] - control)
    round_ = np.flatnonzero(~np.isnan(arcs.center[:, 0]))
    length[round_] = 4 * _norm(source[round_] - arcs.center[round_])  # at most half a circle
    return length


def _norm(way: Floats) -> Floats:
    length: Floats = np.sqrt(np.square(way).sum(axis=1))
    return length
