"""Curves as polylines, for formats and pictures that have no curves; cubic Bézier curves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, Indices
from vorotool.numeric.coordinate_grid import finest_deviation, record_deviation
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.ragged import owners, starts_of, within

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
    size = np.sqrt((bend * bend).sum(axis=1))
    bent = np.flatnonzero(size > 0)
    axis = bend[bent] / size[bent][:, None]
    half = np.abs(first[bent, 0] * axis[:, 1] - first[bent, 1] * axis[:, 0])
    height = 2 * half * half / size[bent]
    slopes = [(way[bent] * axis).sum(axis=1) / np.where(half > 0, half, 1) for way in (first, second)]
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
    places: Floats = u * u * u * a + 3 * t * u * (u * b + t * c) + t * t * t * d
    return places


def parts_between(control: Floats, first: Floats, last: Floats) -> Floats:
    """(n, 4, 2) control points of the parts of curves from one parameter to another."""
    made = np.empty_like(control)
    for k, parameters in enumerate(((first,) * 3, (first, first, last), (first, last, last), (last,) * 3)):
        points = np.moveaxis(control, 1, 0)
        for t in parameters:  # the blossom
            points = points[:-1] + t[:, None] * (points[1:] - points[:-1])
        made[:, k] = points[0]
    return made


def cubic_polylines(control: Floats, tolerance: float | Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Curves as polylines, divided evenly in their parameter."""
    second = control[:, 2:] - 2 * control[:, 1:-1] + control[:, :-2]
    bend = np.sqrt((second * second).sum(axis=2)).max(axis=1, initial=0.0)
    pieces = np.clip(np.ceil(np.sqrt(0.75 * bend / tolerance)), 1, MOST_PIECES).astype(np.int64)
    curve = owners(pieces + 1)
    points = places_at(control[curve], within(pieces + 1) / pieces[curve])
    start = starts_of(pieces + 1)
    points[start[:-1]], points[start[1:] - 1] = control[:, 0], control[:, 3]
    return points, start
