"""Straight on from the inside of polygons to their boundary."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, owners, ranges
from vorotool.types.polygons.polygon_set import PolygonSet

PART = 1 << 18
"""Edges that are looked at together, or those of one polygon."""


def first_hits(
    polygons: PolygonSet, polygon: NDArray[np.integer], origin: Floats, way: Floats
) -> tuple[Floats, NDArray[np.intp]]:
    """Find where each ray meets an edge of its own polygon first, in time linear in the edges of these."""
    first = polygons.ring_starts[polygons.polygon_starts]
    size = np.diff(first)[polygon]
    places, vertices = np.full((len(polygon), 2), np.nan), np.full(len(polygon), -1, dtype=np.intp)
    ends = np.cumsum(size)
    begin = 0
    while begin < len(polygon):
        most = ends[begin] - size[begin] + PART
        end = max(int(np.searchsorted(ends, most, side="right")), begin + 1)
        rays = slice(begin, end)
        places[rays], vertices[rays] = _hits(polygons, first[polygon[rays]], size[rays], origin[rays], way[rays])
        begin = end
    return places, vertices


def _hits(
    polygons: PolygonSet, first: NDArray[np.int64], size: NDArray[np.int64], origin: Floats, way: Floats
) -> tuple[Floats, NDArray[np.intp]]:
    """Of rays with the edges of vertices from `first` on, which are not none."""
    ray, vertex = owners(size), ranges(first, size)
    a, b = (polygons.xy[of] - origin[ray] for of in (vertex, polygons.following[vertex]))
    ahead, met = first_crossings(ray, a, b, way)
    places, vertices = np.full((len(size), 2), np.nan), np.full(len(size), -1, dtype=np.intp)
    found = np.flatnonzero(met >= 0)
    vertices[found] = vertex[met[found]]
    a, b = polygons.xy[vertices[found]], polygons.xy[polygons.following[vertices[found]]]
    places[found] = np.where(a == b, a, origin[found] + ahead[found])  # exactly on edges along an axis
    return places, vertices


def first_crossings(ray: NDArray[np.integer], a: Floats, b: Floats, way: Floats) -> tuple[Floats, NDArray[np.intp]]:
    """Find which of its edges each ray meets first."""
    length = np.sqrt((way * way).sum(axis=1))[:, None]
    way = np.divide(way, length, out=np.zeros(way.shape), where=length > 0)  # a ray that goes nowhere meets nothing
    (ax, ay), (bx, by) = a.T, b.T
    dx, dy = way[ray].T
    met = np.flatnonzero((dx * ay - dy * ax >= 0) != (dx * by - dy * bx >= 0))
    ax, ay, dx, dy = (values[met] for values in (ax, ay, dx, dy))
    ex, ey = (b[met] - a[met]).T
    across = dx * ey - dy * ex
    distance = np.divide(ax * ey - ay * ex, across, out=np.full(len(met), np.inf), where=across != 0)
    distance[~(distance > 0)] = np.inf
    order = np.lexsort((met, distance, ray[met]))
    order = order[np.diff(ray[met][order], prepend=-1) > 0]
    order = order[np.isfinite(distance[order])]
    places, edges = np.full((len(way), 2), np.nan), np.full(len(way), -1, dtype=np.intp)
    found = ray[met][order]
    edges[found] = met[order]
    places[found] = distance[order][:, None] * way[found]
    return places, edges
