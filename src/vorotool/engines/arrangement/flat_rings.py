"""Rings with vertices at one or two places: points and segments."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import owners
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet


def flat_holes(polygons: PolygonSet, places: NDArray[Any] | None = None) -> NDArray[np.bool_]:
    """(r,) whether a ring is a hole with vertices at one or two places."""
    return np.equal(polygons.ring_kind, HOLE) & _are_flat(polygons, polygons.xy if places is None else places)


def with_flat_shells_as_lines(polygons: PolygonSet) -> PolygonSet:
    """Take polygons that are a point or a segment for lines: they are sites, and have no inside."""
    shell = polygons.polygon_starts[:-1]
    is_alone = np.diff(polygons.polygon_starts) == 1
    flat = shell[is_alone & np.equal(polygons.ring_kind[shell], SHELL)]
    flat = flat[_are_flat(polygons, polygons.xy)[flat]]
    if not flat.size:
        return polygons
    kind = polygons.ring_kind.copy()
    kind[flat] = LINE
    return replace(polygons, ring_kind=kind)


def _are_flat(polygons: PolygonSet, places: NDArray[Any]) -> NDArray[np.bool_]:
    start, size = polygons.ring_starts, np.diff(polygons.ring_starts)
    ring = owners(size)
    is_other = (places != places[start[:-1]][ring]).any(axis=1)
    vertex = np.where(is_other, np.arange(len(ring)), len(ring))
    second = np.minimum.reduceat(vertex, start[:-1]) if len(size) else vertex
    second = np.where(second < len(ring), second, start[:-1])  # of one place it is the first
    is_third = is_other & (places != places[second][ring]).any(axis=1)
    has_three: NDArray[np.bool_] = np.bincount(ring[is_third], minlength=len(size)) > 0
    return ~has_three
