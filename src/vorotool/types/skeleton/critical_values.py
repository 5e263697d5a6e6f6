"""Critical values of a skeleton: the threshold above which pruning removes each place."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.types.features import Rows
from vorotool.types.fields import index, numbers, record
from vorotool.types.values import Tabular, Value, counted

CRITERIA = ("angle", "chord", "scale", "length", "ratio")
"""By which skeletons are pruned: angles in degrees, chord and length in input units, the others without a unit."""


@record
class CriticalValues(Value, Tabular):
    """Smallest thresholds that remove each point of a skeleton.

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
    ends: NDArray[np.float64] = numbers(np.float64, "arcs", 2)
    most: NDArray[np.float64] = numbers(np.float64, "arcs")
    kept_arc: NDArray[np.int32] = index("components")
    kept_place: NDArray[np.float64] = numbers(np.float64, "components")

    def __len__(self) -> int:
        return len(self.most)

    def _rows(self, _what: str | None = None) -> Rows:
        source, target = np.ascontiguousarray(self.ends.T)
        return Rows({"arc": np.arange(len(self)), "at_source": source, "at_target": target, "most": self.most})

    def _summary(self) -> str:
        return f"{self.criterion} of {counted(len(self), 'arc')}"


@record
class ArcProfiles(Value):
    """How the two nearest places on the boundary lie along arcs: what cuts inside arcs are computed from."""

    # (a,) int8 array: `BETWEEN_LINES`, `BETWEEN_POINTS`, or `FROM_FOCUS`
    kind: NDArray[np.int8] = numbers(np.int8, "arcs")
    # (a, 2) float64 array: x at the source and at the target; 0 between lines
    ends: NDArray[np.float64] = numbers(np.float64, "arcs", 2)
    # (a,) float64 array: h; between lines the tangent of half the angle
    size: NDArray[np.float64] = numbers(np.float64, "arcs")

    def _summary(self) -> str:
        return counted(len(self.kind), "arc")


BETWEEN_LINES, BETWEEN_POINTS, FROM_FOCUS = 0, 1, 2
"""Kinds of profiles."""
