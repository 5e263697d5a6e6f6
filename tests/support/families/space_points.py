"""Families of points in space: easy, tied and degenerate ones.

A family gives n points, or about as many, as an (n, 3) array of finite doubles.
"""

from __future__ import annotations

import numpy as np


def uniform(rng, n):
    return rng.random((n, 3))


def lattice(rng, n):
    """Integers of a few units: duplicates, coplanar and cospherical points in plenty."""
    return rng.integers(0, rng.integers(2, 5), (n, 3)).astype(np.float64)


def tenths(rng, n):
    """A lattice whose points are on common spheres but for rounding."""
    return rng.integers(0, rng.integers(2, 6), (n, 3)) * 0.1


def duplicates(rng, n):
    places = rng.random((max(2, n // 3), 3))
    return places[rng.integers(0, len(places), n)]


def cospherical(rng, n):
    """Integers on a sphere, exactly, and some elsewhere."""
    axes = np.array([[1, 2, 2], [2, 1, 2], [2, 2, 1], [3, 0, 0], [0, 3, 0], [0, 0, 3]])
    points = axes[rng.integers(0, len(axes), n)] * rng.choice([-1, 1], (n, 3))
    points[rng.random(n) < 0.1] += 1
    return points.astype(np.float64)


def sphere(rng, n):
    """On a sphere, but for rounding."""
    points = rng.normal(size=(n, 3))
    return points / np.linalg.norm(points, axis=1)[:, None]


def flat(rng, n):
    """In a plane, or nearly so: exactly, by a rounding, or by a little."""
    points = rng.integers(-3, 4, (n, 3)).astype(np.float64)
    points[:, 2] = points[:, 0] + points[:, 1] + rng.choice([0.0, 2.0**-40, 2.0**-10]) * rng.integers(0, 2, n)
    return points


def line(rng, n):
    """On a line of lattice points, and now and then one beside it."""
    points = rng.integers(-n, n + 1, (n, 1)) * rng.integers(-2, 3, 3) + np.zeros((n, 3))
    points[0] += rng.integers(0, 2, 3)
    return points


def clustered(rng, n):
    centers = rng.random((max(1, n // 10), 3))
    return centers[rng.integers(0, len(centers), n)] + rng.normal(0, 1e-6, (n, 3))


def scales(rng, n):
    """Coordinates of very different sizes."""
    return rng.normal(size=(n, 3)) * 2.0 ** rng.integers(-40, 40, (n, 1))


FAMILIES = {
    family.__name__: family
    for family in (uniform, lattice, tenths, duplicates, cospherical, sphere, flat, line, clustered, scales)
}
