from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.families import space_cases as cases
from vorotool._core import tetrahedra

UNDECIDED = 2
CALLS = 150
PREDICATES = {4: tetrahedra.orient3d, 5: tetrahedra.in_sphere}
sizes = pytest.mark.parametrize("n", [4, 5], ids=["orient3d", "in_sphere"])
families = pytest.mark.parametrize("name", cases.FAMILIES)


def by_elimination(points):
    """The sign of the determinant of x, y, z, for five points x² + y² + z² too, and 1, in rationals."""
    rows = [[Fraction(v) for v in p] for p in points.tolist()]
    rows = [[*row, *([sum(v * v for v in row)] if len(rows) == 5 else []), Fraction(1)] for row in rows]
    sign = -1
    for k in range(len(rows)):
        pivot = next((i for i in range(k, len(rows)) if rows[i][k] != 0), None)
        if pivot is None:
            return 0
        if pivot != k:
            rows[k], rows[pivot], sign = rows[pivot], rows[k], -sign
        sign *= 1 if rows[k][k] > 0 else -1
        for i in range(k + 1, len(rows)):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [v - factor * w for v, w in zip(rows[i], rows[k], strict=True)]
    return sign


@sizes
@families
@pytest.mark.parametrize("level", ["auto", "filter", "integers", "wide"])
def test_a_level_is_right_or_undecided(n, name, level):
    points, right = cases.calls(name, CALLS, n, seed=1)
    signs = PREDICATES[n](points, level)
    decided = signs != UNDECIDED
    np.testing.assert_array_equal(signs[decided], right[decided])
    if level != "filter" or name == "uniform":
        assert decided.all()


@sizes
def test_the_families_are_hard(n):
    drawn = [cases.calls(name, CALLS, n, seed=1) for name in cases.NEAR_DEGENERATE]
    beyond = np.concatenate([PREDICATES[n](points, "filter") for points, _ in drawn]) == UNDECIDED
    right = np.concatenate([signs for _, signs in drawn])
    assert beyond.mean() > 0.3
    assert all((right[beyond] == sign).mean() > 0.05 for sign in (-1, 0, 1))


@sizes
@families
def test_integer_oracle_agrees_with_fractions(n, name):
    points, right = cases.calls(name, CALLS, n, seed=1)
    assert [by_elimination(p) for p in points[:20]] == right[:20].tolist()


@families
def test_ties_are_broken_by_the_first_point_that_can(name):
    points, right = cases.calls(name, CALLS, 5, seed=2)
    signs = tetrahedra.in_sphere(points, "ties")
    np.testing.assert_array_equal(signs, cases.exact_ties(points))
    solid = tetrahedra.orient3d(np.ascontiguousarray(points[:, :4])) != 0
    assert (signs[solid] != 0).all()
    np.testing.assert_array_equal(signs[right != 0], right[right != 0])


@sizes
@pytest.mark.parametrize("name", ["near_degenerate", "lattice", "boxes"])
def test_powers_of_two(n, name):
    points, right = cases.calls(name, CALLS, n, seed=3)
    for exponent in (-900, -530, -270, 500, 960):
        np.testing.assert_array_equal(PREDICATES[n](np.ldexp(points, exponent)), right)


@sizes
@pytest.mark.parametrize("on_integers", [False, True])
@pytest.mark.parametrize("scale", [-1074, -300, -40, 0, 190, 600])
@pytest.mark.parametrize("name", ["digits", "bytes", "words", "sphere", "wide"])
def test_the_filters_of_a_set_are_right(n, on_integers, scale, name):
    """Integers that doubles compute exactly, in orient3d alone, or not; and a sphere that is on no lattice."""
    rng = np.random.default_rng(5)
    side = {"digits": 3, "bytes": 500, "words": 2**16 - 1, "wide": 2**30}.get(name)
    points = rng.integers(0, side + 1, (60, 3)).astype(float) if side else cases.degenerate(rng, 1, 61)[0]
    points = np.ldexp(np.unique(points, axis=0), scale)
    tuples = rng.permuted(np.tile(np.arange(len(points), dtype=np.int32), (CALLS, 1)), axis=1)[:, :n].copy()
    right = cases.exact_signs(points[tuples]) if n == 4 else cases.exact_ties(points[tuples])
    np.testing.assert_array_equal(tetrahedra.set_signs(points, tuples, on_integers), right)


coordinates = st.floats(allow_nan=False, allow_infinity=False) | st.integers(-3, 3).map(float)


@sizes
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_any_doubles(n, data):
    points = np.array(data.draw(st.lists(coordinates, min_size=3 * n, max_size=3 * n))).reshape(1, n, 3)
    assert PREDICATES[n](points).tolist() == cases.exact_signs(points).tolist()


def test_unknown_level_is_refused():
    with pytest.raises(ValueError, match="no level of the predicates is called 'magic'"):
        tetrahedra.orient3d(np.zeros((1, 4, 3)), "magic")
