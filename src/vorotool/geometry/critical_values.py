"""Critical values of a skeleton: the threshold above which pruning removes each place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

CRITERIA = ("angle", "chord", "scale", "length", "ratio")
"""By which skeletons are pruned: angles in degrees, chord and length in input units, the others without a unit."""


@dataclass(frozen=True, eq=False)
class CriticalValues:
    """The smallest thresholds that remove the places of a skeleton.

    Along an arc values do not decrease from either end to the place that has most.

    Parameters
    ----------
    criterion : {"angle", "chord", "scale", "length", "ratio"}
        What is compared with the threshold.
    ends : (a, 2) float64 array
        Close to the source and to the target of each arc; infinite on what is never removed.
    most : (a,) float64 array
        The largest on each arc.
    kept_arc : (k,) int32 array
        For each component that could be removed as a whole, the arc on which a place is kept nevertheless; increasing.
    kept_place : (k,) float64 array
        Where that is on the arc, from 0 at its source to 1 at its target, by the parameter of the Bezier curve.

    References
    ----------
    See :func:`vorotool.prune`.

    Examples
    --------
    >>> from vorotool import critical_values, skeleton_exact
    >>> values = critical_values(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]), "angle")
    >>> values.most.round(9).tolist()
    [90.0, 90.0, 90.0, 90.0, inf]
    """

    criterion: str
    ends: NDArray[np.float64]
    most: NDArray[np.float64]
    kept_arc: NDArray[np.int32]
    kept_place: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.most)
