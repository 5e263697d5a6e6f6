"""Families of points on which predicates go wrong, and the exact sign of their determinants in Python integers.

A family gives an array (k, n, 2) of k calls of orient2d (n = 3) or incircle (n = 4). They share no code with the
package.
"""

from __future__ import annotations

import functools

import numpy as np

LARGEST = np.finfo(np.float64).max


def by_ulps(rng, points, steps=2):
    """Move each coordinate by up to ``steps`` units in the last place; about half of them stay."""
    with np.errstate(all="ignore"):
        for _ in range(steps):
            moved = np.nextafter(points, np.where(rng.random(points.shape) < 0.5, -np.inf, np.inf))
            points = np.where(rng.random(points.shape) < 0.3, moved, points)
    return np.clip(points, -LARGEST, LARGEST)


def degenerate(rng, k, n):
    """Points on a line or a circle, but for rounding."""
    if n == 3:
        start, step = rng.normal(size=(2, k, 1, 2))
        return start + rng.uniform(-2, 2, (k, n, 1)) * step
    angle = rng.uniform(0, 2 * np.pi, (k, n))
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return rng.normal(size=(k, 1, 2)) + circle * 2.0 ** rng.uniform(-3, 3, (k, 1, 1))


def uniform(rng, k, n):
    return rng.random((k, n, 2))


def near_degenerate(rng, k, n):
    return by_ulps(rng, degenerate(rng, k, n))


def lattice(rng, k, n):
    """Integers up to 2, 2^5, 2^10, 2^20 or 2^31: tuples exactly on a line or circle, some a step beside."""
    side = 2 ** rng.choice([1, 5, 10, 20, 30], (k, 1))
    start, v = rng.integers(-side, side + 1, (2, k, 2))
    if n == 3:
        along = np.stack([0 * v, v, v * rng.integers(-2, 3, (k, 1))], axis=1)
    else:
        w = np.stack([-v[:, 1], v[:, 0]], axis=1)
        along = np.stack([0 * v, v, v + w, w], axis=1)
    beside = rng.integers(-1, 2, (k, n, 2)) * (rng.random((k, n, 1)) < 0.2)
    return (start[:, None] + along + beside).astype(np.float64)


def offset(rng, k, n):
    """Lattices and circles far from the origin, where coordinates have few bits left for the differences."""
    far = rng.choice([1.0, -1.0], (k, 1, 2)) * np.rint(10.0 ** rng.integers(0, 15, (k, 1, 2)))
    beside = by_ulps(rng, degenerate(rng, k, n) * 1e6 + far, steps=1)
    return np.where(rng.random((k, 1, 1)) < 0.7, lattice(rng, k, n) + far, beside)


def fine_lattice(rng, k, n):
    """The same with steps of 2^-1074 to 2^900."""
    return np.ldexp(lattice(rng, k, n), rng.integers(-1074, 900, (k, 1, 1)))


def kettner(rng, k, n):
    """Kettner et al. 2008: a grid of single ulps at 0.5, seen along the diagonal through 12 and 24."""
    points = np.tile([[0.5, 0.5], [12.0, 12.0], [24.0, 24.0], [17.3, 17.3]][:n], (k, 1, 1))
    points[:, 0] += rng.integers(0, 256, (k, 2)) * 2.0**-53
    if n == 4:
        points[:, 3] = points[:, 0] + rng.integers(-1, 2, (k, 2)) * 2.0**-52
    return points[:, rng.permutation(n)]


def scaled(rng, k, n):
    """Near-degenerate at any power of two, up to the ends of the range."""
    return by_ulps(rng, np.ldexp(degenerate(rng, k, n), rng.integers(-1074, 1018, (k, 1, 1))), steps=1)


def flat(rng, k, n):
    """Near-degenerate with x and y at powers of two of their own (y = 1e-300 among them)."""
    return by_ulps(rng, np.ldexp(degenerate(rng, k, n), rng.integers(-1074, 1018, (k, 1, 2))), steps=1)


