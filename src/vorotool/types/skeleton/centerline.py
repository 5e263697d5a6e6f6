"""Centerlines of polygons: one path along the skeleton of each."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.plain import plain
from vorotool.types.skeleton.extended_lines import LedOn
from vorotool.types.values import counted, placed


@plain(eq=False, repr=False)
class Centerlines(LedOn):
    """Paths along a skeleton, at most one per polygon, with straight lines that extend them.

    Parameters
    ----------
    path : Skeleton
        The arcs of the paths, without the forks at their ends: one branch a path, from its start to its end. All that
        is told of widths is of these.
    ends : (k, 2, 2) float64 array
        The place on the boundary that the start and the end of each path are led on to; NaN where they are not.

    Raises
    ------
    InputError
        If `ends` has another shape.

    Examples
    --------
    >>> from vorotool import centerline, prune, skeleton_exact
    >>> lines = centerline(prune(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]), angle=100))
    >>> lines.ends.tolist(), lines.length.tolist(), lines.width_mean.tolist()
    ([[[0.0, 1.0], [4.0, 1.0]]], [4.0], [2.0])
    """

    maker = "centerline"

    has_branches = False

    def _summary(self) -> str:
        polygons = self.path.polygons
        text = f"{counted(len(self), 'line')} of {counted(len(polygons), 'polygon')}"
        return placed(text, polygons.crs, polygons.unit)


def without_centerline(lines: Centerlines) -> NDArray[np.int64]:
    """Polygons that have none; open lines are not counted."""
    polygons = lines.path.polygons
    has = np.zeros(len(polygons), dtype=bool)
    has[lines.polygon] = True
    return np.flatnonzero(~has & ~polygons.is_line)


def centerline_columns(lines: Centerlines) -> dict[str, Any]:
    """Length and mean width by polygon, as columns of the table of polygons."""
    columns = {}
    for name, values in (("centerline_length", lines.length), ("centerline_width_mean", lines.width_mean)):
        column, has_none = np.zeros(len(lines.path.polygons)), np.ones(len(lines.path.polygons), dtype=bool)
        column[lines.polygon], has_none[lines.polygon] = values, False
        columns[name] = np.ma.array(column, mask=has_none)
    return columns
