"""Families of points in space on which predicates go wrong, and the exact sign of their determinants.

A family gives an array (k, n, 3) of k calls of orient3d (n = 4) or in_sphere (n = 5). They share no code with the
package.
"""

from __future__ import annotations

import functools

import numpy as np

from support.families.predicate_cases import by_ulps, to_integers


def degenerate(rng, k, n):
    """Points on a plane or a sphere, but for rounding."""
    if n == 4:
        start, u, v = rng.normal(size=(3, k, 1, 3))
        return start + rng.uniform(-2, 2, (k, n, 1)) * u + rng.uniform(-2, 2, (k, n, 1)) * v
    direction = rng.normal(size=(k, n, 3))
    sphere = direction / np.linalg.norm(direction, axis=2, keepdims=True)
    return rng.normal(size=(k, 1, 3)) + sphere * 2.0 ** rng.uniform(-3, 3, (k, 1, 1))


def uniform(rng, k, n):
    return rng.random((k, n, 3))


def near_degenerate(rng, k, n):
    return by_ulps(rng, degenerate(rng, k, n))


def near_by(rng, k, n):
    """Close together on a sphere or plane that is large."""
    points = degenerate(rng, k, n)
    close = points[:, :1] + (points - points[:, :1]) * 2.0 ** -rng.integers(0, 30, (k, 1, 1))
    return by_ulps(rng, close, steps=1)


def lattice(rng, k, n):
    """Integers up to 2, 2^5, 2^10, 2^20 or 2^30: exactly on a plane or sphere, some a step beside."""
    side = 2 ** rng.choice([1, 5, 10, 20, 30], (k, 1))
    start, u, v = rng.integers(-side, side + 1, (3, k, 3))
    if n == 4:
        factors = rng.integers(-2, 3, (2, k, n, 1))
        along = factors[0] * u[:, None] + factors[1] * v[:, None]
    else:  # all signs and orders of the coordinates of one vector are on a sphere
        order = rng.permuted(np.tile(np.arange(3), (k * n, 1)), axis=1).reshape(k, n, 3)
        along = np.take_along_axis(np.repeat(u[:, None], n, axis=1), order, axis=2) * rng.choice([-1, 1], (k, n, 3))
    beside = rng.integers(-1, 2, (k, n, 3)) * (rng.random((k, n, 1)) < 0.2)
    return (start[:, None] + along + beside).astype(np.float64)


def boxes(rng, k, n):
    """Corners of boxes, of any doubles: cospherical, or coplanar in fours."""
    low, high = np.sort(rng.normal(size=(2, k, 1, 3)), axis=0)
    return np.where(rng.integers(0, 2, (k, n, 3)) == 1, high, low)


def offset(rng, k, n):
    """Lattices and spheres far from the origin, where coordinates have few bits left for the differences."""
    far = rng.choice([1.0, -1.0], (k, 1, 3)) * np.rint(10.0 ** rng.integers(0, 15, (k, 1, 3)))
    beside = by_ulps(rng, degenerate(rng, k, n) * 1e6 + far, steps=1)
    return np.where(rng.random((k, 1, 1)) < 0.7, lattice(rng, k, n) + far, beside)


def fine_lattice(rng, k, n):
    """The same with steps of 2^-1074 to 2^900."""
    return np.ldexp(lattice(rng, k, n), rng.integers(-1074, 900, (k, 1, 1)))


def scaled(rng, k, n):
    """Near-degenerate at any power of two, up to the ends of the range."""
    return by_ulps(rng, np.ldexp(degenerate(rng, k, n), rng.integers(-1074, 1018, (k, 1, 1))), steps=1)


def flat(rng, k, n):
    """Near-degenerate with x, y and z at powers of two of their own."""
    return by_ulps(rng, np.ldexp(degenerate(rng, k, n), rng.integers(-1074, 1018, (k, 1, 3))), steps=1)


def slightly_flat(rng, k, n):
    """The same in the range in which the filter decides."""
    return by_ulps(rng, np.ldexp(degenerate(rng, k, n), rng.integers(-230, 200, (k, 1, 3))), steps=1)


def any_double(rng, k, n):
    """Any finite doubles, all exponents alike."""
    bits = rng.integers(0, 0x7FF0 << 48, (k, n, 3), dtype=np.uint64) | rng.integers(0, 2, (k, n, 3), np.uint64) << 63
    return bits.view(np.float64)


def subnormal(rng, k, n):
    return np.ldexp(rng.integers(-4, 5, (k, n, 3)).astype(np.float64), -1074)


def axis_parallel(rng, k, n):
    """Few distinct coordinates: coincident points, edges along the axes."""
    return rng.choice(rng.normal(size=4), (k, n, 3))


FAMILIES = {
    family.__name__: family
    for family in (
        uniform,
        near_degenerate,
        near_by,
        lattice,
        boxes,
        offset,
        fine_lattice,
        scaled,
        flat,
        slightly_flat,
        any_double,
        subnormal,
        axis_parallel,
    )
}
NEAR_DEGENERATE = [name for name in FAMILIES if name not in ("uniform", "any_double")]


@functools.cache
def calls(name, k, n, seed):
    """The calls of a family with their signs."""
    points = np.ascontiguousarray(FAMILIES[name](np.random.default_rng([seed, n]), k, n))
    assert points.shape == (k, n, 3)
    assert np.isfinite(points).all()
    return points, exact_signs(points)


def exact_signs(points):
    """The signs of the determinants, in Python integers over a common power of two."""
    sign = orient3d_sign if points.shape[1] == 4 else in_sphere_sign
    return np.array([sign(rows_of(row)) for row in points.tolist()], dtype=np.int8)


def exact_ties(points):
    """The signs of in_sphere with ties broken."""
    return np.array([in_sphere_sign(rows_of(row)) or tie_sign(rows_of(row)) for row in points.tolist()], dtype=np.int8)


def rows_of(points):
    """Points as integers over a common power of two."""
    whole = to_integers([value for point in points for value in point])
    return [tuple(whole[i : i + 3]) for i in range(0, len(whole), 3)]


def determinant(rows):
    """By cofactors of the first row."""
    if len(rows) == 1:
        return rows[0][0]
    minors = ([row[:k] + row[k + 1 :] for row in rows[1:]] for k in range(len(rows)))
    return sum((-1) ** k * rows[0][k] * determinant(minor) for k, minor in enumerate(minors) if rows[0][k] != 0)


def sign_of(value):
    return (value > 0) - (value < 0)


def orient3d_sign(points):
    """The determinant of the rows x, y, z, 1."""
    return -sign_of(determinant([(*p, 1) for p in points]))


def in_sphere_sign(points):
    """The determinant of the rows x, y, z, x² + y² + z², 1."""
    return -sign_of(determinant([(*p, sum(v * v for v in p), 1) for p in points]))


def tie_sign(points):
    """The first point in lexicographic order that decides when the heights of the points are lowered one by one."""
    for i in sorted(range(5), key=points.__getitem__):
        sign = sign_of(determinant([(*p, int(j == i), 1) for j, p in enumerate(points)]))
        if sign != 0:
            return sign
    return 0
