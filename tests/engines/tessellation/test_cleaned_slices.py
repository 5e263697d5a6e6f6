"""Volumes without holes and small objects: by scipy, whatever the slabs are in which they are read."""

import numpy as np
import pytest
from scipy import ndimage

from support.few import few
from vorotool import seeds_from_volume
from vorotool.engines.tessellation.cleaned_masks import CleanedSlices, Cleaning
from vorotool.engines.tessellation.raster_objects import PartwiseObjects
from vorotool.engines.tessellation.volume_seeding import seeds_of_slabs
from vorotool.types.volumes.volume import Volume

RNG = np.random.default_rng(8)
CORNERS = {6: ndimage.generate_binary_structure(3, 1), 26: ndimage.generate_binary_structure(3, 3)}
OTHER = {6: 26, 26: 6}
MASKS = [
    RNG.random(shape) < share
    for shape, share in [((9, 12, 11), 0.5), ((9, 12, 11), 0.8), ((7, 8, 9), 0.93), ((1, 9, 8), 0.5), ((9, 1, 8), 0.7)]
]
MASKS += [np.zeros((2, 3, 4), bool), np.ones((2, 3, 4), bool), RNG.random((6, 7, 1)) < 0.5, RNG.random((8, 9, 9)) < 0.1]


def cleaned(mask, cleaning, connectivity):
    """Clean by scipy; voxels that were filled, objects that were left out, and how many there were."""
    made = mask
    if cleaning.fill_holes is not False:
        holes = ndimage.binary_fill_holes(mask, CORNERS[OTHER[connectivity]]) & ~mask
        numbers, count = ndimage.label(~mask, CORNERS[OTHER[connectivity]])
        areas = np.bincount(numbers.ravel(), minlength=count + 1)
        most = mask.size if cleaning.fill_holes is True else cleaning.fill_holes
        made = mask | (holes & (areas[numbers] <= most))
    numbers, count = ndimage.label(made, CORNERS[connectivity])
    areas = np.bincount(numbers.ravel(), minlength=count + 1)
    kept = made & (areas[numbers] >= cleaning.min_area)
    return kept, made.sum() - mask.sum(), (areas[1:] < cleaning.min_area).sum(), count


@pytest.mark.parametrize("step", few([5, 1, 100], 1))
@pytest.mark.parametrize("connectivity", [6, 26])
@pytest.mark.parametrize(
    "cleaning",
    [Cleaning(5, True), Cleaning(9, 2), Cleaning(0, 1), Cleaning(10**30, 3)],
)
@pytest.mark.parametrize("mask", MASKS)
def test_volumes_are_cleaned_as_by_scipy(mask, cleaning, connectivity, step):
    expected, filled, removed, count = cleaned(mask, cleaning, connectivity)
    made = CleanedSlices(PartwiseObjects(Volume(mask), connectivity=connectivity, step=step), cleaning)
    assert (made.slices(0, len(mask)) == expected).all()
    assert made.filled == filled
    assert (made.removed, made.objects) == ((removed, count) if cleaning.min_area > 1 else (0, 0))


def test_slices_are_read_in_any_order():
    mask = MASKS[1]
    expected = cleaned(mask, Cleaning(4, True), 26)[0]
    made = CleanedSlices(PartwiseObjects(Volume(mask), connectivity=26, step=1), Cleaning(4, True))
    for first, count in [(0, 3), (5, 1), (8, 1), (2, 4), (0, 9), (8, 1), (8, 1)]:
        assert (made.slices(first, count) == expected[first : first + count]).all()
    assert (made.shape, made.grid) == (mask.shape, None)


@pytest.mark.parametrize("slices", [None, 1, 4])
@pytest.mark.parametrize("mode", [None, "components", "pixels"])
@pytest.mark.parametrize("connectivity", [6, 26])
def test_seeds_are_those_of_the_clean_volume(mode, connectivity, slices):
    grey = RNG.integers(0, 255, (9, 12, 11)).astype(np.uint8)
    mask = cleaned(grey <= 200, Cleaning(3, 2), connectivity)[0]
    expected = seeds_from_volume(mask, mode=mode, connectivity=connectivity)
    options = {"mode": mode, "connectivity": connectivity, "threshold": 200, "invert": True}
    assert seeds_from_volume(grey, **options, min_area=2.5, fill_holes=2) == expected
    reported = []
    source = Volume(grey)
    made = seeds_of_slabs(source, **options, cleaning=Cleaning(3, 2), slices=slices, report=reported.append)
    assert made == expected
    assert len(reported) == 1
