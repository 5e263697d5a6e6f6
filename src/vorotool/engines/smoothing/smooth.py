"""Smooth curves along skeletons and centerlines, within a tolerance that is checked."""

from __future__ import annotations

import numpy as np

from vorotool.engines.smoothing.cubic_fits import LineSamples, Stretches, fitted, sampled_lines
from vorotool.errors import InputError
from vorotool.numeric.arrays import Floats, Indices
from vorotool.numeric.numbers import checked_tolerance
from vorotool.numeric.parallel import Progress
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.extended_lines import LedOn
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.skeleton.smooth_lines import SmoothLines

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
        if progress is not None:
            progress(done / total)
        stretches = _parted(samples, stretches[~is_near], fits.farthest[~is_near], tolerance)
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


def _parted(samples: LineSamples, stretches: Stretches, at: Indices, tolerance: float) -> Stretches:
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
