"""Families of points on which predicates go wrong, and the exact sign of their determinants in Python integers.

A family gives an array (k, n, d) of k calls of a predicate in the plane (d = 2) or in space (d = 3): of n = d + 1
points (orient2d, orient3d) or of n = d + 2 (incircle, in_sphere). They share no code with the package.
"""

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


def degenerate(rng, k, n, d):
    """Points on a line or a plane, a circle or a sphere, but for rounding."""
    start = rng.normal(size=(k, 1, d))
    if n == d + 1:
        return start + sum(rng.uniform(-2, 2, (k, n, 1)) * rng.normal(size=(k, 1, d)) for _ in range(d - 1))
    direction = rng.normal(size=(k, n, d))
    sphere = direction / np.linalg.norm(direction, axis=2, keepdims=True)
    return start + sphere * 2.0 ** rng.uniform(-3, 3, (k, 1, 1))


def uniform(rng, k, n, d):
    return rng.random((k, n, d))


def near_degenerate(rng, k, n, d):
    return by_ulps(rng, degenerate(rng, k, n, d))


def near_by(rng, k, n, d):
    """Close together on what is large."""
    points = degenerate(rng, k, n, d)
    close = points[:, :1] + (points - points[:, :1]) * 2.0 ** -rng.integers(0, 30, (k, 1, 1))
    return by_ulps(rng, close, steps=1)


def lattice(rng, k, n, d):
    """Integers up to 2, 2^5, 2^10, 2^20 or 2^30: exactly on a line, plane, circle or sphere, some a step beside."""
    side = 2 ** rng.choice([1, 5, 10, 20, 30], (k, 1))
    start, *vectors = rng.integers(-side, side + 1, (d, k, d))
    if n == d + 1:
        along = sum(rng.integers(-2, 3, (k, n, 1)) * vector[:, None] for vector in vectors)
    else:  # all signs and orders of the coordinates of one vector are on a circle or sphere
        order = rng.permuted(np.tile(np.arange(d), (k * n, 1)), axis=1).reshape(k, n, d)
        along = np.take_along_axis(np.repeat(vectors[0][:, None], n, axis=1), order, axis=2)
        along *= rng.choice([-1, 1], (k, n, d))
    beside = rng.integers(-1, 2, (k, n, d)) * (rng.random((k, n, 1)) < 0.2)
    return (start[:, None] + along + beside).astype(np.float64)


def boxes(rng, k, n, d):
    """Corners of boxes, of any doubles."""
    low, high = np.sort(rng.normal(size=(2, k, 1, d)), axis=0)
    return np.where(rng.integers(0, 2, (k, n, d)) == 1, high, low)


def offset(rng, k, n, d):
    """Lattices and circles far from the origin, where coordinates have few bits left for the differences."""
    far = rng.choice([1.0, -1.0], (k, 1, d)) * np.rint(10.0 ** rng.integers(0, 15, (k, 1, d)))
    beside = by_ulps(rng, degenerate(rng, k, n, d) * 1e6 + far, steps=1)
    return np.where(rng.random((k, 1, 1)) < 0.7, lattice(rng, k, n, d) + far, beside)


def fine_lattice(rng, k, n, d):
    """The same with steps of 2^-1074 to 2^900."""
    return np.ldexp(lattice(rng, k, n, d), rng.integers(-1074, 900, (k, 1, 1)))


def kettner(rng, k, n, d):
    """Kettner et al. 2008: a grid of single ulps at 0.5, seen along the diagonal through 12 and 24."""
    points = np.tile([[0.5, 0.5], [12.0, 12.0], [24.0, 24.0], [17.3, 17.3]][:n], (k, 1, 1))
    points[:, 0] += rng.integers(0, 256, (k, 2)) * 2.0**-53
    if n == 4:
        points[:, 3] = points[:, 0] + rng.integers(-1, 2, (k, 2)) * 2.0**-52
    return points[:, rng.permutation(n)]


def scaled(rng, k, n, d):
    """Near-degenerate at any power of two, up to the ends of the range."""
    return by_ulps(rng, np.ldexp(degenerate(rng, k, n, d), rng.integers(-1074, 1018, (k, 1, 1))), steps=1)


