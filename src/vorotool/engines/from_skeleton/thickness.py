"""Local thickness: the diameter of the largest inscribed disc that covers each pixel."""

from __future__ import annotations

from math import ldexp

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.skeleton.core_skeleton import core_skeleton
from vorotool.engines.skeleton.parts import with_arcs
from vorotool.errors import InputError
from vorotool.geometry.arguments.values import check_value
from vorotool.geometry.checks import checked_threads
from vorotool.geometry.progress import Progress
from vorotool.geometry.skeleton.skeleton import INTERIOR, Skeleton

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
    """Give for each pixel the diameter of the largest disc inside the polygons that covers its centre.

    The discs are those of all places of the skeleton, on its arcs as at its nodes. Along an arc, the places whose discs
    cover a pixel are known in closed form, and so is the largest of these discs: the value is exact but for rounding.
    A pixel whose centre is on the rim of a disc is covered; to decide that by rounded numbers, discs are taken for
    larger by `slack_of` the skeleton: a value is never too small, and that of a place so near at most.

    Parameters
    ----------
    skeleton : Skeleton
        Exact, neither pruned nor with a gap. What is outside polygons is left out.
    shape : (int, int)
        Height and width of the image.
    sides : (float, float)
        Height and width of a pixel. The centre of the first one is the origin; rows go up if the polygons are drawn so.
    threads : int
        0 uses all; the result is the same.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    (H, W) float64 array
        0 where no disc is, outside the polygons.

    Raises
    ------
    InputError
        If the skeleton has a gap.

    References
    ----------
    Hildebrand and Rüegsegger, "A new method for the model-independent assessment of thickness in three-dimensional
    images", Journal of Microscopy 185, 1997.

    Examples
    --------
    >>> from vorotool import outlines, skeleton_exact
    >>> thickness_of_pixels(skeleton_exact(outlines(np.ones((3, 5), dtype=bool))), (3, 5))[1].tolist()
    [3.0, 3.0, 3.0, 3.0, 3.0]
    """
    check_value(skeleton, "skeleton", Skeleton)
    if skeleton.gap:
        raise InputError("the skeleton has a gap, so that discs do not touch the outline: compute it without")
    inside = with_arcs(skeleton, skeleton.side == INTERIOR)
    (height, width), (down, across) = shape, map(float, sides)
    lowest = -(height - 1) * down if skeleton.y_up else 0.0
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
    return np.ascontiguousarray(made[::-1]) if skeleton.y_up else made


def slack_of(skeleton: Skeleton, shape: tuple[int, int], sides: tuple[float, float]) -> float:
    """How far beyond a disc a place may be that it is taken to cover: what rounding makes of a place on its rim.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> slack_of(skeleton_exact([[0, 0], [4, 0], [4, 2]]), (64, 64), (1, 1)) == 2.0**-40
    True
    """
    reach = max(shape[0] * sides[0], shape[1] * sides[1], np.abs(skeleton.vertices).max(initial=0.0))
    return ldexp(float(reach), -SLACK)
