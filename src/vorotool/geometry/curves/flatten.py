"""Polylines instead of curves, for formats and pictures that have none."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.curves.inverse_functions import hypotenuse
from vorotool.geometry.numbers import checked_tolerance
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.ragged import owners, starts_of, within

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

FLATTEN = 2.0**-12
"""Of the larger side of the bounds, where nothing else is asked for."""

MOST_PIECES = 1 << 12
"""Of a curve: 2^24 times nearer than its chord."""


def default_flatten(polygons: PolygonSet) -> float:
    """1/4096 of the larger side of the bounds of polygons; 1 of nothing.

    Examples
    --------
    >>> default_flatten(PolygonSet([[0, 0], [4096, 0], [0, 3]], [0, 3], [0], [0]))
    1.0
    """
    xy = polygons.xy
    return FLATTEN * (float(np.ptp(xy, axis=0).max()) or 1.0) if len(xy) else 1.0


def checked_flatten(tolerance: float | None, polygons: PolygonSet) -> float:
    """A tolerance, or the default one.

    Raises
    ------
    UsageError
        If it is no finite number, or not positive.
    """
    return default_flatten(polygons) if tolerance is None else checked_tolerance(tolerance)


def polylines(
    source: Floats, control: Floats, target: Floats, is_curve: NDArray[np.bool_], tolerance: float | Floats
) -> tuple[Floats, Indices]:
    """Parabolas as polylines, divided evenly in their parameter, and straight lines as they are.

    Parameters
    ----------
    source, control, target : (k, 2) float64 array
        Control points of quadratic Bézier curves; the middle one of a straight line is not looked at.
    is_curve : (k,) bool array
        Whether each is no straight line.
    tolerance : float, or (k,) float64 array
        How far a polyline may be from its curve.

    Returns
    -------
    points : (n, 2) float64 array
        Places along each curve, its ends included.
    start : (k + 1,) int64 array
        Where the points of each curve begin.

    Examples
    --------
    >>> arch = np.array([[[0.0, 0.0]], [[1.0, 2.0]], [[2.0, 0.0]]])
    >>> polylines(*arch, np.array([True]), 0.25)[0].tolist()
    [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]
    """
    control = np.where(is_curve[:, None], control, (source + target) / 2)
    bend = source - 2 * control + target
    # a chord over 1/n of the parameter is off by |bend| / (4 n^2)
    pieces = np.ceil(np.sqrt(hypotenuse(*bend.T) / 4 / tolerance))
    pieces = np.where(is_curve, np.clip(pieces, 1, MOST_PIECES), 1).astype(np.int64)
    start, curve = starts_of(pieces + 1), owners(pieces + 1)
    t = (within(pieces + 1) / pieces[curve])[:, None]
    points = source[curve] + t * (2 * (control - source)[curve] + t * bend[curve])
    points[start[1:] - 1] = target
    return points, start


def chained(points: Floats, start: Indices, first: NDArray[np.integer]) -> tuple[Floats, Indices]:
    """Put polylines together that go on where the one before ends.

    Parameters
    ----------
    points, start
        As of `polylines`.
    first : (c,) integer array
        The first polyline of each chain.

    Returns
    -------
    points : (m, 2) float64 array
        Places along each chain, those where polylines meet once.
    start : (c + 1,) int64 array
        Where the points of each chain begin.

    Examples
    --------
    >>> points, start = chained(np.array([[0, 0], [1, 0], [1, 0], [1, 1]]), np.array([0, 2, 4]), np.array([0]))
    >>> points.tolist(), start.tolist()
    ([[0, 0], [1, 0], [1, 1]], [0, 3])
    """
    kept = np.ones(len(points), dtype=bool)
    kept[start[:-1]] = False
    kept[start[first]] = True
    return points[kept], starts_of(kept)[np.append(start[first], len(points))]
