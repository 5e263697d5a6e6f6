"""Places of results at vertices of polygons: where an engine has moved these, and where they were given."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.ragged import owners
from vorotool.types.polygons.polygon_set import PolygonSet

Floats = NDArray[np.float64]


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