def flat(rng, k, n, d):
    """Near-degenerate with each axis at powers of two of its own (y = 1e-300 among them)."""
    return by_ulps(rng, np.ldexp(degenerate(rng, k, n, d), rng.integers(-1074, 1018, (k, 1, d))), steps=1)


def slightly_flat(rng, k, n, d):
    """The same in the range in which the filter decides."""
    return by_ulps(rng, np.ldexp(degenerate(rng, k, n, d), rng.integers(-230, 200, (k, 1, d))), steps=1)


def any_double(rng, k, n, d):
    """Any finite doubles, all exponents alike."""
    bits = rng.integers(0, 0x7FF0 << 48, (k, n, d), dtype=np.uint64) | rng.integers(0, 2, (k, n, d), np.uint64) << 63
    return bits.view(np.float64)


def any_degenerate(rng, k, n, d):
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


def subnormal(rng, k, n, d):
    return np.ldexp(rng.integers(-4, 5, (k, n, d)).astype(np.float64), -1074)


def axis_parallel(rng, k, n, d):
    """Few distinct coordinates: coincident points, edges along the axes."""
    return rng.choice(rng.normal(size=4), (k, n, d))


FAMILIES = {
    family.__name__: family
    for family in (
        *(uniform, near_degenerate, near_by, lattice, boxes, offset, fine_lattice, scaled, flat, slightly_flat),
        *(any_double, subnormal, axis_parallel, kettner, any_degenerate),
    )
}
OF_THE_PLANE = ("kettner", "any_degenerate")
NEAR_DEGENERATE = {
    d: [name for name in FAMILIES if name not in ("uniform", "any_double") and (d == 2 or name not in OF_THE_PLANE)]
    for d in (2, 3)
}
# Coordinates span few enough magnitudes for expansions.
MODERATE = ["uniform", "near_degenerate", "offset", "lattice", "fine_lattice", "kettner", "subnormal", "axis_parallel"]


@functools.cache
def calls(name, k, n, d, seed):
    """The calls of a family with their signs."""
    points = np.ascontiguousarray(FAMILIES[name](np.random.default_rng([seed, n]), k, n, d))
    assert points.shape == (k, n, d)
    assert np.isfinite(points).all()
    return points, exact_signs(points)


def exact_signs(points):
    """The signs of the determinants, in Python integers over a common power of two."""
    return np.array([exact_sign(rows_of(row)) for row in points.tolist()], dtype=np.int8)


def exact_ties(points):
    """The signs of in_sphere with ties broken."""
    return np.array([exact_sign(rows_of(row)) or tie_sign(rows_of(row)) for row in points.tolist()], dtype=np.int8)


def to_integers(values):
    ratios = [value.as_integer_ratio() for value in values]
    common = max(denominator for _, denominator in ratios)  # all of them are powers of two
    return [numerator * (common // denominator) for numerator, denominator in ratios]


def rows_of(points):
    """Points as integers over a common power of two."""
    whole, d = to_integers([value for point in points for value in point]), len(points[0])
    return [tuple(whole[i : i + d]) for i in range(0, len(whole), d)]


def determinant(rows):
    """By cofactors of the first row."""
    if len(rows) == 1:
        return rows[0][0]
    minors = ([row[:k] + row[k + 1 :] for row in rows[1:]] for k in range(len(rows)))
    return sum((-1) ** k * rows[0][k] * determinant(minor) for k, minor in enumerate(minors) if rows[0][k] != 0)


def sign_of(value):
    return (value > 0) - (value < 0)


def exact_sign(points):
    """The determinant of the rows x, y, …, for one point more than a simplex has their squares too, and 1."""
    d = len(points[0])
    squares = [(sum(v * v for v in p),) * (len(points) == d + 2) for p in points]
    return (1 if d == 2 else -1) * sign_of(determinant([(*p, *s, 1) for p, s in zip(points, squares, strict=True)]))


def tie_sign(points):
    """The first point in lexicographic order that decides when the heights of the points are lowered one by one."""
    for i in sorted(range(5), key=points.__getitem__):
        sign = sign_of(determinant([(*p, int(j == i), 1) for j, p in enumerate(points)]))
        if sign != 0:
            return sign
    return 0
