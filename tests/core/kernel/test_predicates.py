"""The predicates of the plane and of space on every level, against determinants of Python's integers."""

from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.families import predicate_cases as cases
from vorotool._core import kernel, tetrahedra

UNDECIDED = 2


class Predicate(NamedTuple):
    """A predicate of n points in d dimensions, its levels, and how many calls of a family it gets."""

    function: object
    n: int
    d: int
    levels: str
    count: int

    def calls(self, name, seed):
        """The calls of a family with their signs."""
        return cases.calls(name, self.count, self.n, self.d, seed)


PLANE, SPACE = "auto filter seen integers expansions wide", "auto filter integers wide"
PREDICATES = {
    "orient2d": Predicate(kernel.orient2d, 3, 2, PLANE, 400),
    "incircle": Predicate(kernel.incircle, 4, 2, PLANE, 400),
    "orient3d": Predicate(tetrahedra.orient3d, 4, 3, SPACE, 150),
    "in_sphere": Predicate(tetrahedra.in_sphere, 5, 3, SPACE, 150),
}
predicates = pytest.mark.parametrize("predicate", PREDICATES.values(), ids=PREDICATES)
families = pytest.mark.parametrize(
    ("predicate", "name"),
    [
        pytest.param(predicate, name, id=f"{key} {name}")
        for key, predicate in PREDICATES.items()
        for name in ("uniform", "any_double", *cases.NEAR_DEGENERATE[predicate.d])
    ],
)


@families
def test_a_level_is_right_or_undecided(predicate, name):
    points, right = predicate.calls(name, seed=1)
    for level in predicate.levels.split():
        signs = predicate.function(points, level)
        decided = signs != UNDECIDED
        np.testing.assert_array_equal(signs[decided], right[decided], level)
        exact = predicate.d == 3 or name in ("lattice", "fine_lattice", "subnormal")
        if (
            level in ("auto", "wide")
            or (level == "expansions" and name in cases.MODERATE)
            or (level == "integers" and exact)
            or (level == "filter" and name == "uniform")
        ):
            assert decided.all(), level


@predicates
def test_the_families_are_hard(predicate):
    """Half of the calls are beyond the filter, and there are zeros and both signs beyond it."""
    drawn = [predicate.calls(name, seed=1) for name in cases.NEAR_DEGENERATE[predicate.d]]
    beyond = np.concatenate([predicate.function(points, "filter") for points, _ in drawn]) == UNDECIDED
    right = np.concatenate([signs for _, signs in drawn])
    assert beyond.mean() > 0.3
    assert all((right[beyond] == sign).mean() > 0.05 for sign in (-1, 0, 1))


@pytest.mark.parametrize("name", ["uniform", "any_double", *cases.NEAR_DEGENERATE[3]])
def test_ties_are_broken_by_the_first_point_that_can(name):
    points, right = PREDICATES["in_sphere"].calls(name, seed=2)
    signs = tetrahedra.in_sphere(points, "ties")
    np.testing.assert_array_equal(signs, cases.exact_ties(points))
    solid = tetrahedra.orient3d(np.ascontiguousarray(points[:, :4])) != 0
    assert (signs[solid] != 0).all()
    np.testing.assert_array_equal(signs[right != 0], right[right != 0])


@predicates
@pytest.mark.parametrize("name", ["near_degenerate", "lattice", "boxes", "kettner"])
def test_powers_of_two(predicate, name):
    if name in cases.NEAR_DEGENERATE[predicate.d]:
        points, right = predicate.calls(name, seed=3)
        for exponent in (-900, -530, -270, 500, 960):
            np.testing.assert_array_equal(predicate.function(np.ldexp(points, exponent)), right)


@pytest.mark.parametrize("n", [4, 5], ids=["orient3d", "in_sphere"])
@pytest.mark.parametrize("on_integers", [False, True])
@pytest.mark.parametrize("scale", [-1074, -300, -40, 0, 190, 600])
@pytest.mark.parametrize("name", ["digits", "bytes", "words", "sphere", "wide"])
def test_the_filters_of_a_set_are_right(n, on_integers, scale, name):
    """Integers that doubles compute exactly, in orient3d alone, or not; and a sphere that is on no lattice."""
    rng = np.random.default_rng(5)
    side = {"digits": 3, "bytes": 500, "words": 2**16 - 1, "wide": 2**30}.get(name)
    points = rng.integers(0, side + 1, (60, 3)).astype(float) if side else cases.degenerate(rng, 1, 61, 3)[0]
    points = np.ldexp(np.unique(points, axis=0), scale)
    tuples = rng.permuted(np.tile(np.arange(len(points), dtype=np.int32), (150, 1)), axis=1)[:, :n].copy()
    right = cases.exact_signs(points[tuples]) if n == 4 else cases.exact_ties(points[tuples])
    np.testing.assert_array_equal(tetrahedra.set_signs(points, tuples, on_integers), right)


coordinates = st.floats(allow_nan=False, allow_infinity=False) | st.integers(-3, 3).map(float)


@predicates
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_any_doubles(predicate, data):
    shape = (1, predicate.n, predicate.d)
    size = predicate.n * predicate.d
    points = np.array(data.draw(st.lists(coordinates, min_size=size, max_size=size))).reshape(shape)
    assert predicate.function(points).tolist() == cases.exact_signs(points).tolist()


@predicates
def test_unknown_level_is_refused(predicate):
    with pytest.raises(ValueError, match="'magic'"):
        predicate.function(np.zeros((1, predicate.n, predicate.d)), "magic")
