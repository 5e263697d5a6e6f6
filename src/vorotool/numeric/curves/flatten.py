"""Curves as polylines, for formats and pictures that have no curves: circular arcs, Bézier curves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, Indices, dots, norms, owners, starts_of, within
from vorotool.numeric.coordinates import finest_deviation, record_deviation
from vorotool.numeric.curves.inverse_functions import hypotenuse

CURVE_PART = 1 / 2000
"""How far lines may be from a curve: of the radius of a circular arc, of the extent of another curve."""

CLEARANCE_PART = 1 / 100
"""The same of the least distance of a curve from sites, where that is more."""

MOST_PIECES = 1 << 12
"""Of a curve: 2^24 times nearer than its chord."""


def circle_tolerances(center: Floats, radius: Floats, tolerance: float | None) -> float | Floats:
    """(k,) how far lines may be from circular arcs: 1/2000 of the radius, where no tolerance is given."""
    if tolerance is not None:
        return tolerance
    far = np.abs(center).max(axis=1, initial=0) + radius
    return np.maximum(CURVE_PART * radius, finest_deviation(far[:, None]))


def curve_tolerances(control: Floats, clearance: Floats | float, tolerance: float | None) -> float | Floats:
    """(k,) how far lines may be from curves, where no tolerance is given."""
    if tolerance is not None:
        return tolerance
    extent = hypotenuse(*(control[:, -1] - control[:, 0]).T)
    own = np.maximum(CURVE_PART * extent, CLEARANCE_PART * np.asarray(clearance))
    return np.maximum(own, finest_deviation(control))


def least_focal_distances(source: Floats, control: Floats, target: Floats) -> Floats:
    """(k,) the least distance of parabolas from their foci, as their Bézier curves have it; infinity of lines."""
    least = np.full(len(source), np.inf)
    first, second = control - source, target - control
    bend = second - first
    size = norms(bend)
    bent = np.flatnonzero(size > 0)
    axis = bend[bent] / size[bent][:, None]
    half = np.abs(first[bent, 0] * axis[:, 1] - first[bent, 1] * axis[:, 0])
    height = 2 * half * half / size[bent]
    slopes = [dots(way[bent], axis) / np.where(half > 0, half, 1) for way in (first, second)]
    nearest = np.where(slopes[0] * slopes[1] < 0, 0, np.minimum(np.abs(slopes[0]), np.abs(slopes[1])))
    least[bent] = np.where(half > 0, height * (1 + nearest * nearest) / 2, np.inf)
    return least


def polylines(
    source: Floats, control: Floats, target: Floats, is_curve: NDArray[np.bool_], tolerance: float | Floats
) -> tuple[Floats, Indices]:
    """Parabolas as polylines, divided evenly in their parameter, and straight lines as they are."""
    control = np.where(is_curve[:, None], control, (source + target) / 2)
    bend = source - 2 * control + target
    # a chord over 1/n of the parameter is off by |bend| / (4 n^2)
    pieces = np.ceil(np.sqrt(hypotenuse(*bend.T) / 4 / tolerance))
    pieces = np.where(is_curve, np.clip(pieces, 1, MOST_PIECES), 1).astype(np.int64)
    record_deviation(hypotenuse(*bend.T) / 4 / (pieces * pieces))
    start, curve = starts_of(pieces + 1), owners(pieces + 1)
    t = (within(pieces + 1) / pieces[curve])[:, None]
    points = source[curve] + t * (2 * (control - source)[curve] + t * bend[curve])
    points[start[1:] - 1] = target
    return points, start


def chained(points: Floats, start: Indices, first: NDArray[np.integer]) -> tuple[Floats, Indices]:
    """Put polylines together that go on where the one before ends."""
    kept = np.ones(len(points), dtype=bool)
    kept[start[:-1]] = False
    kept[start[first]] = True
    return points[kept], starts_of(kept)[np.append(start[first], len(points))]


def places_at(control: Floats, t: Floats) -> Floats:
    """(n, 2) places on curves, each at its parameter."""
    a, b, c, d = np.moveaxis(control, 1, 0)
    t = t[:, None]
    u = 1 - t
    return u * u * u * a + 3 * t * u * (u * b + t * c) + t * t * t * d


def cubic_polylines(control: Floats, tolerance: float | Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Curves as polylines, divided evenly in their parameter."""
    second = control[:, 2:] - 2 * control[:, 1:-1] + control[:, :-2]
    bend = norms(second).max(axis=1, initial=0.0)
    pieces = np.clip(np.ceil(np.sqrt(0.75 * bend / tolerance)), 1, MOST_PIECES).astype(np.int64)
    record_deviation(0.75 * bend / (pieces * pieces))
    curve = owners(pieces + 1)
    points = places_at(control[curve], within(pieces + 1) / pieces[curve])
    start = starts_of(pieces + 1)
    points[start[:-1]], points[start[1:] - 1] = control[:, 0], control[:, 3]
    return points, start


