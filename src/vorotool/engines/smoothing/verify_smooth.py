"""A checker of smooth lines: places along both sides are looked for in a tree of the other's pieces."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.errors import VerificationError
from vorotool.numeric.arrays import Floats, crosses, dots, mask_of, owners
from vorotool.numeric.curves.flatten import chained, places_at
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.lines import LedOn, SmoothLines, ends_of_lines
from vorotool.types.skeleton.skeleton import Skeleton

Numbers = NDArray[np.integer]

FINENESS = 64
"""How many times finer than the largest error both are flattened: errors are checked to that."""

ROUNDING = 2.0**-44
"""Of the extent: what rounding may add."""

ON_PIECES, ON_CURVES = 4, 32
"""Places that are looked at on each straight piece of a flattened branch, and on each curve."""

BEND = 2.0**-20
"""Sine of the angle between tangents that may be rounding."""


def verify_smooth(smoothed: SmoothLines) -> None:
    """Check smooth lines against the lines they approximate.

    Lines begin and end where branches do, and their curves follow each other with one tangent; places along both are
    no farther from the other than the error says.

    Parameters
    ----------
    smoothed : SmoothLines
        Result of `vorotool.smooth`.

    Raises
    ------
    VerificationError
        If a check fails; the message names the line.

    Examples
    --------
    >>> from vorotool import skeleton_exact, smooth
    >>> verify_smooth(smooth(skeleton_exact([[0, 0], [6, 0], [6, 2], [0, 2]]), 0.1))
    """
    check_value(smoothed, "smoothed", "SmoothLines")
    lines, path = smoothed.lines, smoothed.path
    first = path.branch_starts
    if len(first) != len(smoothed):
        raise VerificationError(f"there are {len(smoothed)} smooth lines, but {len(first)} branches")
    if not len(first):
        return
    size = float(np.ptp(path.polygons.xy, axis=0).max(initial=0.0)) or 1.0
    _check_ends(smoothed)
    _check_tangents(smoothed, size)
    error = smoothed.error + ROUNDING * size
    fineness = float(error.max()) / FINENESS
    points, start = _flattened(path, lines, fineness)
    curves, curve_starts = smoothed.flattened(fineness)
    _check_near(points, start, curves, curve_starts, error + fineness, "its curves")
    t = np.tile(np.arange(ON_CURVES + 1) / ON_CURVES, len(smoothed.control))
    on_curves = places_at(np.repeat(smoothed.control, ON_CURVES + 1, axis=0), t)
    _check_places(on_curves, np.repeat(smoothed.line, ON_CURVES + 1), points, start, error + fineness, "its branch")


def _flattened(path: Skeleton, lines: Skeleton | LedOn, fineness: float) -> tuple[Floats, NDArray[np.int64]]:
    if isinstance(lines, LedOn):
        return lines.flattened(fineness)
    return chained(*path.flattened(fineness), path.branch_starts)


def _check_ends(smoothed: SmoothLines) -> None:
    wanted = ends_of_lines(smoothed.lines)
    found = np.stack([smoothed.control[smoothed.start[:-1], 0], smoothed.control[smoothed.start[1:] - 1, 3]], axis=1)
    wrong = np.flatnonzero((wanted != found).any(axis=(1, 2)))
    if len(wrong):
        raise VerificationError(f"smooth line {wrong[0]} does not begin and end where its branch does")


def _check_tangents(smoothed: SmoothLines, size: float) -> None:
    control = smoothed.control
    joint = np.delete(np.arange(len(control)), smoothed.start[:-1])
    before, behind = control[joint - 1], control[joint]
    if (before[:, 3] != behind[:, 0]).any():
        raise VerificationError("the curves of a smooth line are not connected")
    u, v = before[:, 3] - before[:, 2], behind[:, 1] - behind[:, 0]
    lengths = np.sqrt(dots(u, u) * dots(v, v))
    shortest = np.sqrt(np.minimum(dots(u, u), dots(v, v)))
    bend = np.abs(crosses(u, v))
    allowed = lengths * (BEND + np.divide(ROUNDING * size, shortest, out=np.ones(len(u)), where=shortest > 0))
    wrong = np.flatnonzero((bend > allowed) | (dots(u, v) <= 0))
    if len(wrong):
        raise VerificationError(f"smooth line {smoothed.line[joint[wrong[0]]]} has a corner inside")


def _check_near(
    points: Floats, start: Numbers, others: Floats, other_start: Numbers, distance: Floats, what: str
) -> None:
    """Places along polylines are near to other polylines, line by line."""
    begin = np.delete(np.arange(len(points)), start[1:] - 1)
    share = (np.arange(ON_PIECES) / ON_PIECES)[:, None, None]
    places = points[begin] + share * (points[begin + 1] - points[begin])
    line = np.tile(owners(np.diff(start))[begin], ON_PIECES)
    _check_places(places.reshape(-1, 2), line, others, other_start, distance, what)


def _check_places(
    places: Floats, line: Numbers, others: Floats, other_start: Numbers, distance: Floats, what: str
) -> None:
    """Places are near to the polylines of their lines."""
    begin = np.delete(np.arange(len(others)), other_start[1:] - 1)
    tree = shapely.STRtree(shapely.linestrings(np.stack([others[begin], others[begin + 1]], axis=1)))
    place, piece = tree.query(shapely.points(places), predicate="dwithin", distance=distance[line])
    own = owners(np.diff(other_start))[begin]
    is_near = mask_of(place[own[piece] == line[place]], len(places))
    wrong = np.flatnonzero(~is_near)
    if len(wrong):
        x, y = places[wrong[0]].tolist()
        raise VerificationError(f"({x:g}, {y:g}) of line {line[wrong[0]]} is farther from {what} than its error states")
