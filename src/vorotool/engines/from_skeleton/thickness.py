"""Local thickness: the diameter of the largest inscribed disc that covers each pixel."""

from __future__ import annotations

from math import ldexp

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.skeleton.parts import core_skeleton, with_arcs
from vorotool.errors import InputError
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.parallel import Progress
from vorotool.types.arguments import check_value
from vorotool.types.fields import is_up
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

SLACK = 46
"""A disc covers what is at most 2^-46 of the largest coordinate beyond it: 64 units in the last place of that."""


def thickness_of_pixels(
    skeleton: Skeleton,
    shape: tuple[int, int],
    *,
    sides: tuple[float, float] = (1.0, 1.0),
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[np.float64]:
    """Give for each pixel the diameter of the largest disc inside the polygons that covers its center."""
    check_value(skeleton, "skeleton", "Skeleton")
    if skeleton.gap:
        raise InputError("the skeleton has a gap, so its discs do not touch the outline: compute it without a gap")
    inside = with_arcs(skeleton, skeleton.side == INTERIOR)
    (height, width), (down, across) = shape, map(float, sides)
    lowest = -(height - 1) * down if is_up(skeleton) else 0.0
    made = _core.thickness.local_thickness(
        core_skeleton(inside, threads=threads),
        (0.0, lowest),
        (across, down),
        height,
        width,
        slack_of(inside, shape, sides),
        checked_threads(threads),
        progress,
    )
    return np.ascontiguousarray(made[::-1]) if is_up(skeleton) else made


def slack_of(skeleton: Skeleton, shape: tuple[int, int], sides: tuple[float, float]) -> float:
    """How far beyond a disc a place may be that it is taken to cover: what rounding makes of a place on its rim."""
    reach = max(shape[0] * sides[0], shape[1] * sides[1], np.abs(skeleton.vertices).max(initial=0.0))
    return ldexp(float(reach), -SLACK)
