"""Boundary rings of the union of discs along arcs, for arcs without site information."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.circular_arcs import chords_of
from vorotool.numeric.curves.flatten import circle_tolerances
from vorotool.types.skeleton.skeleton import Skeleton

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_QUARTERS = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])


class Ring(NamedTuple):
    """Vertices of a ring, the polygon that it is in, and a number of the connected part in it, the same for holes."""

    xy: Floats
    polygon: int
    part: int


def covered_rings(skeleton: Skeleton, arcs: Indices, tolerance: float | None) -> list[Ring]:
    """Rings around the discs along some arcs, polygon by polygon."""
    import shapely

    if not len(arcs):
        return []
    to_corner = _to_corner(skeleton, arcs)
    pairs, others = arcs[to_corner], arcs[~to_corner]
    single, first = np.unique(skeleton.arcs[others], return_index=True)
    xy, circle = _circles(skeleton, np.concatenate([single, skeleton.arcs[pairs].reshape(-1)]), tolerance)
    piece = np.where(circle < len(single), circle, (circle + len(single)) // 2)
    pieces = shapely.convex_hull(shapely.multipoints(xy, indices=piece))
    own = skeleton.polygon[np.concatenate([others[first // 2], pairs])]
    order = np.argsort(own, kind="stable")
    polygons, start = np.unique(own[order], return_index=True)
    rings = []
    for polygon, part_of in zip(polygons.tolist(), np.split(pieces[order], start[1:]), strict=True):
        whole = shapely.union_all(part_of)
        for part, shape in enumerate(shapely.get_parts(whole).tolist()):
            turned = shapely.geometry.polygon.orient(shape)
            places = [shapely.get_coordinates(ring)[:-1] for ring in (turned.exterior, *turned.interiors)]
            rings += [Ring(place, polygon, ~part) for place in places]
    return rings


def _to_corner(skeleton: Skeleton, arcs: Indices) -> NDArray[np.bool_]:
    """(k,) whether the sites of each arc have an end in common."""
    left, right = skeleton.site_ends[skeleton.sites[arcs].T]
    found: NDArray[np.bool_] = (left[:, :, None] == right[:, None]).all(axis=-1).any(axis=(1, 2))
    return found


def _circles(skeleton: Skeleton, node: NDArray[np.integer], tolerance: float | None) -> tuple[Floats, Indices]:
    """Vertices of the circle about each node, and which circle each is of."""
    center, r = (np.repeat(values[node], 4, axis=0) for values in (skeleton.vertices, skeleton.radius))
    ways = r[:, None] * np.tile(_QUARTERS, (len(node), 1))
    ends = r[:, None] * np.tile(np.roll(_QUARTERS, -1, axis=0), (len(node), 1))
    is_left = np.ones(len(r), dtype=bool)
    xy, first = chords_of(center + ways, center + ends, center, is_left, circle_tolerances(center, r, tolerance))
    return xy, np.repeat(np.arange(len(r)) // 4, np.diff(first))
