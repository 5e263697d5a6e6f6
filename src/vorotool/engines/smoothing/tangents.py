"""Tangents of lines: from places some tolerances before and behind, as lines along outlines of pixels are rough."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.smoothing.line_samples import LineSamples
from vorotool.numeric.arrays import Floats

Numbers = NDArray[np.int64]

WINDOW = 8.0
"""In tolerances: how far before and behind, but for half the way to the nearer end of the stretch."""

STEPS = np.arange(1, 9) / 8
"""Of the window: where places are looked at."""


def _one_sided() -> Floats:
    """Weights of least squares for the slope at 0 of a parabola through 0 there."""
    x = STEPS
    a, b, c = (x * x).sum(), (x * x * x).sum(), (x * x * x * x).sum()
    weights: Floats = (c * x - b * x * x) / (a * c - b * b)
    return weights


ONE_SIDED = _one_sided()


def inner_tangents(samples: LineSamples, first: Numbers, at: Numbers, last: Numbers, tolerance: float) -> Floats:
    """(2, k) unit tangents forwards, at places inside stretches: the slope of least squares."""
    along = samples.along
    half = np.minimum(WINDOW * tolerance, np.minimum(along[at] - along[first], along[last] - along[at]) / 2)
    way = np.zeros((2, len(at)))
    for step in STEPS.tolist():
        behind, before = (_place(samples, along[at] + sign * step * half, first, last) for sign in (1, -1))
        way += step * (behind - before)
    return _unit(way, samples.xy[:, at + 1] - samples.xy[:, at - 1], samples.xy[:, at + 1] - samples.xy[:, at])


def outer_tangents(samples: LineSamples, first: Numbers, last: Numbers, tolerance: float) -> tuple[Floats, Floats]:
    """(2, k) unit tangents into lines, at their starts and at their ends."""
    along, xy = samples.along, samples.xy
    size = np.minimum(WINDOW * tolerance, (along[last] - along[first]) / 2)
    made = []
    for end, sign, next_ in ((first, 1, first + 1), (last, -1, last - 1)):
        way = np.zeros((2, len(end)))
        for step, weight in zip(STEPS.tolist(), ONE_SIDED.tolist(), strict=True):
            way += weight * (_place(samples, along[end] + sign * step * size, first, last) - xy[:, end])
        made.append(_unit(way, xy[:, next_] - xy[:, end]))
    return made[0], made[1]


def closing_tangents(leaving: Floats, entering: Floats) -> Floats:
    """One tangent for the start and the end of closed lines."""
    return _unit(leaving - entering, leaving)


def _place(samples: LineSamples, along: Floats, first: Numbers, last: Numbers) -> Floats:
    """(2, k) places at lengths along lines."""
    piece = np.clip(np.searchsorted(samples.along, along, side="right") - 1, first, last - 1)
    begin, size = samples.along[piece], samples.along[piece + 1] - samples.along[piece]
    share = np.clip((along - begin) / size, 0.0, 1.0)
    a, b = samples.xy[:, piece], samples.xy[:, piece + 1]
    places: Floats = a + share * (b - a)
    return places


def _unit(way: Floats, *instead: Floats) -> Floats:
    """Ways with length 1; others where they have none."""
    for other in instead:
        way = np.where((way == 0).all(axis=0), other, way)
    unit: Floats = way / np.sqrt(way[0] * way[0] + way[1] * way[1])
    return unit
