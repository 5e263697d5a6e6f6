"""How rings lie in one another, by a sweep over the plane: in time that is nearly linear in their edges."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from fractions import Fraction
from functools import cmp_to_key
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import LimitError

Floats = NDArray[np.float64]
Point = tuple[float, float]

OUTSIDE = -1
"""The parent of rings that lie in no other."""

MOST_MEETINGS = 2**21
"""Of edges with vertices of other edges."""

_UNKNOWN = -2
_ROUNDING = 2.0**-51
"""Of the products of an orientation: more than rounding takes away."""


class Nesting(NamedTuple):
    """How rings lie in one another."""

    parent: list[int]  # the smallest ring around each, or `OUTSIDE`
    order: list[int]  # all rings, each behind its parent


def nesting_of(rings: Sequence[Floats], turns: Sequence[int], areas: Sequence[float]) -> Nesting | None:
    """Find the parent of each ring, exactly; None where two of them cross or are the same."""
    sweep = _Sweep(rings, turns, areas)
    return Nesting(sweep.parent, sweep.order) if sweep.runs() else None


class _Edge(NamedTuple):
    """An edge from its left to its right end."""

    left: Point
    right: Point
    ring: int
    is_lower: bool  # whether the inside of its ring is above it


class _Sweep:
    """The line of a sweep, from left to right, and upwards among places of one x."""

    def __init__(self, rings: Sequence[Floats], turns: Sequence[int], areas: Sequence[float]) -> None:
        self.areas = areas
        self.parent = [_UNKNOWN] * len(rings)
        self.order: list[int] = []
        self.active: list[_Edge] = []
        self.beginning: dict[Point, list[_Edge]] = {}
        for k, ring in enumerate(rings):
            corners = list(map(tuple, ring.tolist()))
            for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
                if a != b:
                    left, right = min(a, b), max(a, b)
                    self.beginning.setdefault(left, []).append(_Edge(left, right, k, (a < b) == (turns[k] > 0)))
                    self.beginning.setdefault(right, [])

    def runs(self) -> bool:
        """Run; whether no ring crosses another."""
        active, meetings = self.active, 0
        for here in sorted(self.beginning):
            low = bisect_left(active, True, key=lambda edge: _side(edge.left, edge.right, here) <= 0)
            high = low
            while high < len(active) and _side(active[high].left, active[high].right, here) == 0:
                high += 1
            passing = [edge for edge in active[low:high] if edge.right != here]
            meetings += len(passing)
            if meetings > MOST_MEETINGS:
                raise LimitError(f"curves touch one another more than {MOST_MEETINGS} times; split the drawing")
            leaving = self._sorted(here, passing + self.beginning[here])
            active[low:high] = leaving
            for k in range(low, low + len(leaving) + 1):
                if not self._agree(active[k - 1] if k else None, active[k] if k < len(active) else None):
                    return False
        return True

    def _sorted(self, here: Point, edges: list[_Edge]) -> list[_Edge]:
        """Sort edges that leave a place by their slopes, those along one another by how their rings must lie."""
        if len(edges) < 2:
            return edges

        def compare(e: _Edge, f: _Edge) -> int:
            side = _side(here, e.right, f.right)
            return (side < 0) - (side > 0) or (-1 if self._rank(e) < self._rank(f) else 1)

        return sorted(edges, key=cmp_to_key(compare))

    def _rank(self, edge: _Edge) -> tuple[bool, float, int]:
        """Rank edges along one another: what is below them, the inner ring first, then what is above, the outer."""
        area = self.areas[edge.ring]
        return (edge.is_lower, -area if edge.is_lower else area, edge.ring)

    def _agree(self, below: _Edge | None, above: _Edge | None) -> bool:
        """Whether neighbors do not cross, and lie in the same ring."""
        around = OUTSIDE
        if below is not None:
            around = below.ring if below.is_lower else self.parent[below.ring]
        if above is None:
            return around == OUTSIDE
        if above.is_lower and self.parent[above.ring] == _UNKNOWN:
            self.parent[above.ring] = around
            self.order.append(above.ring)
        if around != (self.parent[above.ring] if above.is_lower else above.ring):
            return False
        if below is None:
            return True
        if below.right < above.right:
            return _side(above.left, above.right, below.right) <= 0
        return _side(below.left, below.right, above.right) >= 0


def _side(a: Point, b: Point, c: Point) -> float:
    """Say on which side of the line from a to b c is: above 0 left, below 0 right, 0 on it; the sign is exact."""
    if c in (a, b):
        return 0.0
    (ax, ay), (bx, by), (cx, cy) = a, b, c
    if (ax == bx or ay == cy) and (ay == by or ax == cx):  # along an axis
        return 0.0
    rising, falling = (bx - ax) * (cy - ay), (by - ay) * (cx - ax)
    side = rising - falling
    size = abs(rising) + abs(falling)
    if abs(side) > _ROUNDING * size and 1e-280 < size < 1e300:  # far from where products end
        return side
    (ax, ay), (bx, by), (cx, cy) = (tuple(map(Fraction, place)) for place in (a, b, c))  # type: ignore[assignment]
    exact = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return float((exact > 0) - (exact < 0))
