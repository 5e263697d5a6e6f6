"""Skeletons whose ends are led on straight to the boundary."""

from __future__ import annotations

from vorotool.plain import plain
from vorotool.types.skeleton.led_on import LedOn
from vorotool.types.values import counted, placed


@plain(eq=False, repr=False)
class ExtendedSkeleton(LedOn):
    """Skeleton with straight lines that extend its ends to the boundary; see `vorotool.extend_ends`.

    Parameters
    ----------
    path : Skeleton
        The skeleton, with arcs inside polygons alone. All that is told of widths is of these.
    ends : (b, 2, 2) float64 array
        The place on the boundary that the start and the end of each branch are led on to; NaN where they are not: at
        junctions, and at corners.

    Raises
    ------
    InputError
        If `ends` has another shape.

    Examples
    --------
    >>> from vorotool import extend_ends, prune, skeleton_exact
    >>> extended = extend_ends(prune(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]), scale=1.5))
    >>> extended.ends.tolist(), extended.length.tolist()
    ([[[0.0, 1.0], [4.0, 1.0]]], [4.0])
    """

    maker = "extend_ends"

    def _summary(self) -> str:
        polygons = self.path.polygons
        text = f"{counted(len(self), 'branch', 'branches')} of {counted(len(polygons), 'polygon')}"
        return placed(text, polygons.crs, polygons.unit)
