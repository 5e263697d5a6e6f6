"""Elementary functions beside exact values: decimals of 60 digits."""

from decimal import Decimal, localcontext
from fractions import Fraction
from math import isqrt

import numpy as np
import pytest

from vorotool.numeric.curves.inverse_functions import (
    angle_of,
    cosine_and_sine,
    decimal_logarithm,
    hypotenuse,
    inverse_sine,
)


def _is_next_to_root(found, square):
    """Whether a double is within a unit in its last place of a root, by squares of fractions."""
    step = Fraction(float(np.spacing(found)))
    return (Fraction(found) - step) ** 2 < square < (Fraction(found) + step) ** 2


@pytest.mark.parametrize(
    "exponents", [(0, 0), (0, -30), (300, 280), (600, 600), (-600, -620), (1000, 1022), (-1040, -1050)]
)
def test_lengths_are_wrong_by_less_than_a_unit(exponents):
    rng = np.random.default_rng(3)
    x, y = (np.ldexp(rng.uniform(-1, 1, 500), exponent) for exponent in exponents)
    found = hypotenuse(x, y)
    for a, b, length in zip(x.tolist(), y.tolist(), found.tolist(), strict=True):
        assert _is_next_to_root(length, Fraction(a) ** 2 + Fraction(b) ** 2)


def test_lengths_at_the_limits():
    assert hypotenuse([3, 0, 5e-324, 0], [-4, 0, 0, 1e308]).tolist() == [5, 0, 5e-324, 1e308]
    assert np.isinf(hypotenuse([np.inf, -np.inf], [1.0, 0.0])).all()
    assert np.isnan(hypotenuse(np.nan, 1.0))
    assert hypotenuse(1.5e308, 0.8e308) == 1.7e308
    assert np.isinf(hypotenuse(1.5e308, 1.5e308))


def _cosine_and_sine(angle):
    """Both of a double, by the power series in 60 digits."""
    with localcontext() as context:
        context.prec = 60
        sums, term = [Decimal(0), Decimal(0)], Decimal(1)
        for k in range(80):
            sums[k % 2] += -term if k % 4 >= 2 else term
            term *= Decimal(angle) / (k + 1)
        return [float(value) for value in sums]


def test_cosines_and_sines_are_right_to_a_unit_of_one():
    angles = np.concatenate([np.random.default_rng(4).uniform(-7, 7, 300), np.arange(-8, 9) * (np.pi / 4)])
    right = np.array([_cosine_and_sine(angle) for angle in angles.tolist()]).T
    assert np.abs(np.stack(cosine_and_sine(angles)) - right).max() <= 2.0**-52


def test_angles_turn_the_first_axis_to_the_way():
    rng = np.random.default_rng(5)
    x, y = rng.standard_normal((2, 300)) * 2.0 ** rng.integers(-20, 20, (2, 300))
    squares = [Fraction(a) ** 2 + Fraction(b) ** 2 for a, b in zip(x.tolist(), y.tolist(), strict=True)]
    length = np.array([isqrt(int(square * 2**160)) / 2**80 for square in squares])
    cosine, sine = np.array([_cosine_and_sine(angle) for angle in angle_of(x, y).tolist()]).T
    assert np.abs([cosine * length - x, sine * length - y]).max(axis=0) / length == pytest.approx(0, abs=2.0**-50)


def test_angles_on_the_axes_have_the_signs_of_zero():
    x, y = (values.ravel() for values in np.meshgrid([0.0, -0.0, 1.0, -1.0], [0.0, -0.0, 2.0, -2.0]))
    found = angle_of(x, y)
    assert np.abs(found - np.arctan2(y, x)).max() < 2.0**-50
    assert (np.signbit(found) == np.signbit(np.arctan2(y, x))).all()


def test_arcs_of_sines_are_inverse():
    z = np.concatenate([np.random.default_rng(6).uniform(-1, 1, 300), [-1, 0, 0.25, 1]])
    sine = np.array([_cosine_and_sine(angle)[1] for angle in inverse_sine(z).tolist()])
    assert np.abs(sine - z).max() <= 2.0**-52


def test_logarithms():
    values = [10.0**k for k in range(-300, 301, 7)] + np.random.default_rng(7).uniform(0.1, 10, 100).tolist()
    with localcontext() as context:
        context.prec = 40
        right = [float(Decimal(value).log10()) for value in values]
    assert np.abs(decimal_logarithm(values) - right).max() <= 2.0**-43
    assert np.abs(decimal_logarithm(values[-100:]) - right[-100:]).max() <= 2.0**-51
