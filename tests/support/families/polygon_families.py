"""Rings and lines on the lattice, from harmless to hopeless: each family draws vertices and rings."""

import numpy as np

from vorotool import PlanarGraph, PolygonSet, _core
from vorotool.types.polygons.planar_graph import REPAIRS

SHELL, HOLE, LINE = 0, 1, 2
LIMIT = 2**30 - 1


def rings_of(sizes, kinds):
    """(first vertex, one after the last, kind, polygon) of each ring; a hole belongs to the polygon before it."""
    rings, begin, polygon = [], 0, -1
    for size, kind in zip(sizes, kinds, strict=True):
        follows_polygon = bool(rings) and rings[-1][2] != LINE
        kind = int(kind) if kind != HOLE or follows_polygon else SHELL  # noqa: PLW2901
        polygon += kind != HOLE
        rings.append((begin, begin + int(size), kind, polygon))
        begin += int(size)
    return rings


def random_rings(rng, n):
    """Cut n vertices into rings of random kinds."""
    cuts = np.unique(np.r_[0, rng.integers(1, n + 1, rng.integers(0, 4)), n])
    sizes = np.diff(cuts)
    return rings_of(sizes, rng.choice([SHELL, SHELL, HOLE, LINE], len(sizes)))


def tiny(rng, n):
    """Nearly everything coincides."""
    size = int(rng.integers(1, 5))
    return rng.integers(0, size + 1, (n, 2)), random_rings(rng, n)


def small(rng, n):
    """Crossings off the lattice, between vertices of neighboring cells."""
    return rng.integers(-8, 9, (n, 2)), random_rings(rng, n)


def large(rng, n):
    """As large as the lattice allows."""
    return rng.integers(-LIMIT, LIMIT + 1, (n, 2)), random_rings(rng, n)


def strips(rng, n):
    """Segments across the whole lattice that are nearly parallel."""
    xy = np.empty((n, 2), dtype=np.int64)
    xy[:, 0] = np.where(np.arange(n) % 2, LIMIT, -LIMIT) + rng.integers(0, 3, n) * np.where(np.arange(n) % 2, -1, 1)
    xy[:, 1] = rng.integers(-3, 4, n)
    slope = int(rng.integers(-LIMIT + 4, LIMIT - 4))
    xy[:, 1] += np.where(np.arange(n) % 2, slope, -slope)
    return (xy if rng.random() < 0.5 else xy[:, ::-1]), random_rings(rng, n)


def clusters(rng, n):
    """Clusters of points one or two steps apart, far from each other."""
    centers = rng.integers(-LIMIT + 4, LIMIT - 3, (int(rng.integers(1, 4)), 2))
    return centers[rng.integers(0, len(centers), n)] + rng.integers(-2, 3, (n, 2)), random_rings(rng, n)


def collinear(rng, n):
    """Overlapping edges on few lines."""
    t = rng.integers(-6, 7, n)
    dx, dy = rng.integers(-3, 4, 2)
    xy = np.stack([t * dx, t * dy], axis=1)
    xy[rng.random(n) < 0.2] += rng.integers(-1, 2, 2)
    return xy, random_rings(rng, n)


def spikes(rng, n):
    """A ring that goes back over its own vertices."""
    xy = rng.integers(-10, 11, (n, 2))
    for _ in range(n // 2):
        at = int(rng.integers(0, n))
        xy[at] = xy[at - 2]
    return xy, rings_of([n], [SHELL])


def mosaic(rng, n):
    """Squares and triangles of a grid that share edges and corners, some twice."""
    corners, sizes = [], []
    size = int(rng.integers(1, 4))
    while sum(sizes) + 4 <= max(n, 4):
        x, y = rng.integers(0, 4, 2) * 2
        square = np.array([[x, y], [x + 2 * size, y], [x + 2 * size, y + 2 * size], [x, y + 2 * size]])
        square = np.roll(square, rng.integers(0, 4), axis=0)[: 3 + int(rng.random() < 0.7)]
        corners.append(square if rng.random() < 0.5 else square[::-1])
        sizes.append(len(square))
    return np.concatenate(corners), rings_of(sizes, rng.choice([SHELL, SHELL, HOLE], len(sizes)))


def star(rng, n):
    """A valid polygon: nothing is to be repaired."""
    angle = np.sort(rng.uniform(0, 2 * np.pi, max(n, 3)))
    radius = rng.uniform(0.2, 1, len(angle)) * LIMIT
    return np.rint(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)), rings_of([len(angle)], [SHELL])


FAMILIES = {
    family.__name__: family for family in (tiny, small, large, strips, clusters, collinear, spikes, mosaic, star)
}


def draw(name, n, seed):
    """Vertices as an (n, 2) int32 array, and rings; n may come out a little different."""
    xy, rings = FAMILIES[name](np.random.default_rng(seed), max(n, 1))
    return np.ascontiguousarray(xy, dtype=np.int32), rings


def graph_of(vertices, rings):
    """The graph of rings whose vertices are on the lattice: placed so that one unit is one step."""
    columns = np.array(rings).reshape(-1, 4)
    shapes = PolygonSet(vertices, [0, *columns[:, 1]], columns[:, 2], columns[:, 3])
    vertices = np.ascontiguousarray(vertices, dtype=np.int32)
    made = _core.arrangement.make_planar_graph(
        vertices, shapes.ring_starts, shapes.ring_kind, shapes.ring_polygon, None
    )
    counts = [count for count, _, _ in made.pop("repairs")]
    made.pop("is_repaired")
    made["point_holes"] = made["point_holes"].reshape(-1, 3)
    return PlanarGraph(**made, repairs=dict(zip(REPAIRS, counts, strict=True)))
