"""Least squares: cubic Bézier curves with given tangents at their ends, fitted to places along lines.

The algorithm is that of P. J. Schneider, "An Algorithm for Automatically Fitting Digitized Curves", Graphics Gems,
1990, for all stretches of all lines at once: least squares for the lengths of both handles, then Newton's method for
the nearest parameters, some times over.

What it finds is checked by a bound. A polyline between neighboring places is compared with the part of the curve
between their parameters, piece by piece. All control points of a part, and so all of it, are within some distance of
the piece, as this is convex; its ends are near the ends of the piece, and it is connected: so, too, no place of the
piece is farther from it. The largest of these distances, with that of the polyline from the line, bounds the distance
of both.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, Indices, owners, ranges, starts_of, within
from vorotool.numeric.curves.flatten import chained, polylines
from vorotool.plain import plain
from vorotool.types.skeleton.extended_lines import LedOn
from vorotool.types.skeleton.skeleton import Skeleton

NEARNESS = 16
"""How many times nearer the polylines are than the tolerance."""

LEAST_PIECES = 8
"""Of each line with more than one, so that there are places enough to fit by."""


@plain(eq=False)
class LineSamples:
    """Places along lines, line by line, from the start to the end of each."""

    xy: Floats  # (2, n) float64 array: their coordinates. Neighbors differ; a line without a length has one place
    start: Indices  # (l + 1,) integer array: the first place of each line, and `n`
    along: Floats  # (n,) float64 array: lengths along the polylines, all lines after one another
    # (n,) float64 array: how far the line may be from the straight piece that begins at each place; 0 at the ends of
    # lines
    off: Floats
    # (l,) bool array: whether each line ends where it starts, and goes on there without a junction
    is_closed: NDArray[np.bool_]


def sampled_lines(lines: Skeleton | LedOn, tolerance: float) -> LineSamples:
    """Branches of a skeleton, or centerlines, as polylines with what leads on."""
    path = lines if isinstance(lines, Skeleton) else lines.path
    first, ends = path.branch_starts, path.branch_ends
    source, target = path.vertices[path.arcs[:, 0]], path.vertices[path.arcs[:, 1]]
    points, start = polylines(source, path.control, target, path.is_parabola, tolerance / NEARNESS)
    off = np.repeat(np.where(path.is_parabola, tolerance / NEARNESS, 0.0), np.diff(start))
    off[start[1:] - 1] = 0.0
    kept = np.ones(len(points), dtype=bool)
    kept[start[:-1]] = False
    kept[start[first]] = True
    # the last place of an arc gives way to the first one of the next, from which its pieces begin
    joints = np.setdiff1d(np.arange(len(path)), first, assume_unique=True)
    off[start[joints] - 1] = off[start[joints]]
    points, start = chained(points, start, first)
    off = off[kept]
    if isinstance(lines, LedOn):
        points, off, start = _led_on(lines, points, off, start)
    return _parted(points, off, start, (ends[0] == ends[1]) & (path.degree[ends[0]] == 2))


def _led_on(lines: LedOn, points: Floats, off: Floats, start: Indices) -> tuple[Floats, Floats, Indices]:
    """With the straight pieces at both ends of lines."""
    first, last = lines.extended
    line = np.concatenate([first, owners(np.diff(start)), last])
    order = np.argsort(line, kind="stable")
    off = np.concatenate([np.zeros(len(first)), off, np.zeros(len(last))])
    points = np.concatenate([lines.ends[first, 0], points, lines.ends[last, 1]])
    return points[order], off[order], np.searchsorted(line[order], np.arange(len(lines) + 1))


def _parted(points: Floats, off: Floats, start: Indices, is_closed: NDArray[np.bool_]) -> LineSamples:
    """Without places that are repeated, and with long pieces parted evenly."""
    line = owners(np.diff(start))
    kept = np.ones(len(line), dtype=bool)
    kept[:-1] = (points[1:] != points[:-1]).any(axis=1) | (line[1:] != line[:-1])
    points, off, line = points[kept], off[kept], line[kept]
    start = np.searchsorted(line, np.arange(len(is_closed) + 1))
    way = np.diff(points, axis=0, append=points[-1:])
    size = np.sqrt((way * way).sum(axis=1))
    size[start[1:] - 1] = 0.0
    whole = np.add.reduceat(size, start[:-1]) if len(is_closed) else size
    most = np.repeat(np.where(np.diff(start) > 2, whole / LEAST_PIECES, whole), np.diff(start))
    pieces = np.maximum(np.ceil(np.divide(size, most, out=np.ones_like(size), where=most > 0) - 2.0**-20), 1)
    pieces = pieces.astype(np.int64)
    share = (within(pieces) / np.repeat(pieces, pieces))[:, None]
    made = np.repeat(points, pieces, axis=0) + share * np.repeat(way, pieces, axis=0)
    size = np.repeat(size / pieces, pieces)
    x, y = made.T
    return LineSamples(
        np.stack([x, y]),
        starts_of(pieces)[start],
        np.concatenate([[0.0], np.cumsum(size[:-1])])[: len(size)],
        np.repeat(off, pieces),
        is_closed,
    )


ROUNDS = 4
"""Of least squares and Newton's method."""

