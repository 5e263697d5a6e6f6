"""Measures of quadratic Bezier curves: the area beside them, and their length."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.curves.inverse_functions import inverse_sinh

Floats = NDArray[np.float64]


def areas_beside(source: Floats, control: Floats, target: Floats, centre: Floats) -> Floats:
    """(n,) signed areas between a place and curves: positive where they go counter-clockwise around it.

    Those of the curves of a closed ring add up to the area in it, wherever the place is.

    Parameters
    ----------
    source, control, target : (n, 2) float64 array
        Control points; the middle one is NaN of a straight line.
    centre : (2,) or (n, 2) float64 array
        The place, or one for each curve.

    Examples
    --------
    >>> source, target, centre = np.array([[0.0, 0.0]]), np.array([[2.0, 0.0]]), np.zeros(2)
    >>> areas_beside(source, np.array([[1.0, -3.0]]), target, centre).tolist()
    [2.0]
    """
    a, b = source - centre, target - centre
    triangle = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    u, v = control - source, target - source
    beside = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 3
    areas: Floats = triangle + np.where(np.isnan(beside), 0, beside)
    return areas


def lengths_of(source: Floats, control: Floats, target: Floats) -> Floats:
    """(n,) lengths of curves.

    With s the slope against the directrix at an end of a parabola, and w the root of 1 + s^2, the length is half the
    distance of focus and directrix times the difference of s w + asinh s. Differences are written as sums of positive
    numbers.

    Parameters
    ----------
    source, control, target : (n, 2) float64 array
        Control points; the middle one is NaN of a straight line.

    Examples
    --------
    >>> source, control, target = np.array([[0.0, 0.0]]), np.array([[0.5, 0.0]]), np.array([[1.0, 1.0]])
    >>> lengths_of(source, control, target).round(9).tolist()
    [1.478942858]
    """
    length = _norm(target - source)
    bent = np.flatnonzero(~np.isnan(control[:, 0]))
    first, second = control[bent] - source[bent], target[bent] - control[bent]
    bend = second - first
    size = _norm(bend)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        axis = bend / size[:, None]
        along = np.abs(first[:, 0] * axis[:, 1] - first[:, 1] * axis[:, 0])
        s0, s1 = ((way * axis).sum(axis=1) / along for way in (first, second))
        curved = along * along / size * _rise(s0, s1, size / along)
    folded = _norm(first) + _norm(second)
    length[bent] = np.where((size > 0) & (along > 0) & np.isfinite(curved), curved, folded)
    return length


def _rise(s0: Floats, s1: Floats, step: Floats) -> Floats:
    """The difference of s w + asinh s, w = sqrt(1 + s^2), from s0 to s1, a known step above it."""
    w0, w1 = np.sqrt(1 + s0 * s0), np.sqrt(1 + s1 * s1)
    same = s0 * s1
    products = (w0 + w1) / 2 + (s0 + s1) * (s0 + s1) / (2 * (w0 + w1))
    outer = np.where(same > 0, (1 + s0 * s0 + s1 * s1) / (w0 * w1 + same), w0 * w1 - same)
    rise: Floats = step * products + inverse_sinh(np.nan_to_num(step * (1 + outer) / (w0 + w1)))
    return rise


def _norm(way: Floats) -> Floats:
    x, y = way.T
    norm: Floats = np.sqrt(x * x + y * y)
    return norm
