"""Curves that are joined where their ends meet: into closed ones, and into longer open ones."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import isfinite
from typing import NamedTuple

import numpy as np

from vorotool.formats.drawing.curves import Arc, Bezier, Curve, Line, Piece, Point, extent_of
from vorotool.numeric.length_units import ratio
from vorotool.numeric.ragged import starts_of

JOINED = Fraction(5, 1000)
"""In mm: how far ends may be apart that are joined, if nothing else is asked for, as files round numbers."""

JOINED_PART = 1e-5
"""The same as a part of the extent, where the unit is not known."""

_NEAR = 10
"""Times as wide a gap is told of."""


class Gap(NamedTuple):
    """Between two ends that stay open."""

    width: float
    place: Point
    """Of one of them."""


def default_tolerance(curves: Sequence[Curve], unit: str | None) -> float:
    """Give how far ends of curves may be apart that are joined, by the unit of their coordinates."""
    length = None if unit is None else ratio(unit, "mm")
    return JOINED_PART * extent_of(curves) if length is None else float(JOINED / length)


def open_gaps(chains: Sequence[Curve], tolerance: float) -> list[Gap]:
    """Give the gaps between ends of open curves that are wider than a tolerance, by up to ten times, widest last."""
    import shapely

    ends = np.array([end for chain in chains if not chain.is_closed for end in (chain.start, chain.end)])
    if len(ends) < 2 or not tolerance > 0 or not isfinite(_NEAR * tolerance):
        return []
    places = ends[np.unique(_places(ends, tolerance), return_index=True)[1]]
    points = shapely.points(places)
    pairs, widths = shapely.STRtree(points).query_nearest(
        points, max_distance=_NEAR * tolerance, return_distance=True, exclusive=True, all_matches=False
    )
    found = {(min(a, b), max(a, b)): width for (a, b), width in zip(pairs.T.tolist(), widths.tolist(), strict=True)}
    gaps = [Gap(width, (float(places[a, 0]), float(places[a, 1]))) for (a, _), width in found.items()]
    return sorted(gap for gap in gaps if tolerance < gap.width)


def joined(curves: Sequence[Curve], tolerance: float) -> list[Curve]:
    """Join open curves at places where exactly two ends meet; closed ones stay."""
    is_open = [not curve.is_closed and bool(curve.pieces) for curve in curves]
    ends = np.array(
        [end for curve, each in zip(curves, is_open, strict=True) if each for end in (curve.start, curve.end)]
    )
    numbers = iter(_places(ends.reshape(-1, 2), tolerance))
    places = [(next(numbers), next(numbers)) if each else None for each in is_open]
    at: dict[int, list[int]] = {}
    for index, pair in enumerate(places):
        for place in pair or ():
            at.setdefault(place, []).append(index)
    used = [False] * len(curves)

    def walk(index: int, place: int) -> list[tuple[int, bool]]:
        """Go along a curve that begins at a place, and on while there is one way only."""
        path = []
        while not used[index]:
            used[index] = True
            a, b = places[index] or (-1, -1)
            path.append((index, a == place))
            place = b if a == place else a
            here = at[place]
            if len(here) != 2:
                break
            index = here[0] if here[1] == index else here[1]
        return path

    made: list[Curve] = []
    for index, pair in enumerate(places):
        if pair is None:
            made.append(curves[index])
        elif not used[index]:
            path = walk(index, pair[0])
            last, is_forward = path[-1]
            end = (places[last] or pair)[1 if is_forward else 0]
            behind = [other for other in at[pair[0]] if other != index]
            if end != pair[0] and len(at[pair[0]]) == 2 and behind and not used[behind[0]]:
                path = [(number, not way) for number, way in reversed(walk(behind[0], pair[0]))] + path
            made.append(_chain([curves[k] if way else _reversed(curves[k]) for k, way in path], end == pair[0]))
    return made


def _places(ends: np.ndarray, tolerance: float) -> list[int]:
    """Numbers of places: ends that are near each other have the same, and so have those near these."""
    import shapely

    parent = list(range(len(ends)))

    def root(k: int) -> int:
        while parent[k] != k:
            parent[k] = parent[parent[k]]
            k = parent[k]
        return k

    unique, number = np.unique(ends, axis=0, return_inverse=True) if len(ends) else (ends, np.zeros(0, dtype=int))
    first = starts_of(np.ones(len(unique), dtype=int))[:-1]
    parent = first.tolist()
    if tolerance > 0 and len(unique):
        points = shapely.points(unique)
        pairs = shapely.STRtree(points).query(points, predicate="dwithin", distance=tolerance)
        for a, b in pairs.T.tolist():
            ra, rb = root(a), root(b)
            if ra != rb:
                parent[max(ra, rb)] = min(ra, rb)
    return [root(k) for k in number.reshape(-1).tolist()]


def _chain(curves: Sequence[Curve], is_closed: bool) -> Curve:
    """Put curves one after the other: each begins where the one before ends."""
    pieces = [piece for curve in curves for piece in curve.pieces]
    start = curves[0].start
    if is_closed and pieces[-1].end != start:
        pieces[-1] = _ending(pieces[-1], start)
    return Curve(start, pieces, is_closed)


def _ending(piece: Piece, end: Point) -> Piece:
    return Bezier((*piece.control[:-1], end)) if isinstance(piece, Bezier) else piece._replace(end=end)


def _reversed(curve: Curve) -> Curve:
    """Give the same curve, from its end to its start."""
    pieces: list[Piece] = []
    starts = [curve.start, *(piece.end for piece in curve.pieces[:-1])]
    for start, piece in zip(reversed(starts), reversed(curve.pieces), strict=True):
        if isinstance(piece, Line):
            pieces.append(Line(start))
        elif isinstance(piece, Bezier):
            pieces.append(Bezier((*reversed(piece.control[:-1]), start)))
        else:
            mirrored = tuple((x, -y) for x, y in reversed(piece.ways))
            pieces.append(Arc(piece.center, piece.first, (-piece.second[0], -piece.second[1]), mirrored, start))
    return Curve(curve.end, pieces, curve.is_closed)