FAR = 8.0
"""In tolerances: curves farther than this are not made near enough by more rounds."""

SINGULAR = 2.0**-30
"""Of the product of the diagonal: a smaller determinant tells nothing."""

HANDLE = 0.25
"""In tolerances: handles this short turn a curve within the tolerance wherever its tangents lead."""


@plain(eq=False)
class Stretches:
    """Parts of lines that are fitted by one curve each."""

    first: Indices  # (k,) int64 array: the places where they begin and end
    last: Indices  # (k,) int64 array: the places where they begin and end
    leaving: Floats  # (2, k) float64 array: unit tangents there: away from the first place, and away from the last
    entering: Floats  # (2, k) float64 array: unit tangents there: away from the first place, and away from the last

    def __getitem__(self, chosen: NDArray[np.generic]) -> Stretches:
        return Stretches(self.first[chosen], self.last[chosen], self.leaving[:, chosen], self.entering[:, chosen])


@plain(eq=False)
class Fits:
    """Curves, one a stretch."""

    control: Floats  # (4, 2, k) float64 array: control points
    error: Floats  # (k,) float64 array: bounds on their distances
    # (k,) int64 array: the place inside each stretch that is farthest from its parameter; -1 where none is inside
    farthest: Indices


def fitted(samples: LineSamples, stretches: Stretches, tolerance: float) -> Fits:
    """Fit a curve to each stretch."""
    count = len(stretches.first)
    made = Fits(np.empty((4, 2, count)), np.full(count, np.inf), np.full(count, -1))
    number, places = np.arange(count), _Places(samples, stretches)
    for _ in range(ROUNDS):
        if not len(number):
            break
        handles = _handles(places, tolerance)
        curve = _Curve(places, handles)
        curve.move_to_nearest(places)
        off = curve.distances(places)
        worst = np.maximum.reduceat(off, places.start)
        is_near = worst <= tolerance
        error = np.full(len(number), np.inf)
        error[is_near] = _bounds(places.taken(is_near), handles[:, is_near])
        made.error[number], made.control[:, :, number] = error, _control(places, handles)
        made.farthest[number] = _farthest(places, off)
        goes_on = (error > tolerance) & (worst <= FAR * tolerance) & (places.counts > 2)
        number, places = number[goes_on], places.taken(goes_on)
    _turn_at_once(made, samples, stretches, tolerance)
    return made