MOST_HALVINGS = 12
"""Of an arc: 4^12 times nearer than its chord."""


def chords_of(
    start: Floats, end: Floats, center: Floats, is_left: NDArray[np.bool_], tolerance: float | Floats
) -> tuple[Floats, NDArray[np.int64]]:
    """Replace arcs by chords between places on them, each at most a quarter of a circle."""
    halvings = _halvings(start, end, center, tolerance)
    first = starts_of(2**halvings)
    points = np.empty((first[-1], 2))
    points[first[:-1]] = start
    for count in range(1, int(halvings.max(initial=0)) + 1):
        arcs = np.flatnonzero(halvings == count)
        inner = _halved(start[arcs], end[arcs], center[arcs], is_left[arcs], count)
        points[(first[arcs, None] + np.arange(1, 2**count)).reshape(-1)] = inner.reshape(-1, 2)
    return points, first


def middles_of(start: Floats, end: Floats, center: Floats, is_long: NDArray[np.bool_]) -> Floats:
    """Middles of arcs that turn left, over half a circle where they are long."""
    u, v = start - center, end - center
    is_wide = dots(u, v) < 0  # then the chord tells more than the sum of the ends
    across = np.stack([(v - u)[:, 1], (u - v)[:, 0]], axis=1)
    middle = np.where(is_wide[:, None], across, np.where(is_long[:, None], -u - v, u + v))
    square = np.maximum(dots(middle, middle), np.finfo(float).tiny)
    return np.asarray(center + np.sqrt(dots(u, u) / square)[:, None] * middle)


def _halvings(start: Floats, end: Floats, center: Floats, tolerance: float | Floats) -> NDArray[np.int64]:
    """(k,) how often each arc is halved."""
    is_arc = ~np.isnan(center[:, 0])
    a, b = np.where(is_arc[:, None], [start - center, end - center], 0)
    square = dots(a, a)
    quarter = dots(b - a, b - a) / 4
    halvings = np.zeros(len(a), dtype=np.int64)
    is_wide = dots(a, b) < 0
    for _ in range(MOST_HALVINGS):
        radius = np.sqrt(square)
        # the height of the arc over its chord, and a quarter of the square of the chord of its half
        height = quarter / np.maximum(radius + np.sqrt(np.maximum(square - quarter, 0)), np.finfo(float).tiny)
        more = is_arc & (is_wide | (height > tolerance))
        if not more.any():
            record_deviation(height[is_arc])
            break
        halvings += more
        quarter = np.where(more, radius * height / 2, quarter)
        is_wide[:] = False
    return halvings


def _halved(start: Floats, end: Floats, center: Floats, is_left: NDArray[np.bool_], count: int) -> Floats:
    """(k, 2^count - 1, 2) places inside arcs that divide them evenly."""
    ways = np.empty((len(start), 2**count + 1, 2))
    ways[:, 0], ways[:, -1] = start - center, end - center
    radius = norms(ways[:, 0])
    step = 2**count
    while step > 1:
        a, b = ways[:, :-1:step], ways[:, step::step]
        middle = a + b
        if step == 2**count:  # of a wide arc the chord tells more than the sum of its ends
            across = (b - a)[..., ::-1] * np.where(is_left[:, None, None], [1, -1], [-1, 1])
            middle = np.where((a * b).sum(axis=-1, keepdims=True) < 0, across, middle)
        scale = radius[:, None] / norms(middle)
        ways[:, step // 2 :: step] = scale[..., None] * middle
        step //= 2
    return center[:, None] + ways[:, 1:-1]
