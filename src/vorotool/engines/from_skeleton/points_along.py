"""Places at equal steps along the branches of a skeleton."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.skeleton.core_skeleton import core_skeleton
from vorotool.errors import LimitError, UsageError
from vorotool.geometry.arguments.values import check_value
from vorotool.geometry.checks import checked_threads
from vorotool.geometry.numbers import finite_double
from vorotool.geometry.progress import Progress
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.geometry.skeleton.skeleton import Skeleton

MOST_POINTS = 1 << 27
"""Some 10 GB of arrays."""


def points_along(skeleton: Skeleton, *, every: float, threads: int = 0, progress: Progress = None) -> SkeletonPoints:
    """Give places along each branch: at its beginning, and on at equal steps of true arc length.

    Parameters
    ----------
    skeleton : Skeleton
        Pruned or not.
    every : float
        The step, in input units.
    threads : int
        Threads; 0 uses all. Results do not depend on it.
    progress : callable, optional
        Called with the fraction that is done; returning False stops with KeyboardInterrupt.

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
    threads = checked_threads(threads)
    start = np.flatnonzero(np.diff(skeleton.branch, prepend=-1))
    counts = _counts(skeleton, start, every)
    core = core_skeleton(skeleton, threads=threads)
    made = _core.skeleton.steps_along(core, start, counts, every, threads, progress)
    return SkeletonPoints(skeleton, **made)


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
