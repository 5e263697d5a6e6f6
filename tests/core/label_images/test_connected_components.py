"""Components of masks, whole and as they pass by in bands: the numbers of scipy.ndimage.label."""

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
        expected, most = ndimage.label(mask, STRUCTURE[corners])  # which numbers by first pixels, too
        whole = np.full(mask.shape, 99, np.uint32)
        assert _core.label_images.label_components(mask.astype(np.uint8), corners, whole, None) == most
        np.testing.assert_array_equal(whole, expected)
        count, found = streamed(mask, corners, heights)
        assert count == most
        np.testing.assert_array_equal(found, expected)


@given(arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12))), st.lists(st.integers(1, 5), min_size=1))
def test_any_mask_in_any_bands(mask, heights):
    check(mask, heights)


@pytest.mark.parametrize("share", [0.02, 0.4, 0.6, 0.98])
@pytest.mark.parametrize(
    ("shape", "heights"),
    [((300, 200), [1]), ((300, 200), [7, 1, 30]), ((300, 200), [300]), ((1, 5000), [1]), ((5000, 1), [900])],
)
def test_noise(share, shape, heights):
    check(np.random.default_rng(5).random(shape) < share, heights)


def test_long_joins():
    """A comb whose teeth are joined at an end, a spiral, a chessboard."""
    comb, spiral = np.zeros((40, 41), bool), np.zeros((41, 41), bool)
    comb[:, ::2] = comb[-1] = True
    for k in range(0, 20, 2):
        spiral[[k, 40 - k], k : 41 - k] = spiral[k : 41 - k, 40 - k] = spiral[k + 2 : 41 - k, k] = True
    for mask in (comb, comb[::-1], spiral, np.indices((30, 31)).sum(axis=0) % 2 == 0):
        check(mask, [3])


def test_nothing_and_everything():
    check(np.zeros((3, 4), bool), [2])
    check(np.ones((3, 4), bool), [2])
    none, out = np.zeros((0, 4), np.uint8), np.zeros((0, 4), np.uint32)
    assert _core.label_images.label_components(none, True, out, None) == 0


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
