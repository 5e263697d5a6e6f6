"""Components of masks beside scikit-image's, numbered by their first pixels."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from skimage.measure import label

from vorotool import _core


def components(mask, corners):
    out = np.full(mask.shape, 99, np.uint32)
    count = _core.label_images.label_components(mask.astype(np.uint8), corners, out, None)
    return count, out


def check(mask):
    for corners in (False, True):
        count, found = components(mask, corners)
        partition, most = label(mask, connectivity=1 + corners, return_num=True)
        assert count == most == found.max(initial=0)
        assert np.array_equal(found > 0, mask)
        assert len(np.unique(np.stack([found[mask], partition[mask]]), axis=1).T) == count  # one to one
        _, first = np.unique(found[mask], return_index=True)
        assert (np.diff(first) > 0).all()  # by first pixels in raster order


@given(arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12))))
def test_any_mask(mask):
    check(mask)


@pytest.mark.parametrize("share", [0.02, 0.4, 0.6, 0.98])
@pytest.mark.parametrize("shape", [(300, 200), (1, 5000), (5000, 1)])
def test_noise(share, shape):
    check(np.random.default_rng(5).random(shape) < share)


def test_long_joins():
    """A comb whose teeth are joined at the end, a spiral, a chessboard."""
    comb = np.zeros((40, 41), bool)
    comb[:, ::2] = comb[-1] = True
    check(comb)
    spiral = np.zeros((41, 41), bool)
    for k in range(0, 20, 2):
        spiral[k, k : 41 - k] = spiral[k : 41 - k, 40 - k] = spiral[40 - k, k : 41 - k] = spiral[k + 2 : 41 - k, k] = (
            True
        )
    check(spiral)
    check(np.indices((30, 31)).sum(axis=0) % 2 == 0)


def test_nothing_and_everything():
    check(np.zeros((3, 4), bool))
    check(np.ones((3, 4), bool))
    assert components(np.zeros((0, 4), bool), True)[0] == 0
