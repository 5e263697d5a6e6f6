"""Seeds from images: what a threshold makes of colors, transparency and values that are no numbers."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from skimage.filters import threshold_otsu

from support.few import few
from vorotool.engines.tessellation.raster_objects import foreground_values, otsu_threshold
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.engines.tessellation.tessellate import tessellate, verify_tessellation
from vorotool.errors import InputError, LimitError, VerificationError, VorotoolWarning
from vorotool.types.images import Raster

INK = np.array([[200, 0, 200], [0, 0, 0]], dtype=np.uint8)


@pytest.mark.parametrize("threshold", [100, "otsu"])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_a_threshold_takes_color_and_leaves_transparency_out(threshold, channels):
    values = np.repeat(INK[:, :, None], channels, axis=2)
    if channels in (2, 4):
        values[:, :, -1] = [[255, 0, 255], [255, 255, 0]]
    seeds = seeds_from_raster(Raster(values), threshold=threshold)
    assert list(zip(seeds.x, seeds.y, seeds.labels, strict=True)) == [(0, 0, 1), (2, 0, 2)]


def test_nan_is_background_of_a_threshold_and_refused_by_otsu():
    values = INK.astype(float)
    values[1, 1] = np.nan
    assert len(seeds_from_raster(Raster(values), threshold=100)) == 2
    for threshold in (None, "otsu"):
        with pytest.raises(InputError, match="NaN"):
            seeds_from_raster(Raster(values), threshold=threshold)


def test_seeds_are_counted_before_memory_is_taken_for_them():
    raster = Raster(np.ones((4, 5), np.uint8))
    for mode in ("pixels", "components", "labels"):
        with pytest.raises(LimitError, match="20 foreground pixels, more than max_sites=19"):
            seeds_from_raster(raster, mode=mode, max_sites=19)
        assert len(seeds_from_raster(raster, mode=mode, max_sites=20)) == 20
    assert len(seeds_from_raster(raster, mode="centroids", max_sites=1)) == 1
    with pytest.raises(LimitError, match="2 objects"):
        seeds_from_raster(Raster(np.array([[1, 0, 2]])), mode="centroids", max_sites=1)


TWO_PATCHES = np.array([[1, 0, 1], [0, 0, 0]])
TYPES = [np.bool_, np.uint8, np.int8, np.uint16, np.int32, np.uint32, np.float32, np.float64]
VALUES = [1, 2, 7, 100, 127, 255, 65535, 2**31 - 1, 2**32 - 1]


def holds(dtype, value):
    return int(np.array(value).astype(dtype)) == value


@pytest.mark.parametrize(("dtype", "value"), few(((t, v) for t in TYPES for v in VALUES if holds(t, v)), 12))
def test_one_value_is_that_of_a_mask_or_a_label(dtype, value):
    is_largest = np.dtype(dtype).kind in "iu" and value == np.iinfo(dtype).max
    is_mask = value in (1, 255) or is_largest
    for background in (True, False):
        image = (TWO_PATCHES * value).astype(dtype) if background else np.full((2, 3), value, dtype)
        labels = [1, 2] if is_mask and background else [1] if is_mask else [value]
        assert seeds_from_raster(image).site_labels.tolist() == labels
        assert len(seeds_from_raster(image, mode="centroids")) == len(labels)


@pytest.mark.parametrize(
    ("image", "words"),
    [
        (TWO_PATCHES.astype(bool), None),
        (TWO_PATCHES.astype(np.uint8), None),
        (255 * TWO_PATCHES.astype(np.uint8), None),
        (65535 * TWO_PATCHES.astype(np.uint16), None),
        (
            0 * TWO_PATCHES + 5 * np.eye(2, 3),
            '5.0 is the only value besides 0, and read as a label: for a mask use mode="components"',
        ),
        (
            TWO_PATCHES.astype(np.uint16),
            '1 is the only value besides 0, and read as a mask: for a label use mode="labels"',
        ),
        (np.array([[1, 2, 0]]), None),
    ],
)
def test_what_was_taken_is_told_where_it_may_surprise(image, words):
    told = []
    seeds_from_raster(image, note=told.append)
    assert told == ([] if words is None else [words])
    seeds_from_raster(image, mode="components", note=told.append)
    assert len(told) == (words is not None)


@pytest.mark.parametrize("method", ["exact", "propagation"])
@pytest.mark.parametrize("mode", [None, "pixels", "components", "labels", "centroids"])
def test_an_image_without_foreground_has_no_seeds_and_labels_0(mode, method):
    image = np.zeros((3, 4), np.uint16)
    with pytest.raises(InputError, match="no foreground"):
        seeds_from_raster(image, mode=mode, strict=True)
    with pytest.warns(VorotoolWarning, match="no foreground"):
        seeds = seeds_from_raster(image, mode=mode)
    assert (seeds.object_area is None) == (mode == "pixels")
    found = tessellate(seeds, method=method)
    assert found.labels.tolist() == image.tolist()
    verify_tessellation(found)
    with pytest.raises(VerificationError, match=r"^1 of 12 pixels is wrong: .* has label \d, not 0$"):
        verify_tessellation(replace(found, labels=np.eye(3, 4, dtype=np.uint16) * [0, 1, 0, 0]))


# ---- Otsu's threshold against scikit-image and against fractions ----
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


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", "g"])
@pytest.mark.filterwarnings("error")
def test_labels_of_every_floating_type(dtype):
    values = np.zeros((5, 5), dtype)
    values[1, 1], values[3, 3] = 2, 1
    expected = tessellate(Raster(values.astype(np.int64))).labels
    assert np.array_equal(tessellate(Raster(values)).labels, expected)
    values[1, 1] = 2**32 if dtype != "f2" else -1  # no float32 is 2^32 - 1
    with pytest.raises(InputError, match="in row 1, column 1: labels must be integers from 0 to 4294967295"):
        tessellate(Raster(values))
