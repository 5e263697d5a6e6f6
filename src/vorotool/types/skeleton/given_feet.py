"""Feet on polygons as they were given, and where a skeleton has these."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.types.polygons.vertices_as_given import places_as_given
from vorotool.types.skeleton.skeleton import Skeleton, ends_of_sites

Floats = NDArray[np.float64]


def moved_feet(skeleton: Skeleton, site: NDArray[np.integer], feet: Floats, *, back: bool = False) -> Floats:
    """Move feet to the vertices and edges that they are on, where these were given, or back."""
    polygons = skeleton.polygons
    if polygons.as_given is polygons:
        return feet
    here, there = skeleton.site_ends[site], ends_of_sites(polygons.as_given, skeleton.site_table, site)
    if back:
        here, there = there, here
    way = here[..., 1, :] - here[..., 0, :]
    square = (way * way).sum(axis=-1)
    t = np.divide(((feet - here[..., 0, :]) * way).sum(axis=-1), square, out=np.zeros(site.shape), where=square > 0)
    together = skeleton.features == "together"
    polygon = skeleton.site_table.polygon[site].reshape(-1)
    moved = places_as_given(feet.reshape(-1, 2), polygon, polygons, together=together, back=back)
    moved = moved.reshape(-1, 2, 2).copy()
    is_inner = (t > 0) & (t < 1)
    moved[is_inner] = projected(there[is_inner], feet[is_inner])
    return moved


def projected(edge: Floats, place: Floats) -> Floats:
    """Return the nearest place on each edge, which is an end of it exactly where nothing nearer is inside."""
    a, b = edge[:, 0], edge[:, 1]
    way, from_a = b - a, place - a
    square = np.square(way).sum(axis=1)
    off = (way[:, 0] * from_a[:, 1] - way[:, 1] * from_a[:, 0]) / square
    near = place - off[:, None] * np.stack([-way[:, 1], way[:, 0]], axis=1)
    near = np.where(way == 0, a, near)
    t = ((from_a * way).sum(axis=1) / square)[:, None]
    return np.asarray(np.where(t <= 0, a, np.where(t >= 1, b, near)))
