"""Otsu's threshold against scikit-image and against fractions."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from skimage.filters import threshold_otsu

from vorotool.engines.tessellation.raster_objects import foreground_values, otsu_threshold
from vorotool.types.images import Raster


def by_fractions(values):
    """The variance between the classes, at every split."""
    ordered = sorted(map(int, values))
    total, best = sum(ordered), (Fraction(-1), 0)
    for value in sorted(set(ordered))[:-1]:
        lower = [each for each in ordered if each <= value]
        n, rest = len(lower), len(ordered) - len(lower)
        difference = Fraction(sum(lower), n) - Fraction(total - sum(lower), rest)
        variance = n * rest * difference**2
        best = max(best, (variance, -value))
    return -best[1]


WIDE = st.lists(st.integers(-(2**63), 2**63 - 1) | st.integers(-3, 3) | st.just(2**62), min_size=2, max_size=12)


@given(WIDE.filter(lambda values: len(set(values)) > 1))
def test_integers_of_any_size_are_compared_exactly(values):
    assert otsu_threshold(np.array(values, dtype=np.int64)) == by_fractions(values)


@given(st.lists(st.integers(0, 2**64 - 1), min_size=2, max_size=12).filter(lambda values: len(set(values)) > 1))
def test_unsigned_integers_too(values):
    assert otsu_threshold(np.array(values, dtype=np.uint64)) == by_fractions(values)


@pytest.mark.parametrize("dtype", [np.uint8, np.int8, np.uint16, np.int16, np.int32, np.float32, np.float64])
def test_ordinary_images_have_the_threshold_of_scikit_image(dtype):
    random = np.random.default_rng(3)
    image = np.clip(np.concatenate([random.normal(30, 9, 500), random.normal(90, 12, 300)]), 0, 127).astype(dtype)
    assert otsu_threshold(image) == threshold_otsu(image)


@pytest.mark.parametrize("exponent", [-1070, -600, 0, 600, 1017])
def test_floating_point_numbers_of_any_size_are_scaled(exponent):
    image = np.array([1.0, 2.0, 3.0, 70.0, 71.0])
    assert otsu_threshold(np.ldexp(image, exponent)) == pytest.approx(
        np.ldexp(threshold_otsu(image), exponent), rel=0.1
    )


@pytest.mark.parametrize("low", [1.0, -1e300, 5e-324, 1e16])
def test_values_next_to_each_other_are_told_apart(low):
    high = np.nextafter(low, np.inf)
    assert otsu_threshold(np.array([low, low, high])) == low


def test_integers_beyond_doubles_are_compared_as_integers():
    image = Raster(np.array([[2**62, 2**62 + 1, 2**62 + 1]]))
    assert foreground_values(image, "otsu", invert=False).tolist() == [[False, True, True]]
