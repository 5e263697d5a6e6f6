"""Vertices and feet of results at the coordinates of the input, where an engine has moved them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, owners
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import Skeleton, ends_of_sites


def places_as_given(
    places: Floats,
    polygon: NDArray[np.integer],
    polygons: PolygonSet,
    *,
    together: bool,
    back: bool = False,
    others: tuple[NDArray[np.integer], Floats, Floats] | None = None,
) -> Floats:
    """Move places at vertices that an engine has moved to where these were given, of several the first, or back."""
    given = polygons.as_given
    if given is polygons or not len(places):
        return places
    here, there = (given.xy, polygons.xy) if back else (polygons.xy, given.xy)
    own = polygons.ring_polygon[owners(np.diff(polygons.ring_starts))]
    if others is not None:
        own, here, there = (np.concatenate(pair) for pair in zip((own, here, there), others, strict=True))
    group = np.zeros(len(polygons), dtype=np.int64) if together else np.asarray(polygons.feature, dtype=np.int64)
    x, y = np.concatenate([here, places]).T
    keys = np.concatenate([group[own], group[polygon]]), x, y
    order = np.lexsort(keys)  # stable: of equal places the first comes first
    is_new = np.ones(len(order), dtype=bool)
    is_new[1:] = np.any([key[order[1:]] != key[order[:-1]] for key in keys], axis=0)
    vertex = np.empty_like(order)
    vertex[order] = order[is_new][np.cumsum(is_new) - 1]
    vertex = vertex[len(here) :]
    made = places.copy()
    known = np.flatnonzero(vertex < len(here))
    made[known] = there[vertex[known]]
    return made


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
