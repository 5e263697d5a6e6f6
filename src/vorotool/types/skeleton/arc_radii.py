"""The radius along arcs: its least and largest value, and its integral."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.parallel import in_chunks
from vorotool.types.skeleton.arc_measures import ArcMeasures

Floats = NDArray[np.float64]


def arc_radii(
    count: int, arrays_of: Callable[[slice], tuple[NDArray[Any], ...]], *, threads: int = 1
) -> tuple[Floats, Floats, Floats]:
    """Smallest and largest radius on each of many arcs, and the integral of the radius along it."""
    made = np.empty((3, count))

    def fill(part: slice) -> None:
        made[:, part] = radii_of_arcs(*arrays_of(part))

    in_chunks(count, fill, threads=threads)
    least, most, integral = made
    return least, most, integral


def radii_of_arcs(
    ends: Floats, radius: Floats, control: Floats, sites: Floats, is_edge: NDArray[np.bool_], length: Floats
) -> tuple[Floats, Floats, Floats]:
    """Smallest and largest radius on each arc, and the integral of the radius along it."""
    r0, r1 = np.ascontiguousarray(radius.T)
    least, most = np.minimum(r0, r1), np.maximum(r0, r1)
    integral = length * (r0 + r1) / 2  # between two edges the radius is linear
    rest = np.flatnonzero(~(is_edge[0] & is_edge[1]))
    ends, sites, is_edge = ends.take(rest, axis=0), sites.take(rest, axis=1), is_edge.take(rest, axis=1)
    least[rest] = np.minimum(least[rest], _least_inside(ends, sites, is_edge))
    measures = ArcMeasures(
        ends, radius.take(rest, axis=0), control.take(rest, axis=0), sites, is_edge, length.take(rest)
    )
    integral[rest] = measures.integral
    return least, most, integral


def _least_inside(ends: Floats, sites: Floats, is_edge: NDArray[np.bool_]) -> Floats:
    """Half-way between a vertex and the other site: nearest there, if that is in the middle of the arc; else inf."""
    source, target = _columns(ends)
    left, right = _columns(sites[0]), _columns(sites[1])
    other, first = right[0].copy(), left[0].copy()
    on_left, on_right = map(np.flatnonzero, is_edge)
    other[:, on_right] = _foot(right.take(on_right, axis=2), left[0].take(on_right, axis=1))
    first[:, on_left] = _foot(left.take(on_left, axis=2), right[0].take(on_left, axis=1))
    middle, half = (first + other) / 2, _length(other - first) / 2
    way = target - source
    within = _dot(middle - source, way) * _dot(middle - target, way) < 0
    return np.where(within, half, np.inf)


def _columns(places: Floats) -> Floats:
    """(2, 2, n) of (n, 2, 2): the first and the second of each pair, x and y."""
    return np.ascontiguousarray(np.moveaxis(places, 0, -1))


def _dot(a: Floats, b: Floats) -> Floats:
    product: Floats = a[0] * b[0] + a[1] * b[1]
    return product


def _length(way: Floats) -> Floats:
    length: Floats = np.sqrt(_dot(way, way))  # the same on every machine, as hypot is not
    return length


def _foot(ends: Floats, place: Floats) -> Floats:
    way = ends[1] - ends[0]
    share = _dot(place - ends[0], way) / np.maximum(_dot(way, way), np.finfo(float).tiny)
    foot: Floats = ends[0] + share * way
    return foot
