"""Polygons of the rings of one shape, by its fill rule: how rings lie in one another, and how often they turn."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from fractions import Fraction
from functools import cmp_to_key
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.errors import LimitError
from vorotool.numeric.arrays import Floats, Indices
from vorotool.types.box import bounds

_MOST_PAIRS = 2**17
"""Of rings whose boxes meet, for which pairs are looked at one by one; beyond, a sweep finds how rings lie."""


def filled_polygons(rings: Sequence[Floats], rule: str) -> list[list[Floats]]:
    """Give shells, each with its holes, of what closed rings fill."""
    flat = [ring for ring in rings if len(ring) > 2]
    if len(rings) == 1 and (rule == "evenodd" or not flat):
        return [[rings[0]]]
    alone = [[ring] for ring in rings if len(ring) <= 2]  # places and segments fill nothing, and stay what they are
    if not flat:
        return alone
    low, high = bounds(np.concatenate(flat))
    middle = low / 2 + high / 2
    exponent = int(np.frexp((high / 2 - low / 2).max())[1])
    if not np.isfinite(middle).all():
        return [[ring] for ring in rings]
    scaled = [np.ldexp(ring - middle, -exponent) for ring in flat]
    shapes = np.array([shapely.Polygon(ring) for ring in scaled], dtype=object)
    nesting = _nesting(scaled, shapes)
    if nesting is not None:
        if len(flat) == 1:
            return [*alone, [flat[0]]]
        return alone + _nested(flat, shapes, nesting, rule)
    return alone + [[np.ldexp(ring, exponent) + middle for ring in polygon] for polygon in _of_faces(scaled, rule)]


def nested_polygons(rings: Sequence[Floats]) -> list[list[Floats]]:
    """Return shells, each with its holes, of rings of which none is filled by itself."""
    flat = [ring for ring in rings if len(ring) > 2]
    shapes = np.array([shapely.Polygon(ring) for ring in flat], dtype=object)
    if len(rings) < 2 or _nesting(flat, shapes) is None:
        return [[ring] for ring in rings]
    return filled_polygons(rings, "evenodd")


def _nesting(rings: Sequence[Floats], shapes: Any) -> Nesting | None:
    """How rings lie in one another; None if one is not simple, or two cross or are the same."""
    if not shapely.is_valid(shapes).all():
        return None
    if _meet_often(shapes):
        return nesting_of(rings, _turns(shapes).tolist(), shapely.area(shapes).tolist())
    return _nesting_of_pairs(shapes)


def _meet_often(shapes: Any) -> bool:
    """Whether more pairs of boxes meet than are looked at."""
    count = len(shapes)
    if count * count <= _MOST_PAIRS:
        return False
    tree = shapely.STRtree(shapes)
    met, step = 0, max(2**22 // count, 1)  # so many at once that their pairs take little memory
    for first in range(0, count, step):
        met += tree.query(shapes[first : first + step]).shape[1]
        if met > _MOST_PAIRS:
            return True
    return False


def _nesting_of_pairs(shapes: Any) -> Nesting | None:
    """Look at every ring that covers another, whose smallest is its parent; None where two cross or are the same."""
    tree = shapely.STRtree(shapes)
    if tree.query(shapes, predicate="overlaps").size:
        return None
    outer, inner = tree.query(shapes, predicate="covers")
    is_other = inner != outer
    inner, outer = inner[is_other], outer[is_other]
    pairs = set(zip(outer.tolist(), inner.tolist(), strict=True))
    if any((second, first) in pairs for first, second in pairs):
        return None
    parent = np.full(len(shapes), OUTSIDE)
    largest_first = np.argsort(-shapely.area(shapes)[outer], kind="stable")
    parent[inner[largest_first]] = outer[largest_first]
    order = np.argsort(np.bincount(inner, minlength=len(shapes)), kind="stable")
    return Nesting(parent.tolist(), order.tolist())


def _turns(shapes: Any) -> NDArray[np.int64]:
    """Give 1 for shapes that run counter-clockwise, else -1."""
    return np.where(shapely.is_ccw(shapely.get_exterior_ring(shapes)), 1, -1)


def _is_filled(winding: NDArray[Any], rule: str) -> NDArray[np.bool_]:
    return np.asarray(winding % 2 == 1 if rule == "evenodd" else winding != 0)


def _nested(rings: Sequence[Floats], shapes: Any, nesting: Nesting, rule: str) -> list[list[Floats]]:
    """By the rings around each: the smallest of those that are borders has it as a hole, if it is none itself."""
    turns, parent = _turns(shapes), nesting.parent
    inside = np.zeros(len(rings) + 1, dtype=np.int64)  # the winding; the last one is that outside of all
    for k in nesting.order:
        inside[k] = inside[parent[k]] + turns[k]
    within, beyond = _is_filled(inside[:-1], rule), _is_filled(inside[parent], rule)
    polygons: dict[int, list[Floats]] = {k: [rings[k]] for k in np.flatnonzero(within & ~beyond).tolist()}
    owner = [OUTSIDE] * (len(rings) + 1)  # the smallest shell around each
    for k in nesting.order:
        owner[k] = parent[k] if parent[k] in polygons else owner[parent[k]]
    for k in np.flatnonzero(~within & beyond).tolist():
        polygons[owner[k]].append(rings[k])
    return list(polygons.values())


def _of_faces(rings: Sequence[Floats], rule: str) -> list[list[Floats]]:
    """Cut rings where they cross, and join the faces that are filled."""
    lines = shapely.multilinestrings([shapely.LineString(np.concatenate([ring, ring[:1]])) for ring in rings])
    try:
        noded = shapely.node(lines)
    except shapely.errors.GEOSException:  # where rounding makes crossings anew
        noded = shapely.union_all(lines)
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(noded)))
    if not len(faces):
        return []
    winding = windings(rings, shapely.get_coordinates(shapely.point_on_surface(faces)))
    filled = faces[_is_filled(winding, rule)]
    try:
        whole = shapely.coverage_union_all(filled)  # faces meet in whole edges
    except shapely.errors.GEOSException:  # but where rounded crossings moved edges over one another
        whole = shapely.union_all(filled)
    polygons = []
    for polygon in shapely.get_parts(whole):
        if polygon.geom_type == "Polygon" and not polygon.is_empty:  # which rounding may make of thin ones
            parts = [polygon.exterior, *polygon.interiors]
            polygons.append([shapely.get_coordinates(part)[:-1] for part in parts])
    return polygons


Point = tuple[float, float]

OUTSIDE = -1
"""The parent of rings that lie in no other."""

MOST_MEETINGS = 2**21
"""Of edges with vertices of other edges."""


# ---- rings in one another ------------------------------------------------------------------------
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


# ---- how often rings turn around places ----------------------------------------------------------
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