def _turn_at_once(made: Fits, samples: LineSamples, stretches: Stretches, tolerance: float) -> None:
    """Single pieces with tangents far from theirs: short handles."""
    number = np.flatnonzero((made.error > tolerance) & (stretches.last - stretches.first == 1))
    places = _Places(samples, stretches[number])
    handles = np.stack([np.minimum(places.length / 3, HANDLE * tolerance)] * 2)
    made.control[:, :, number] = _control(places, handles)
    made.error[number] = handles[0] + places.off[places.start]


class _Places:
    """Places of stretches, stretch by stretch, from the first place of each, with parameters and weights."""

    def __init__(self, samples: LineSamples, stretches: Stretches) -> None:
        self.stretches, self.counts = stretches, stretches.last - stretches.first + 1
        self.start, self.of = starts_of(self.counts)[:-1], owners(self.counts)
        self.number = ranges(stretches.first, self.counts)
        self.origin = samples.xy[:, stretches.first]
        self.end = samples.xy[:, stretches.last]
        self.xy = samples.xy[:, self.number] - self.origin[:, self.of]
        self.chord = self.end - self.origin
        self.off = samples.off[self.number]
        along = samples.along[self.number] - samples.along[stretches.first][self.of]
        self.length = along[self.start + self.counts - 1]
        self.t = along / self.length[self.of]
        size = np.diff(along, prepend=0.0, append=0.0)
        size[self.start] = 0.0
        self.weight = size[:-1] + np.append(size[1:-1], 0.0)

    def taken(self, chosen: NDArray[np.bool_]) -> _Places:
        """Some of the stretches, with their parameters."""
        if chosen.all():
            return self
        made = object.__new__(_Places)
        of_places = chosen[self.of]
        made.stretches, made.counts, made.length = self.stretches[chosen], self.counts[chosen], self.length[chosen]
        made.start, made.of = starts_of(made.counts)[:-1], owners(made.counts)
        made.origin, made.end, made.chord = self.origin[:, chosen], self.end[:, chosen], self.chord[:, chosen]
        made.xy, made.number = self.xy[:, of_places], self.number[of_places]
        made.off, made.t, made.weight = self.off[of_places], self.t[of_places], self.weight[of_places]
        return made

    @property
    def last(self) -> Indices:
        """The last place of each stretch."""
        return self.start + self.counts - 1


class _Curve:
    """The curves of stretches as polynomials, at the place of each parameter."""

    def __init__(self, places: _Places, handles: Floats) -> None:
        one = handles[0] * places.stretches.leaving
        two = places.chord + handles[1] * places.stretches.entering
        self.linear = (3 * one)[:, places.of]
        self.square = (3 * two - 6 * one)[:, places.of]
        self.cube = (places.chord + 3 * one - 3 * two)[:, places.of]

    def places(self, t: Floats) -> Floats:
        """(2, n) places."""
        return t * (self.linear + t * (self.square + t * self.cube))

    def ways(self, t: Floats) -> Floats:
        """(2, n) derivatives."""
        return self.linear + t * (2 * self.square + t * (3 * self.cube))

    def move_to_nearest(self, places: _Places) -> None:
        """One step of Newton's method; parameters stay in their order, and at the ends."""
        t = places.t
        off, way = self.places(t) - places.xy, self.ways(t)
        bend = 2 * self.square + t * (6 * self.cube)
        slope = _dot(way, way) + _dot(off, bend)
        step = np.divide(_dot(off, way), slope, out=np.zeros_like(t), where=slope > 0)
        moved = np.clip(t - step, 0.0, 1.0)
        moved[places.start], moved[places.last] = 0.0, 1.0
        if (np.diff(moved + places.of) < 0).any():
            moved = np.clip(np.maximum.accumulate(moved + places.of) - places.of, 0.0, 1.0)
            moved[places.start], moved[places.last] = 0.0, 1.0
        places.t = moved

    def distances(self, places: _Places) -> Floats:
        """(n,) from the place of each parameter."""
        off = self.places(places.t) - places.xy
        return np.asarray(np.sqrt(_dot(off, off)))