def any_double(rng, k, n):
    """Any finite doubles, all exponents alike."""
    bits = rng.integers(0, 0x7FF0 << 48, (k, n, 2), dtype=np.uint64) | rng.integers(0, 2, (k, n, 2), np.uint64) << 63
    return bits.view(np.float64)


def any_degenerate(rng, k, n):
    """Exactly on a line or circle with all exponents mixed; some an ulp beside.

    A line through the origin and multiples by powers of two; a rectangle's corners.
    """
    exponents = rng.integers(-1000, 950, (k, 1, 2)) if rng.random() < 0.5 else rng.integers(-240, 240, (k, 1, 2))
    if n == 3:
        v = np.ldexp(rng.normal(size=(k, 1, 2)), exponents)
        factors = np.ldexp(rng.integers(-1, 2, (k, n, 1)).astype(np.float64), rng.integers(-60, 60, (k, n, 1)))
        points = v * factors
    else:
        low, high = np.ldexp(rng.normal(size=(2, k, 2)), exponents[:, 0] + rng.integers(-60, 60, (2, k, 2)))
        x, y = np.stack([low, high], axis=-1).transpose(1, 0, 2)
        points = np.stack([x[:, [0, 1, 1, 0]], y[:, [0, 0, 1, 1]]], axis=-1)
    return np.where(rng.random((k, 1, 1)) < 0.5, by_ulps(rng, points, steps=1), points)


def subnormal(rng, k, n):
    return np.ldexp(rng.integers(-4, 5, (k, n, 2)).astype(np.float64), -1074)


def axis_parallel(rng, k, n):
    """Few distinct coordinates: coincident points, edges along the axes."""
    return rng.choice(rng.normal(size=4), (k, n, 2))


FAMILIES = {
    family.__name__: family
    for family in (
        uniform,
        near_degenerate,
        offset,
        lattice,
        fine_lattice,
        kettner,
        scaled,
        flat,
        any_double,
        any_degenerate,
        subnormal,
        axis_parallel,
    )
}
NEAR_DEGENERATE = [name for name in FAMILIES if name not in ("uniform", "any_double")]
# Coordinates span few enough magnitudes for expansions.
MODERATE = ["uniform", "near_degenerate", "offset", "lattice", "fine_lattice", "kettner", "subnormal", "axis_parallel"]


@functools.cache
def calls(name, k, n, seed):
    """The calls of a family with their signs."""
    points = np.ascontiguousarray(FAMILIES[name](np.random.default_rng([seed, n]), k, n))
    assert points.shape == (k, n, 2)
    assert np.isfinite(points).all()
    return points, exact_signs(points)


def exact_signs(points):
    """The signs of the determinants, in Python integers over a common power of two."""
    sign = orient2d_sign if points.shape[1] == 3 else incircle_sign
    return np.array([sign(*to_integers(row)) for row in points.reshape(len(points), -1).tolist()], dtype=np.int8)


def to_integers(values):
    ratios = [value.as_integer_ratio() for value in values]
    common = max(denominator for _, denominator in ratios)  # all of them are powers of two
    return [numerator * (common // denominator) for numerator, denominator in ratios]


def orient2d_sign(ax, ay, bx, by, cx, cy):
    """The shoelace formula, with no point distinguished."""
    twice = ax * by - bx * ay + bx * cy - cx * by + cx * ay - ax * cy
    return (twice > 0) - (twice < 0)


def incircle_sign(ax, ay, bx, by, cx, cy, dx, dy):
    """The 4 × 4 determinant of rows (x, y, x² + y², 1), by pairs of rows."""
    p, q, r, s = ((x, y, x * x + y * y) for x, y in ((ax, ay), (bx, by), (cx, cy), (dx, dy)))

    def minor(a, b, c):
        return (
            a[0] * (b[1] * c[2] - c[1] * b[2]) - a[1] * (b[0] * c[2] - c[0] * b[2]) + a[2] * (b[0] * c[1] - c[0] * b[1])
        )

    determinant = minor(p, q, r) - minor(p, q, s) + minor(p, r, s) - minor(q, r, s)
    return (determinant > 0) - (determinant < 0)
