"""Families of points that tests, fuzzing and benchmarks of triangulations share: easy, tied and degenerate ones.

A family gives n points, or about as many, as an (n, 2) array of finite doubles.
"""

import numpy as np

LARGEST = np.finfo(np.float64).max


def uniform(rng, n):
    return rng.random((n, 2))


def clustered(rng, n):
    centers = rng.random((max(1, n // 10000) + 3, 2))
    return centers[rng.integers(0, len(centers), n)] + rng.normal(0, 0.003, (n, 2))


def collinear(rng, n):
    """On a line through lattice points; exactly, since the integers are small."""
    step = rng.integers(-3, 4, 2)
    return rng.integers(-5, 6, 2) + rng.integers(-n, n + 1, (n, 1)) * step + np.zeros((n, 2))


def nearly_collinear(rng, n):
    """A line, but for rounding."""
    start, step = rng.normal(size=(2, 2))
    return start + rng.uniform(-2, 2, (n, 1)) * step


def duplicates(rng, n):
    return rng.random((max(1, n // 3), 2))[rng.integers(0, max(1, n // 3), n)]


def grid(rng, n):
    side = int(np.ceil(np.sqrt(n)))
    points = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    return rng.permutation(points)[:n].astype(np.float64)


def small_lattice(rng, n):
    """Integers of a few units: duplicates, collinear and cocircular points in plenty."""
    side = int(rng.integers(1, 12))
    return rng.integers(-side, side + 1, (n, 2)).astype(np.float64)


def rotated_grid(rng, n):
    """A grid whose lines and circles are so but for rounding."""
    angle = rng.uniform(0, 2 * np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return grid(rng, n) @ turn + rng.choice([0.0, 1.0, 1e3])


def tiny_y(rng, n):
    """The x axis, and points 1e-300 above it."""
    return rng.random((n, 2)) * [1, 1e-300] * [1, rng.integers(0, 2)] + [0, 0]


def near_1e_160(rng, n):
    return (rng.random((n, 2)) if rng.random() < 0.5 else small_lattice(rng, n)) * 1e-160


def near_1e150(rng, n):
    return (rng.random((n, 2)) if rng.random() < 0.5 else small_lattice(rng, n)) * 1e150


def extreme(rng, n):
    """The ends of the range of doubles."""
    scale = rng.choice([5e-324, 1e-310, 2.0**-1022, 2.0**1000, LARGEST / 16])
    return np.clip(small_lattice(rng, n) * scale, -LARGEST, LARGEST)


def any_double(rng, n):
    """All exponents alike."""
    bits = rng.integers(0, 0x7FF0 << 48, (n, 2), dtype=np.uint64) | rng.integers(0, 2, (n, 2), np.uint64) << 63
    return bits.view(np.float64)


def offset_1e9(rng, n):
    return rng.random((n, 2)) + 1e9


def offset_1e14(rng, n):
    """About 64 steps a unit are left: a coarse lattice far from the origin."""
    return rng.random((n, 2)) * rng.choice([1, 100]) + 1e14


def circle(rng, n):
    angle = rng.uniform(0, 2 * np.pi, n) if rng.random() < 0.5 else np.arange(n) * (2 * np.pi / max(n, 1))
    return np.stack([np.cos(angle), np.sin(angle)], axis=1) * rng.choice([1.0, 3.7, 1e9])


def exact_circle(rng, n):
    """Integer points on one circle, and some inside and around."""
    radius = int(rng.choice([5, 25, 65, 325, 1105]))
    a = np.arange(-radius, radius + 1)
    b = np.rint(np.sqrt(radius**2 - a**2)).astype(np.int64)
    on = a**2 + b**2 == radius**2
    points = np.concatenate([np.stack([a, b], 1)[on], np.stack([a, -b], 1)[on]])[rng.integers(0, 2 * on.sum(), n)]
    inside = rng.random(n) < rng.choice([0.0, 0.2])
    points[inside] = rng.integers(-radius, radius + 1, (int(inside.sum()), 2))
    return points.astype(np.float64)


def kettner(rng, n):
    """Kettner et al. 2008: single ulps at 0.5 along the diagonal through 12 and 24."""
    points = np.full((n, 2), 0.5) + rng.integers(0, 8, (n, 2)) * 2.0**-53
    far = rng.random(n) < 0.3
    points[far] = rng.choice([12.0, 24.0, 17.3, 8.8, 0.5], int(far.sum()))[:, None]
    return points


def anisotropic(rng, n):
    return (rng.random((n, 2)) if rng.random() < 0.5 else grid(rng, n)) * [1, 1e-12]


def far_outlier(rng, n):
    """Everything but one point in a single cell of a coarse order."""
    points = rng.random((n, 2)) if rng.random() < 0.5 else small_lattice(rng, n)
    points[:1] = rng.choice([1e7, 1e30, 1e300])
    return points


def by_ulps(rng, n):
    """A small lattice whose coordinates stray by units in the last place."""
    points = small_lattice(rng, n) + rng.choice([0.0, 0.1, 1e6])
    moved = np.nextafter(points, np.where(rng.random(points.shape) < 0.5, -np.inf, np.inf))
    return np.where(rng.random(points.shape) < 0.3, moved, points)


NAMES = """
    uniform clustered collinear nearly_collinear duplicates grid small_lattice rotated_grid tiny_y near_1e_160
    near_1e150 extreme any_double offset_1e9 offset_1e14 circle exact_circle kettner anisotropic far_outlier by_ulps
"""
FAMILIES = {name: globals()[name] for name in NAMES.split()}
SLOW_LAST = sorted(FAMILIES, key="any_double".__eq__)
"""Arithmetic of thousands of bits makes any_double by far the slowest."""
QUICK = len(FAMILIES) - 1


def draw(name, n, seed):
    """The points of a family, the same for the same arguments."""
    points = np.ascontiguousarray(FAMILIES[name](np.random.default_rng(seed), n), dtype=np.float64)
    assert points.ndim == 2
    assert np.isfinite(points).all()
    return points
