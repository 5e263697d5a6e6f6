"""Placement on the lattice, beside exact rationals."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vorotool import _core

LIMIT = 2**30 - 1


def place(points, threads=1):
    return _core.arrangement.place_on_lattice(np.array(points, dtype=np.float64).reshape(-1, 2), threads, None)


def check(points):
    """All that is promised; returns the exponent and the largest move."""
    lattice, origin, exponent, most = place(points)
    step = Fraction(2) ** exponent
    assert np.abs(lattice.astype(np.int64)).max(initial=0) <= LIMIT
    squares = [Fraction(0)]
    for point, placed in zip(points, lattice.tolist(), strict=True):
        moves = [Fraction(x) - Fraction(o) - c * step for x, o, c in zip(point, origin, placed, strict=True)]
        assert all(abs(move) <= step / 2 for move in moves)
        squares.append(sum(move * move for move in moves))
    for o in origin:
        assert Fraction(o) % step == 0
    assert (most == 0) == (max(squares) == 0)
    assert max(squares) <= Fraction(most) ** 2
    tiny = Fraction(2) ** -1074
    assert (Fraction(most) - 4 * tiny) ** 2 <= 2 * max(squares) or Fraction(most) <= 4 * tiny
    extent = max((max(c) - min(c) for c in zip(*(map(Fraction, p) for p in points), strict=True)), default=0)
    if exponent > -1074:
        assert extent > step * (LIMIT - 1)  # a finer lattice would not hold it
    return exponent, most


finite = st.floats(allow_nan=False, allow_infinity=False)
close = st.integers(-(2**20), 2**20).flatmap(lambda k: st.sampled_from([float(k), k / 3, k * 1e-300, k * 1e300]))


@given(st.lists(st.tuples(finite, finite), min_size=1, max_size=8))
def test_any_doubles(points):
    check(points)


@given(st.lists(st.tuples(close, close), min_size=1, max_size=8), st.floats(-1e16, 1e16), st.integers(-1000, 900))
def test_offsets(points, offset, exponent):
    """Small extents far away, and everything times a power of two."""
    check([(x + offset, y) for x, y in points])
    scaled = [(x * 2.0**exponent, y * 2.0**exponent) for x, y in points]
    if np.isfinite(scaled).all():
        check(scaled)


@pytest.mark.parametrize(
    "points",
    [
        [(0.0, 0.0), (2.0**31 - 2, 1.0)],
        [(-(2.0**30) + 1, -5.0), (2.0**30 - 1, 2.0**30 - 1)],
        [(1e15, 1e15), (1e15 + 0.125, 1e15 + 7)],
        [(0.5, 0.25), (1000.75, 3.0)],
        [(0.1, 1e-300)],
        [(1e300, -1e300)],
        [(5e-324, 0.0), (0.0, 5e-324)],
        [(1e-300, 1e-300), (1e-300, np.nextafter(1e-300, 1))],
        [(7.0, 7.0)] * 5,
        [(x, 3.0) for x in range(-1000, 1000, 7)],
    ],
)
def test_what_is_on_a_lattice_does_not_move(points):
    assert check(points)[1] == 0


@pytest.mark.parametrize("scale", [1e-300, 1e-150, 1.0, 1e150, 1e300])
def test_extreme_extents(scale):
    rng = np.random.default_rng(1)
    points = (rng.uniform(-1, 1, (50, 2)) * scale).tolist()
    exponent, most = check([tuple(p) for p in points])
    assert 0 < most <= 0.71 * 2.0**exponent
    check([(-1.7e308, 1.7e308), (1.7e308, -1.7e308), (scale, -scale)])
