"""Places at equal steps along the branches of a skeleton, or along centerlines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.from_skeleton.sections import sections_along
from vorotool.engines.skeleton.core_skeleton import core_skeleton
from vorotool.errors import LimitError, UsageError
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.numbers import finite_double
from vorotool.numeric.progress import Progress
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.led_on import LedOn
from vorotool.types.skeleton.points_along import SkeletonPoints
from vorotool.types.skeleton.skeleton import Skeleton

MOST_POINTS = 1 << 27
"""Some 10 GB of arrays."""


def points_along(
    skeleton: Skeleton | LedOn, *, every: float, threads: int = 0, progress: Progress = None
) -> SkeletonPoints:
    """Return points along each branch or centerline at equal steps of true arc length from its beginning.

    Parameters
    ----------
    skeleton : Skeleton, Centerlines or ExtendedSkeleton
        Pruned or not. Along the latter two the way goes on through junctions and along what leads on to the outline,
        and feet are where the straight line across meets the outline, or an island in it, first.
    every : float
        The step, in input units.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
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
    check_value(skeleton, "skeleton", "Skeleton", "Centerlines", "ExtendedSkeleton")
    every = finite_double(every, "the step")
    check_step(every)
    threads = checked_threads(threads)
    if isinstance(skeleton, LedOn):
        return sections_along(skeleton, _counts(skeleton.length, every), every)
    start = np.flatnonzero(np.diff(skeleton.branch, prepend=-1))
    counts = _counts(np.add.reduceat(skeleton.length, start) if len(start) else np.zeros(0), every)
    core = core_skeleton(skeleton, threads=threads)
    made = _core.skeleton.steps_along(core, start, counts, every, threads, progress)
    return SkeletonPoints(skeleton, **made)


def check_step(every: float) -> None:
    """Raise UsageError for what is no step."""
    if not 0 < every < np.inf:
        raise UsageError(f"the step is {every}: use a length above 0")


def _counts(length: NDArray[np.float64], every: float) -> NDArray[np.int64]:
    """Points on each line."""
    with np.errstate(over="ignore"):
        counts = np.floor(length / every) + 1
    if not counts.sum() <= MOST_POINTS:
        raise LimitError(
            f"steps of {every:g} along a length of {length.sum():.6g} give more than {MOST_POINTS} points: use longer "
            "steps"
        )
    return counts.astype(np.int64)
