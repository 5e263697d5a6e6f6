"""Places at equal steps along the branches of a skeleton."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.skeleton.site_distances import SitePlaces
from vorotool.errors import LimitError, UsageError
from vorotool.geometry.arguments.values import check_value
from vorotool.geometry.numbers import finite_double
from vorotool.geometry.ragged import owners, within
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.geometry.skeleton.skeleton import Skeleton

MOST_POINTS = 1 << 27
"""Some 10 GB of arrays."""


def points_along(skeleton: Skeleton, *, every: float) -> SkeletonPoints:
    """Give places along each branch: at its beginning, and on at equal steps of true arc length.

    Parameters
    ----------
    skeleton : Skeleton
        Pruned or not.
    every : float
        The step, in input units.

    Returns
    -------
    SkeletonPoints
        At 0, 1, 2, … steps from the beginning of each branch, as far as it reaches; with radii and feet.

    Raises
    ------
    UsageError
        If the step is not positive and finite.
    LimitError
        If there would be more than 2^27 points.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> points = points_along(skeleton_exact([[0, 0], [8, 0], [8, 2], [0, 2]]), every=2)
    >>> points.xy[points.radius == 1].tolist(), points.along[points.radius == 1].tolist()
    ([[1.0, 1.0], [3.0, 1.0], [5.0, 1.0], [7.0, 1.0]], [0.0, 2.0, 4.0, 6.0])
    """
    check_value(skeleton, "skeleton", Skeleton)
    every = finite_double(every, "the step")
    check_step(every)
    start = np.flatnonzero(np.diff(skeleton.branch, prepend=-1))
    arc, along, within = _steps(skeleton, start, _counts(skeleton, start, every), every)
    measures = skeleton.measures(arc)
    u = measures.parameter(within)
    xy = measures.place(u)
    sites = SitePlaces(skeleton)
    feet = [sites.feet(skeleton.sites[arc, hand], xy) for hand in (0, 1)]
    return SkeletonPoints(skeleton, arc, along, xy, measures.radius(u), np.stack(feet, axis=1))


def check_step(every: float) -> None:
    """Raise UsageError for what is no step."""
    if not 0 < every < np.inf:
        raise UsageError(f"the step is {every}: use a length above 0")


def _counts(skeleton: Skeleton, start: NDArray[np.int64], every: float) -> NDArray[np.int64]:
    """Points on each branch."""
    if not len(start):
        return np.zeros(0, dtype=np.int64)
    with np.errstate(over="ignore"):
        counts = np.floor(np.add.reduceat(skeleton.length, start) / every) + 1
    if not counts.sum() <= MOST_POINTS:
        raise LimitError(
            f"steps of {every:g} along {skeleton.length.sum():.6g} are more than {MOST_POINTS} points: use longer ones"
        )
    return counts.astype(np.int64)


def _steps(
    skeleton: Skeleton, start: NDArray[np.int64], counts: NDArray[np.int64], every: float
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """The arc of each point, its way from the beginning of the branch, and that from the beginning of the arc."""
    whole = np.concatenate([[0.0], np.cumsum(skeleton.length)])
    branch = owners(counts)
    along = np.multiply(every, within(counts), dtype=np.float64)
    first, last = start[branch], np.append(start[1:], len(skeleton))[branch] - 1
    reached = whole[first] + along
    arc = np.clip(np.searchsorted(whole, reached, side="right") - 1, first, last)
    return arc, along, np.clip(along - (whole[arc] - whole[first]), 0, skeleton.length[arc])
