"""Necks by the profile of clearances: places along all arcs, joined from the largest clearance to the least."""

from __future__ import annotations

import numpy as np
import shapely

PER_ARC = 65


def ratios_along(skeleton, shape):
    """Ratios and widths of the necks of a shape, as its skeleton has them, right to what places on an arc tell.

    Places are taken in by falling clearance. One that joins two parts is a neck: its ratio is to the smaller of their
    largest clearances. One that joins a part with itself closes a way around a hole.
    """
    places, pairs = places_along(skeleton)
    clearance = shapely.distance(shape.boundary, shapely.points(places))
    root, largest = list(range(len(places))), clearance.tolist()

    def found(place):
        while root[place] != place:
            root[place] = place = root[root[place]]
        return place

    least = clearance[pairs].min(axis=1)
    ratios, widths = [], []
    for pair in np.argsort(-least, kind="stable").tolist():
        a, b = (found(place) for place in pairs[pair].tolist())
        smaller = min(largest[a], largest[b])
        if smaller > 0:
            ratios.append(float(least[pair]) / smaller)
            widths.append(2 * float(least[pair]))
        root[b] = a
        largest[a] = max(largest[a], largest[b])
    return np.array(ratios), np.array(widths)


def places_along(skeleton):
    """Places of nodes and along arcs, and which follow each other."""
    source, target = skeleton.vertices[skeleton.arcs].swapaxes(0, 1)
    control = np.where(skeleton.is_parabola[:, None], skeleton.control, (source + target) / 2)
    t = np.linspace(0, 1, PER_ARC)[1:-1, None, None]
    inner = ((1 - t) ** 2 * source + 2 * t * (1 - t) * control + t * t * target).swapaxes(0, 1)
    numbers = len(skeleton.vertices) + np.arange(inner.shape[0] * inner.shape[1]).reshape(inner.shape[:2])
    chain = np.concatenate([skeleton.arcs[:, :1], numbers, skeleton.arcs[:, 1:]], axis=1)
    pairs = np.stack([chain[:, :-1].ravel(), chain[:, 1:].ravel()], axis=1)
    return np.concatenate([skeleton.vertices, inner.reshape(-1, 2)]), pairs
