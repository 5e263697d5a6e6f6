"""Curves of drawings, and the polylines that stand for them.

Circles, ellipses and arcs are affine images of arcs of the unit circle: none is ever an approximation before it is
flattened, and square roots alone divide it.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from math import ceil, inf, isfinite, sqrt, ulp
from typing import NamedTuple

import numpy as np

from vorotool.numeric.arrays import Floats
from vorotool.numeric.curves.flatten import CURVE_PART, MOST_PIECES, chords_of
from vorotool.numeric.curves.inverse_functions import PI, cosine_and_sine, hypotenuse

Point = tuple[float, float]


class Affine(NamedTuple):
    """The map of (x, y) to (a x + c y + e, b x + d y + f), as SVG has it."""

    a: float = 1.0
    b: float = 0.0
    c: float = 0.0
    d: float = 1.0
    e: float = 0.0
    f: float = 0.0

    def of(self, point: Point) -> Point:
        """Map a place."""
        x, y = point
        return (self.a * x + self.c * y + self.e, self.b * x + self.d * y + self.f)

    def way(self, vector: Point) -> Point:
        """Map a difference of places."""
        x, y = vector
        return (self.a * x + self.c * y, self.b * x + self.d * y)

    def after(self, inner: Affine) -> Affine:
        """Map by another one first."""
        (a, b), (c, d), (e, f) = self.way(inner[:2]), self.way(inner[2:4]), self.of(inner[4:])
        return Affine(a, b, c, d, e, f)


class Line(NamedTuple):
    """A straight line to a place."""

    end: Point

    def mapped(self, by: Affine) -> Line:
        """Map it."""
        return Line(by.of(self.end))

    def reach(self) -> Iterable[Point]:
        """Places whose bounds hold it, with its start."""
        return (self.end,)

    def flattened(self, start: Point, tolerance: float) -> Floats:
        """Give places along it, without its start."""
        return np.array([self.end])


class Bezier(NamedTuple):
    """A Bézier curve of any degree: its control points but the first, the last of which is its end."""

    control: tuple[Point, ...]

    @property
    def end(self) -> Point:
        """Where it ends."""
        return self.control[-1]

    def mapped(self, by: Affine) -> Bezier:
        """Map it."""
        return Bezier(tuple(by.of(point) for point in self.control))

    def reach(self) -> Iterable[Point]:
        """Places whose bounds hold it, with its start."""
        return self.control

    def flattened(self, start: Point, tolerance: float) -> Floats:
        """Divide it evenly in its parameter, so that chords are within the tolerance."""
        control, degree = [start, *self.control], len(self.control)
        bend = 0.0
        for (a, b), (c, d), (e, f) in zip(control[:-2], control[1:-1], control[2:], strict=True):
            x, y = a - 2 * c + e, b - 2 * d + f
            bend = max(bend, x * x + y * y)
        most = sqrt(bend) * degree * (degree - 1)
        pieces = min(max(ceil(sqrt(min(most / (8 * tolerance), 1e18))), 1), MOST_PIECES)
        t = (np.arange(1, pieces + 1) / pieces)[:, None]
        level = [np.array(point) for point in control]
        while len(level) > 1:  # de Casteljau
            level = [p + t * (q - p) for p, q in itertools.pairwise(level)]
        points = level[0]
        points[-1] = self.end
        return points


class Arc(NamedTuple):
    """An arc of an ellipse: the image of an arc of the unit circle that turns from the first axis to the second."""

    center: Point  # (float, float): of the ellipse
    first: Point  # (float, float): images of the axes: conjugate half-diameters
    second: Point  # (float, float): images of the axes: conjugate half-diameters
    # tuple of (float, float): places on the unit circle, each at most half a turn behind the one before: its start,
    # its end, and between
    ways: tuple[Point, ...]
    end: Point  # (float, float): where it ends: given, since it is where the next piece begins

    def mapped(self, by: Affine) -> Arc:
        """Map it."""
        return Arc(by.of(self.center), by.way(self.first), by.way(self.second), self.ways, by.of(self.end))

    def reach(self) -> Iterable[Point]:
        """Places whose bounds hold it, with its start."""
        (x, y), (a, b), (c, d) = self.center, self.first, self.second
        across, down = abs(a) + abs(c), abs(b) + abs(d)
        return ((x - across, y - down), (x + across, y + down))

    def flattened(self, start: Point, tolerance: float) -> Floats:
        """Halve it until chords are within the tolerance."""
        axes = np.array([self.first, self.second])
        size = sqrt(float((axes * axes).sum()))  # at least the longer half-diameter
        if not size > 0 or not isfinite(size):
            return np.array([self.end])
        ways = np.array(self.ways)
        count = len(ways) - 1
        places, _ = chords_of(ways[:-1], ways[1:], np.zeros((count, 2)), np.ones(count, dtype=bool), tolerance / size)
        across, along = np.concatenate([places[1:], ways[-1:]]).T[:, :, None]
        points: Floats = across * axes[0] + along * axes[1] + self.center
        points[-1] = self.end
        return points


Piece = Line | Bezier | Arc


@dataclass
class Curve:
    """Pieces of which each begins where the one before ends."""

    start: Point  # (float, float): where the first begins
    pieces: list[Piece] = field(default_factory=list)
    is_closed: bool = False  # whether the last ends where the first begins, by a straight line if need be

    @property
    def end(self) -> Point:
        """Where it ends."""
        return self.pieces[-1].end if self.pieces else self.start

    def mapped(self, by: Affine) -> Curve:
        """Map all pieces."""
        return Curve(by.of(self.start), [piece.mapped(by) for piece in self.pieces], self.is_closed)

    def flattened(self, tolerance: float | None = None, most: float = inf) -> Floats:
        """(n, 2) places along it, both ends included, but the start once if it is closed; none twice in succession."""
        made, begin = [np.array([self.start])], self.start
        for piece in self.pieces:
            made.append(piece.flattened(begin, tolerance or _tolerance_of(begin, piece, most)))
            begin = piece.end
        points = np.concatenate(made)
        kept = np.append(True, (points[1:] != points[:-1]).any(axis=1))
        if self.is_closed and kept.sum() > 1 and (points[0] == points[-1]).all():
            kept[np.flatnonzero(kept)[-1]] = False
        return np.asarray(points[kept])

    def has_extent(self) -> bool:
        """Whether it is more than one place."""
        return any(place != self.start for piece in self.pieces for place in piece.reach())

    def is_finite(self) -> bool:
        """Whether all its places are."""
        return all(isfinite(x) and isfinite(y) for piece in self.pieces for x, y in piece.reach()) and all(
            map(isfinite, self.start)
        )


def _tolerance_of(begin: Point, piece: Piece, most: float) -> float:
    """Return how far lines may be from a piece; never less than 16 steps of the largest coordinate."""
    if isinstance(piece, Line):
        return inf
    x, y = zip(begin, *piece.reach(), strict=True)
    across, down = max(x) - min(x), max(y) - min(y)
    least = 16 * ulp(max(map(abs, (*x, *y))))
    return max(min(CURVE_PART * sqrt(across * across + down * down), most), least)


def extent_of(curves: Sequence[Curve]) -> float:
    """Return the larger side of what holds curves; 1 of nothing."""
    places = [place for curve in curves for piece in curve.pieces for place in piece.reach()]
    places += [curve.start for curve in curves]
    if not places:
        return 1.0
    across, down = zip(*places, strict=True)
    with np.errstate(over="ignore"):
        side = max(max(across) / 2 - min(across) / 2, max(down) / 2 - min(down) / 2)
    return min(2 * side, 1e300) or 1.0


# ---- arcs ----------------------------------------------------------------------------------------
_QUARTERS: tuple[Point, ...] = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, 0.0))


def turned(degrees: float) -> Point:
    """Give cosine and sine of an angle; those of quarters of a turn are exact."""
    return turned_each([degrees])[0]


def turned_each(degrees: Sequence[float]) -> list[Point]:
    """Give cosine and sine of each of many angles, as `turned` does."""
    if not all(map(isfinite, degrees)):
        raise ValueError("an angle is not finite")
    angles = np.asarray(degrees, dtype=np.float64) % 360
    quarters = np.rint(angles / 90)
    cosine, sine = cosine_and_sine((angles - 90 * quarters) * PI / 180)
    turn = quarters.astype(np.int64) % 4
    x = np.choose(turn, (cosine, -sine, -cosine, sine)) + 0.0  # no -0
    y = np.choose(turn, (sine, cosine, -sine, -cosine)) + 0.0
    return list(zip(x.tolist(), y.tolist(), strict=True))


def whole_ellipse(center: Point, first: Point, second: Point) -> Curve:
    """An ellipse by its center and two conjugate half-diameters; it begins at the end of the first."""
    start = (center[0] + first[0], center[1] + first[1])
    return Curve(start, [Arc(center, first, second, _QUARTERS, start)], is_closed=True)


def arc_between(center: Point, first: Point, second: Point, ways: tuple[Point, Point], end: Point) -> Arc:
    """Give the arc between two ways of the unit circle, counter-clockwise; the end is where it is said to be."""
    (ax, ay), (bx, by) = ways
    if ax * by - ay * bx >= 0:  # at most half a turn
        return Arc(center, first, second, ways, end)
    # the perpendicular to the chord leads to the middle; of a chord that is short the opposite of its middle does
    middle = (by - ay, ax - bx) if ax * bx + ay * by < 0 else (-ax - bx, -ay - by)
    length = float(hypotenuse(*middle))
    return Arc(center, first, second, (ways[0], (middle[0] / length, middle[1] / length), ways[1]), end)


def bulged(start: Point, end: Point, bulge: float) -> Piece:
    """Give the arc of a DXF polyline: its bulge is the tangent of a quarter of its angle, counter-clockwise."""
    if not bulge or start == end:
        return Line(end)
    across, down = (end[0] - start[0]) / 2, (end[1] - start[1]) / 2
    rise = (1 - bulge * bulge) / (2 * bulge)
    center = (start[0] + across - rise * down, start[1] + down + rise * across)
    radius = float(hypotenuse(start[0] - center[0], start[1] - center[1]))
    if not isfinite(radius) or not radius > 0:
        return Line(end)
    turn = 1.0 if bulge > 0 else -1.0  # clockwise arcs turn in a frame that is mirrored

    def way(place: Point) -> Point:
        return ((place[0] - center[0]) / radius, turn * (place[1] - center[1]) / radius)

    a, b = way(start), way(end)
    if abs(bulge) == 1:
        b = (-a[0], -a[1])
    return arc_between(center, (radius, 0.0), (0.0, turn * radius), (a, b), end)
