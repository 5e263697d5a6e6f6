"""Masks without holes and small objects: by scikit-image and scipy, as far as they have the same rules."""

import numpy as np
import pytest
from scipy import ndimage

from vorotool.engines.tessellation.cleaned_masks import cleaned_mask
from vorotool.errors import UsageError

RNG = np.random.default_rng(3)
CORNERS = {4: ndimage.generate_binary_structure(2, 1), 8: ndimage.generate_binary_structure(2, 2)}
MASKS = [
    RNG.random((height, width)) < share
    for height, width, share in [(30, 40, 0.5), (30, 40, 0.7), (25, 25, 0.3), (1, 9, 0.5), (9, 1, 0.5), (2, 2, 0.5)]
]
MASKS += [np.zeros((3, 4), bool), np.ones((3, 4), bool), np.ones((1, 1), bool)]  # fmt: skip


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("mask", MASKS)
def test_holes(mask, connectivity):
    made = cleaned_mask(mask, fill_holes=True, connectivity=connectivity)
    expected = ndimage.binary_fill_holes(mask, CORNERS[12 - connectivity])
    assert (made.mask == expected).all()
    assert made.filled == expected.sum() - mask.sum()


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("min_area", [1, 2, 5, 1000])
@pytest.mark.parametrize("mask", MASKS)
def test_small_objects(mask, connectivity, min_area):
    made = cleaned_mask(mask, min_area=min_area, connectivity=connectivity)
    labels, count = ndimage.label(mask, CORNERS[connectivity])
    areas = np.bincount(labels.ravel(), minlength=count + 1)
    assert (made.mask == mask & (areas[labels] >= min_area)).all()
    assert made.removed == (areas[1:] < min_area).sum()


def test_holes_count_as_area_and_missing_pixels_stay():
    ring = np.zeros((7, 7), bool)
    ring[1:6, 1:6] = True
    ring[2:5, 2:5] = False
    assert cleaned_mask(ring, min_area=25, fill_holes=True).mask.sum() == 25
    assert cleaned_mask(ring, min_area=17).mask.sum() == 0
    missing = np.zeros((7, 7), bool)
    missing[3, 3] = True
    assert cleaned_mask(ring, fill_holes=True, missing=missing).mask.sum() == 24
    with pytest.raises(UsageError, match="connectivity is 6"):
        cleaned_mask(ring, connectivity=6)
