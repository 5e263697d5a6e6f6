"""Components of masks that pass by in bands: the numbers of the whole, and the partition of scipy.ndimage.label."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import ndimage

from vorotool import _core

STRUCTURE = {False: [[0, 1, 0], [1, 1, 1], [0, 1, 0]], True: np.ones((3, 3))}


def streamed(mask, corners, heights):
    """Numbers of a mask whose rows come in bands of these heights, in turn."""
    bits = mask.astype(np.uint8)
    components = _core.label_images.StreamingComponents(mask.shape[1], corners)
    row, bands = 0, []
    above = np.zeros(mask.shape[1], np.uint32)
    while row < len(mask):
        band = bits[row : row + heights[len(bands) % len(heights)]]
        start, out = components.size, np.full(band.shape, 99, np.uint32)
        components.add(band, out, None)
        bands.append((band, above, start, components.size))
        row, above = row + len(band), out[-1].copy()
    number = np.empty(components.size + 1, np.uint32)
    count = components.settle(number)
    made = []
    for band, above, start, end in reversed(bands):  # in any order
        out = np.full(band.shape, 99, np.uint32)
        _core.label_images.number_band(band, corners, number[above], number[start + 1 : end + 1], out, None)
        made.append(out)
    return count, np.concatenate(made[::-1])


def check(mask, heights):
    for corners in (False, True):
        count, found = streamed(mask, corners, heights)
        expected, most = ndimage.label(mask, STRUCTURE[corners])
        assert count == most
        np.testing.assert_array_equal(found, expected)  # which numbers by first pixels, too
        whole = np.empty(mask.shape, np.uint32)
        _core.label_images.label_components(mask.astype(np.uint8), corners, whole, None)
        np.testing.assert_array_equal(found, whole)


@given(arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12))), st.lists(st.integers(1, 5), min_size=1))
def test_any_mask_in_any_bands(mask, heights):
    check(mask, heights)


@pytest.mark.parametrize("share", [0.02, 0.4, 0.6, 0.98])
@pytest.mark.parametrize("heights", [[1], [7, 1, 30], [300]])
def test_noise(share, heights):
    check(np.random.default_rng(5).random((300, 200)) < share, heights)


def test_long_joins():
    comb = np.zeros((40, 41), bool)
    comb[:, ::2] = comb[-1] = True
    check(comb, [3])
    check(comb[::-1], [3])
    check(np.indices((30, 31)).sum(axis=0) % 2 == 0, [4])


def test_arrays_that_do_not_fit_are_refused():
    mask, row = np.ones((2, 3), np.uint8), np.zeros(3, np.uint32)
    out = np.zeros((2, 3), np.uint32)
    for fresh in ([], [1, 2]):
        with pytest.raises(ValueError, match="components than numbers"):
            _core.label_images.number_band(mask, True, row, np.array(fresh, np.uint32), out, None)
    with pytest.raises(ValueError, match="do not fit together"):
        _core.label_images.number_band(mask, True, row[:2], row, out, None)
    with pytest.raises(ValueError, match="do not fit together"):
        _core.label_images.StreamingComponents(4, True).add(mask, out, None)
    with pytest.raises(ValueError, match="do not fit together"):
        _core.label_images.StreamingComponents(3, True).settle(row)
