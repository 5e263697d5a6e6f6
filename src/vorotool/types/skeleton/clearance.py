"""How the clearance goes along the arcs of a skeleton: where it grows, where it is least, where it stays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.plain import plain


@plain(eq=False)
class ClearanceCourse:
    """Signs that decide where the clearance has its extremes; along an arc it is convex, or the same everywhere."""

    # (a, 2) int8 array: how the clearance begins to change where the source, and where the target, is left along the
    # arc: 1 it grows, -1 it shrinks, 0 it is the same on the whole arc. An arc has (1, -1) where it grows from its
    # source to its target, (-1, 1) where it shrinks, (-1, -1) where it is least inside, (0, 0) between parallel edges
    slope: NDArray[np.int8]
    # (a,) float64 array: where it is least on an arc with (-1, -1), from 0 at its source to 1 at its target, by the
    # parameter of the Bezier curve; NaN on others
    least: NDArray[np.float64]
