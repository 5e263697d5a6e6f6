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
