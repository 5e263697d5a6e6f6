"""Straight across polygons, from inside to their outline on both sides."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.engines.from_skeleton.boundary_rays import first_crossings
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.ragged import owners
from vorotool.types.polygons.polygon_set import PolygonSet

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_GROWTH = 4
"""By how much a ray is made longer that meets no edge yet."""


def section_ends(
    polygons: PolygonSet, own: NDArray[np.integer] | None, xy: Floats, way: Floats, radius: Floats
) -> tuple[Floats, NDArray[np.int32]]:
    """Find where straight lines across some ways meet the outline first, left and right."""
    left = np.stack([-way[:, 1], way[:, 0]], axis=1)
    across = np.stack([left, -left], axis=1).reshape(-1, 2)
    polygon = None if own is None else np.repeat(own, 2)
    places, vertices = _first_hits(polygons, polygon, np.repeat(xy, 2, axis=0), across, np.repeat(radius, 2))
    ring = np.searchsorted(polygons.ring_starts, vertices, side="right") - 1
    rings = np.where(vertices < 0, -1, ring - polygons.polygon_starts[polygons.ring_polygon[ring]])
    return places.reshape(-1, 2, 2), rings.reshape(-1, 2).astype(np.int32)


def _first_hits(
    polygons: PolygonSet, polygon: NDArray[np.integer] | None, origin: Floats, way: Floats, reach: Floats
) -> tuple[Floats, Indices]:
    """Where each ray meets an edge first, and where that edge begins: edges near the ray are looked at first."""
    way = way / hypotenuse(*way.T)[:, None]
    edges = np.stack([polygons.xy, polygons.xy[polygons.following]], axis=1)
    of_edge = polygons.ring_polygon[owners(np.diff(polygons.ring_starts))]
    tree = shapely.STRtree(shapely.linestrings(edges))
    most = 2 * float(np.abs(polygons.xy - polygons.xy[:1]).sum(axis=1).max(initial=0.0))
    places, vertices = origin.copy(), np.full(len(origin), -1, dtype=np.int64)
    left, reach = np.arange(len(origin)), 2 * reach
    while left.size:
        ends = np.stack([origin[left], origin[left] + reach[left, None] * way[left]], axis=1)
        ray, edge = tree.query(shapely.linestrings(ends))
        if polygon is not None:
            is_own = of_edge[edge] == polygon[left[ray]]
            ray, edge = ray[is_own], edge[is_own]
        order = np.lexsort((edge, ray))  # of equally near ones the first is met
        ray, edge = ray[order], edge[order]
        begin, end = (edges[edge, side] - origin[left[ray]] for side in (0, 1))
        ahead, met = first_crossings(ray, begin, end, way[left])
        # what is farther may be behind an edge that was not looked at
        found = np.flatnonzero((met >= 0) & (hypotenuse(*ahead.T) <= reach[left]))
        of, hit = left[found], edge[met[found]]
        vertices[of] = hit
        a, b = edges[hit].swapaxes(0, 1)
        places[of] = np.where(a == b, a, origin[of] + ahead[found])  # exactly on edges along an axis
        left = left[(vertices[left] < 0) & (reach[left] <= most)]
        reach[left] *= _GROWTH
    return places, vertices
