"""Smooth curves along skeletons and centerlines, within a tolerance that is checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices, norms, owners, ranges, starts_of, within
from vorotool.numeric.curves.flatten import chained, polylines
from vorotool.numeric.numbers import checked_tolerance
from vorotool.numeric.parallel import Progress, report
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.lines import LedOn, SmoothLines
from vorotool.types.skeleton.skeleton import Skeleton

NEARNESS = 16
"""How many times nearer the polylines are than the tolerance."""

LEAST_PIECES = 8
"""Of each line with more than one, so that there are places enough to fit by."""


@frozen(eq=False)
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
    size = norms(way)
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


@frozen(eq=False)
class Stretches:
    """Parts of lines that are fitted by one curve each."""

    first: Indices  # (k,) int64 array: the places where they begin and end
    last: Indices  # (k,) int64 array: the places where they begin and end
    leaving: Floats  # (2, k) float64 array: unit tangents there: away from the first place, and away from the last
    entering: Floats  # (2, k) float64 array: unit tangents there: away from the first place, and away from the last

    def __getitem__(self, chosen: NDArray[np.generic]) -> Stretches:
        return Stretches(self.first[chosen], self.last[chosen], self.leaving[:, chosen], self.entering[:, chosen])


@frozen(eq=False)
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


FINEST = 2.0**-20
"""Of the larger side of the bounds: the least tolerance."""


def smooth(lines: Skeleton | LedOn, tolerance: float, *, progress: Progress = None) -> SmoothLines:
    """Fit cubic Bézier curves to the branches of a skeleton, or to centerlines.

    Each branch is a chain of curves with one tangent where they meet. Junctions and ends stay where they are. Curves
    are fitted by least squares; one that is not near enough is parted where it is farthest from the branch, until no
    place of the curves is farther from the branch than the tolerance, and no place of the branch farther from them. The
    bound on these distances that was found is a part of the result.

    Parameters
    ----------
    lines : Skeleton, Centerlines or ExtendedSkeleton
        Which; with what leads on to ends.
    tolerance : float
        In input units. At least 2^-20 of the larger side of the bounds.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    SmoothLines
        A line for each branch, in the order of the branches.

    Raises
    ------
    InputError
        If the tolerance is too small.
    UsageError
        If the tolerance is not a positive number.

    References
    ----------
    P. J. Schneider, "An Algorithm for Automatically Fitting Digitized Curves", Graphics Gems, 1990.

    Examples
    --------
    >>> import vorotool
    >>> skeleton = vorotool.skeleton_exact([[0, 0], [40, 0], [40, 30], [30, 30], [30, 10], [0, 10]])
    >>> line = vorotool.smooth(vorotool.centerline(skeleton), 0.5)
    >>> len(line.control), bool(line.error[0] <= 0.5)
    (2, True)
    """
    check_value(lines, "lines", "Skeleton", "Centerlines", "ExtendedSkeleton")
    tolerance = checked_tolerance(tolerance)
    path = lines if isinstance(lines, Skeleton) else lines.path
    size = float(np.ptp(path.vertices, axis=0).max()) if len(path.vertices) else 0.0
    if tolerance < FINEST * size:
        raise InputError(
            f"the tolerance is {tolerance:g}: fitted curves need at least {FINEST * size:.2g} for lines of this extent"
        )
    samples = sampled_lines(lines, tolerance)
    first, control, error = _fitted_lines(samples, tolerance, progress)
    line = np.searchsorted(samples.start, first, side="right") - 1
    start = np.searchsorted(line, np.arange(len(samples.start)))
    return SmoothLines(lines, control, start, np.maximum.reduceat(error, start[:-1]) if len(error) else error)


def _fitted_lines(samples: LineSamples, tolerance: float, progress: Progress) -> tuple[Indices, Floats, Floats]:
    """Where curves begin, their control points, and bounds on their distances, in the order of lines."""
    found = [_single_places(samples)]
    stretches = _whole_lines(samples, tolerance)
    done, total = 0, max(int((stretches.last - stretches.first).sum()), 1)
    while len(stretches.first):
        fits = fitted(samples, stretches, tolerance)
        is_near = fits.error <= tolerance
        found.append((stretches.first[is_near], fits.control[:, :, is_near].transpose(2, 0, 1), fits.error[is_near]))
        done += int((stretches.last - stretches.first)[is_near].sum())
        report(progress, done / total)
        stretches = _divided(samples, stretches[~is_near], fits.farthest[~is_near], tolerance)
    first, control, error = (np.concatenate(parts) for parts in zip(*found, strict=True))
    order = np.argsort(first, kind="stable")
    return first[order], control[order], error[order]


def _single_places(samples: LineSamples) -> tuple[Indices, Floats, Floats]:
    """Curves without a length, of lines without one."""
    start = samples.start
    first = start[:-1][np.diff(start) == 1]
    return first, np.repeat(samples.xy[:, first].T[:, None], 4, axis=1), np.zeros(len(first))


def _whole_lines(samples: LineSamples, tolerance: float) -> Stretches:
    lines = np.flatnonzero(np.diff(samples.start) > 1)
    first, last = samples.start[lines], samples.start[lines + 1] - 1
    leaving, entering = outer_tangents(samples, first, last, tolerance)
    closed = samples.is_closed[lines]
    leaving[:, closed] = closing_tangents(leaving[:, closed], entering[:, closed])
    entering[:, closed] = -leaving[:, closed]
    return Stretches(first, last, leaving, entering)


def _divided(samples: LineSamples, stretches: Stretches, at: Indices, tolerance: float) -> Stretches:
    """Both parts of each stretch, with one tangent at the place between."""
    way = inner_tangents(samples, stretches.first, at, stretches.last, tolerance)
    return Stretches(
        np.concatenate([stretches.first, at]),
        np.concatenate([at, stretches.last]),
        np.concatenate([stretches.leaving, way], axis=1),
        np.concatenate([-way, stretches.entering], axis=1),
    )


WINDOW = 8.0
"""In tolerances: how far before and behind, but for half the way to the nearer end of the stretch."""

STEPS = np.arange(1, 9) / 8
"""Of the window: where places are looked at."""


def _one_sided() -> Floats:
    """Weights of least squares for the slope at 0 of a parabola through 0 there."""
    x = STEPS
    a, b, c = (x * x).sum(), (x * x * x).sum(), (x * x * x * x).sum()
    return (c * x - b * x * x) / (a * c - b * b)


ONE_SIDED = _one_sided()


def inner_tangents(samples: LineSamples, first: Indices, at: Indices, last: Indices, tolerance: float) -> Floats:
    """(2, k) unit tangents forwards, at places inside stretches: the slope of least squares."""
    along = samples.along
    half = np.minimum(WINDOW * tolerance, np.minimum(along[at] - along[first], along[last] - along[at]) / 2)
    way = np.zeros((2, len(at)))
    for step in STEPS.tolist():
        behind, before = (_place(samples, along[at] + sign * step * half, first, last) for sign in (1, -1))
        way += step * (behind - before)
    return _unit(way, samples.xy[:, at + 1] - samples.xy[:, at - 1], samples.xy[:, at + 1] - samples.xy[:, at])


def outer_tangents(samples: LineSamples, first: Indices, last: Indices, tolerance: float) -> tuple[Floats, Floats]:
    """(2, k) unit tangents into lines, at their starts and at their ends."""
    along, xy = samples.along, samples.xy
    size = np.minimum(WINDOW * tolerance, (along[last] - along[first]) / 2)
    made = []
    for end, sign, next_ in ((first, 1, first + 1), (last, -1, last - 1)):
        way = np.zeros((2, len(end)))
        for step, weight in zip(STEPS.tolist(), ONE_SIDED.tolist(), strict=True):
            way += weight * (_place(samples, along[end] + sign * step * size, first, last) - xy[:, end])
        made.append(_unit(way, xy[:, next_] - xy[:, end]))
    return made[0], made[1]


def closing_tangents(leaving: Floats, entering: Floats) -> Floats:
    """One tangent for the start and the end of closed lines."""
    return _unit(leaving - entering, leaving)


def _place(samples: LineSamples, along: Floats, first: Indices, last: Indices) -> Floats:
    """(2, k) places at lengths along lines."""
    piece = np.clip(np.searchsorted(samples.along, along, side="right") - 1, first, last - 1)
    begin, size = samples.along[piece], samples.along[piece + 1] - samples.along[piece]
    share = np.clip((along - begin) / size, 0.0, 1.0)
    a, b = samples.xy[:, piece], samples.xy[:, piece + 1]
    return a + share * (b - a)


def _unit(way: Floats, *instead: Floats) -> Floats:
    """Ways with length 1; others where they have none."""
    for other in instead:
        way = np.where((way == 0).all(axis=0), other, way)
    return way / np.sqrt(way[0] * way[0] + way[1] * way[1])
