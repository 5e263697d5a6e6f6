"""Outlines of pixels without the vertices that objects have from their neighbors only."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.ragged import starts_of
from vorotool.plain import plain
from vorotool.types.polygons.polygon_set import LINE, PolygonSet

Indices = NDArray[np.int64]


@plain(eq=False)
class OwnCorners:
    """Polygons without vertices in which they go straight on."""

    polygons: PolygonSet  # with the same rings
    vertex: Indices  # (n,) int64 array: the number of each vertex among those that were given


def own_corners(polygons: PolygonSet) -> OwnCorners | None:
    """Leave out vertices in which rings go straight on; None if there are none."""
    if not len(polygons.xy):
        return None
    candidates = _between_likes(polygons)
    before, after = (polygons.xy[k] for k in _neighbors(polygons, candidates))
    here = polygons.xy[candidates]
    (ux, uy), (vx, vy) = (here - before).T, (after - here).T
    straight = candidates[(ux * vy == uy * vx) & (ux * vx + uy * vy > 0)]
    if not straight.size:
        return None
    is_straight = np.zeros(len(polygons.xy), dtype=bool)
    is_straight[straight] = True
    start = polygons.ring_starts
    kept = np.flatnonzero(~is_straight)
    sizes = np.add.reduceat(~is_straight, start[:-1])
    return OwnCorners(replace(polygons, xy=polygons.xy[kept], ring_starts=starts_of(sizes)), kept)


def _between_likes(polygons: PolygonSet) -> Indices:
    """Vertices between two edges that are both along the rows, or both not; those of lines have none on one side."""
    xy, start = polygons.xy, polygons.ring_starts
    is_along = np.empty(len(xy), dtype=bool)
    np.equal(xy[1:, 1], xy[:-1, 1], out=is_along[:-1])
    is_along[start[1:] - 1] = xy[start[:-1], 1] == xy[start[1:] - 1, 1]
    is_like = np.empty(len(xy), dtype=bool)
    np.equal(is_along[1:], is_along[:-1], out=is_like[1:])
    is_like[start[:-1]] = is_along[start[:-1]] == is_along[start[1:] - 1]
    candidates = np.flatnonzero(is_like)
    ring = np.searchsorted(start, candidates, side="right") - 1
    return candidates[~np.equal(polygons.ring_kind, LINE)[ring]]


def _neighbors(polygons: PolygonSet, vertices: Indices) -> tuple[Indices, Indices]:
    """The vertices before and after some."""
    start = polygons.ring_starts
    ring = np.searchsorted(start, vertices, side="right") - 1
    first, last = start[ring], start[ring + 1] - 1
    return np.where(vertices == first, last, vertices - 1), np.where(vertices == last, first, vertices + 1)
