from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.families import predicate_cases as cases
from vorotool import _core

UNDECIDED = 2
CALLS = 400
PREDICATES = {3: _core.kernel.orient2d, 4: _core.kernel.incircle}
sizes = pytest.mark.parametrize("n", [3, 4], ids=["orient2d", "incircle"])
families = pytest.mark.parametrize("name", cases.FAMILIES)


def by_fractions(points):
    """Cofactors of the matrix with 1, x, y and, for four points, x² + y², in rationals."""
    rows = [[Fraction(1), Fraction(x), Fraction(y), Fraction(x) ** 2 + Fraction(y) ** 2] for x, y in points.tolist()]

    def determinant(m):
        if not m:
            return Fraction(1)
        return sum((-1) ** k * m[0][k] * determinant([r[:k] + r[k + 1 :] for r in m[1:]]) for k in range(len(m)))

    n = len(rows)
    value = determinant([row[:n] for row in rows])
    return ((value > 0) - (value < 0)) * (1 if n == 3 else -1)


@sizes
@families
@pytest.mark.parametrize("level", ["auto", "filter", "seen", "integers", "expansions", "wide"])
def test_a_level_is_right_or_undecided(n, name, level):
    points, right = cases.calls(name, CALLS, n, seed=1)
    signs = PREDICATES[n](points, level)
    decided = signs != UNDECIDED
    np.testing.assert_array_equal(signs[decided], right[decided])
    if (
        level in ("auto", "wide")
        or (level == "expansions" and name in cases.MODERATE)
        or (level == "integers" and name in ("lattice", "fine_lattice", "subnormal"))
        or (level == "filter" and name == "uniform")
    ):
        assert decided.all()


@sizes
def test_the_families_are_hard(n):
    """Half of the calls are beyond the filter, and there are zeros and both signs beyond it."""
    drawn = [cases.calls(name, CALLS, n, seed=1) for name in cases.NEAR_DEGENERATE]
    beyond = np.concatenate([PREDICATES[n](points, "filter") for points, _ in drawn]) == UNDECIDED
    right = np.concatenate([signs for _, signs in drawn])
    assert beyond.mean() > 0.3
    assert all((right[beyond] == sign).mean() > 0.05 for sign in (-1, 0, 1))


@sizes
@families
def test_integer_oracle_agrees_with_fractions(n, name):
    points, right = cases.calls(name, CALLS, n, seed=1)
    assert [by_fractions(p) for p in points[:20]] == right[:20].tolist()


@sizes
@pytest.mark.parametrize("name", ["near_degenerate", "lattice", "kettner"])
def test_powers_of_two(n, name):
    points, right = cases.calls(name, CALLS, n, seed=3)
    for exponent in (-900, -530, -270, 500, 960):
        np.testing.assert_array_equal(PREDICATES[n](np.ldexp(points, exponent)), right)


def test_the_grid_of_kettner():
    """All 256 × 256 points of the classic picture, against the exact sign of y - x."""
    steps = np.arange(256)
    x, y = np.meshgrid(steps, steps)
    grid = 0.5 + np.stack([x.ravel(), y.ravel()], axis=-1) * 2.0**-53
    points = np.stack([grid, np.full_like(grid, 12), np.full_like(grid, 24)], axis=1)
    np.testing.assert_array_equal(_core.kernel.orient2d(points), np.sign(grid[:, 1] - grid[:, 0]))


@pytest.mark.parametrize("scale", [5e-324, 1e-320, 1e-308, 1e-160, 1e-77, 1.0, 1e77, 1e150, 1e308])
def test_named_magnitudes(scale):
    square = np.array([[0, 0], [scale, 0], [scale, scale], [0, scale]])
    assert _core.kernel.orient2d(square[None, :3]).tolist() == [1]
    assert _core.kernel.orient2d(np.array([[-square[2], square[0], square[2]]])).tolist() == [0]
    assert _core.kernel.incircle(square[None]).tolist() == [0]
    inside = np.nextafter(scale, 0)
    assert _core.kernel.incircle(np.array([[*square[:3], [0, inside]]])).tolist() == [1 if inside > 0 else 0]
    assert _core.kernel.incircle(np.array([[*square[:3], [-5e-324, scale]]])).tolist() == [-1]


def test_huge_and_tiny_in_one_call():
    huge, tiny = np.finfo(float).max, 5e-324
    line = [[-huge, -huge], [huge, huge]]
    calls = np.array([[*line, p] for p in ([0, tiny], [tiny, 0], [tiny, tiny])])
    assert _core.kernel.orient2d(calls).tolist() == [1, -1, 0]
    circle = [[huge, 0], [0, huge], [-huge, 0]]
    assert _core.kernel.incircle(np.array([[*circle, p] for p in ([0, -huge], [tiny, -huge])])).tolist() == [0, -1]


coordinates = st.floats(allow_nan=False, allow_infinity=False) | st.integers(-3, 3).map(float)


@sizes
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_any_doubles(n, data):
    points = np.array(data.draw(st.lists(coordinates, min_size=2 * n, max_size=2 * n))).reshape(1, n, 2)
    assert PREDICATES[n](points).tolist() == cases.exact_signs(points).tolist()


def test_unknown_level_is_refused():
    with pytest.raises(ValueError, match="no level of the predicates is called 'magic'"):
        _core.kernel.orient2d(np.zeros((1, 3, 2)), "magic")