def _control(places: _Places, handles: Floats) -> Floats:
    """(4, 2, k) control points."""
    own = places.stretches
    one, two = places.origin + handles[0] * own.leaving, places.end + handles[1] * own.entering
    return np.stack([places.origin, one, two, places.end])


def _farthest(places: _Places, off: Floats) -> Indices:
    """The inner place that is farthest from its parameter, the first of several."""
    inner = off.copy()
    inner[places.start] = inner[places.last] = -1.0
    most = np.maximum.reduceat(inner, places.start)
    at = np.flatnonzero(inner == most[places.of])
    found = places.number[at[np.diff(places.of[at], prepend=-1) > 0]]
    return np.where(places.counts > 2, found, -1)


# ---- least squares --------------------------------------------------------------------------------
def _handles(places: _Places, tolerance: float) -> Floats:
    """(2, k) lengths of both handles, for the parameters as they are."""
    t, weight, own = places.t, places.weight, places.stretches
    u = 1 - t
    near, far = 3 * t * u * u, 3 * t * t * u
    rest = places.xy - (t * t * (3 * u + t)) * places.chord[:, places.of]
    sums = (
        weight * near * near,
        weight * near * far,
        weight * far * far,
        weight * near * _dot(rest, own.leaving[:, places.of]),
        weight * far * _dot(rest, own.entering[:, places.of]),
    )
    a, b, c, x, y = (np.add.reduceat(values, places.start) for values in sums)
    b = b * _dot(own.leaving, own.entering)
    least, most = np.minimum(places.length / 3, HANDLE * tolerance), places.length
    det = a * c - b * b
    is_known = det > SINGULAR * a * c
    third = places.length / 3
    one = np.divide(x * c - y * b, det, out=third.copy(), where=is_known)
    two = np.divide(y * a - x * b, det, out=third.copy(), where=is_known)
    bounded = np.clip(one, least, most), np.clip(two, least, most)
    one_for = np.divide(x - b * bounded[1], a, out=third.copy(), where=is_known)
    two_for = np.divide(y - b * bounded[0], c, out=third.copy(), where=is_known)
    is_out = one != bounded[0], two != bounded[1]
    return np.stack(
        [
            np.where(is_out[0], bounded[0], np.where(is_out[1], np.clip(one_for, least, most), one)),
            np.where(is_out[1], bounded[1], np.where(is_out[0], np.clip(two_for, least, most), two)),
        ]
    )


# ---- the bound ------------------------------------------------------------------------------------
def _bounds(places: _Places, handles: Floats) -> Floats:
    """(k,) bounds on the distances between curves and lines; see the text at the top."""
    if not len(places.counts):
        return np.zeros(0)
    curve, t = _Curve(places, handles), places.t
    at, way, xy = curve.places(t), curve.ways(t), places.xy
    begin = np.delete(np.arange(len(t)), places.last)
    third = (t[begin + 1] - t[begin]) / 3
    piece = xy[:, begin + 1] - xy[:, begin]
    one = at[:, begin] + third * way[:, begin] - xy[:, begin]
    two = at[:, begin + 1] - third * way[:, begin + 1] - xy[:, begin]
    off = curve.distances(places)
    most = np.maximum.reduce([off[begin], off[begin + 1], _from_piece(one, piece), _from_piece(two, piece)])
    starts = places.start - np.arange(len(places.start))
    return np.maximum.reduceat(most + places.off[begin], starts)


def _from_piece(to: Floats, piece: Floats) -> Floats:
    """Distances from straight pieces, of places as seen from the begin of each."""
    share = np.clip(_dot(to, piece) / _dot(piece, piece), 0.0, 1.0)
    off = to - share * piece
    return np.asarray(np.sqrt(_dot(off, off)))


def _dot(a: Floats, b: Floats) -> Floats:
    return a[0] * b[0] + a[1] * b[1]
