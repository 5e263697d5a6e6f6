"""Triangulations from elsewhere: neighbors, edges and hull of given triangles."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vorotool import _core
from vorotool.convert.points import as_points
from vorotool.errors import InputError
from vorotool.numeric.checks import as_array
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.points.point_set import known_of_points

Indices = NDArray[np.int32]


def triangulation_of(points: Any, triangles: ArrayLike) -> Triangulation:
    """Make a `Triangulation` of points and the triangles that another program has found."""
    given = as_points(points)
    corners = _counter_clockwise(given.xy, _checked_triangles(triangles, len(given.xy)))
    if not len(corners):
        raise InputError("triangles is empty: vorotool.delaunay computes a triangulation of points")
    tails, heads = corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)
    twins = _twins(tails, heads, len(given.xy))
    hull = _hull(given.xy, tails[twins < 0], heads[twins < 0])
    across = np.where(twins < 0, -1, twins // 3).reshape(-1, 3)
    return Triangulation(
        given.xy,
        corners,
        np.roll(across, -1, axis=1),  # a side goes from its corner to the next one, and is opposite to the third
        np.sort(np.stack([tails, heads], axis=1)[(twins < 0) | (twins > np.arange(len(twins)))], axis=1),
        hull,
        _first_at_place(given.xy),
        **known_of_points(given),
        first_number=given.first_number,
    )


def _checked_triangles(triangles: ArrayLike, count: int) -> Indices:
    array = as_array(triangles, "triangles")
    if array.size == 0:
        return np.empty((0, 3), dtype=np.int32)
    if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "iu":
        raise InputError(f"triangles must be (n, 3) integers, but have shape {array.shape} and type {array.dtype}")
    bad = np.flatnonzero(((array < 0) | (array >= count)).any(axis=1))
    if bad.size:
        raise InputError(f"triangle {bad[0]} is {array[bad[0]].tolist()}: indices must be from 0 to {count - 1}")
    return array.astype(np.int32)


def _counter_clockwise(xy: NDArray[np.float64], triangles: Indices) -> Indices:
    """Turn clockwise triangles over, by exact signs."""
    signs = np.asarray(_core.kernel.orient2d(np.ascontiguousarray(xy[triangles])))
    flat = np.flatnonzero(signs == 0)
    if flat.size:
        raise InputError(f"triangle {flat[0]} has no area: its corners lie on a line")
    return np.where(signs[:, None] > 0, triangles, triangles[:, [0, 2, 1]])


def _twins(tails: Indices, heads: Indices, count: int) -> NDArray[np.int64]:
    """(3 t,) the side that runs the other way, -1 on the boundary."""
    keys = tails.astype(np.int64) * count + heads
    order = np.argsort(keys, kind="stable")
    repeated = np.flatnonzero(np.diff(keys[order]) == 0)
    if repeated.size:
        side = order[repeated[0]]
        raise InputError(f"two triangles lie on the same side of the edge {tails[side]}, {heads[side]}: they overlap")
    wanted = heads.astype(np.int64) * count + tails
    place = np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)
    return np.where(keys[order[place]] == wanted, order[place], -1)


def _hull(xy: NDArray[np.float64], tails: Indices, heads: Indices) -> Indices:
    """Follow the boundary, counter-clockwise from its lexicographically smallest vertex."""
    if len(np.unique(tails)) < len(tails):
        raise InputError("the boundary of the triangles meets itself: a triangulation fills a convex hull")
    onward = dict(zip(tails.tolist(), heads.tolist(), strict=True))
    smallest = int(tails[np.lexsort(xy[tails].T[::-1])[0]])
    hull = [smallest]
    while (following := onward[hull[-1]]) != smallest:
        hull.append(following)
    if len(hull) < len(onward):
        raise InputError("the triangles have holes or several parts: a triangulation fills a convex hull")
    return np.array(hull, dtype=np.int32)


def _first_at_place(xy: NDArray[np.float64]) -> Indices:
    """(n,) the first point at the place of each."""
    _, first, place = np.unique(xy + 0.0, axis=0, return_index=True, return_inverse=True)
    return first[place.reshape(-1)].astype(np.int32)
