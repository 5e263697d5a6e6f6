"""Measures of quadratic Bezier curves: the area beside them, and their length."""

from __future__ import annotations

import numpy as np

from vorotool.numeric.arrays import Floats
from vorotool.numeric.curves.inverse_functions import inverse_sinh


def areas_beside(source: Floats, control: Floats, target: Floats, center: Floats) -> Floats:
    """(n,) signed areas between a place and curves: positive where they go counter-clockwise around it."""
    a, b = source - center, target - center
    triangle = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    u, v = control - source, target - source
    beside = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 3
    areas: Floats = triangle + np.where(np.isnan(beside), 0, beside)
    return areas


def lengths_of(source: Floats, control: Floats, target: Floats) -> Floats:
    """(n,) lengths of curves."""
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
