"""Masks without holes and small objects: by scikit-image and scipy, as far as they have the same rules."""

import numpy as np
import pytest
from scipy import ndimage

from support.few import few
from vorotool import outlines, seeds_from_raster
from vorotool.engines.tessellation.cleaned_masks import Cleaning, cleaned_mask
from vorotool.errors import UsageError
from vorotool.types.images import Raster

RNG = np.random.default_rng(3)
CORNERS = {4: ndimage.generate_binary_structure(2, 1), 8: ndimage.generate_binary_structure(2, 2)}
MASKS = [
    RNG.random((height, width)) < share
    for height, width, share in [(30, 40, 0.5), (30, 40, 0.7), (25, 25, 0.3), (1, 9, 0.5), (9, 1, 0.5), (2, 2, 0.5)]
]
MASKS += [np.zeros((3, 4), bool), np.ones((3, 4), bool), np.ones((1, 1), bool)]  # fmt: skip


def filled(mask, connectivity, most):
    """Fill holes of at most so many pixels: scikit-image takes what reaches the border for holes, too."""
    background, count = ndimage.label(~mask, CORNERS[12 - connectivity])
    framed = np.pad(background, 1)[[0, 1, -2, -1]], np.pad(background, 1)[:, [0, 1, -2, -1]]
    at_border = set(framed[0].ravel()) | set(framed[1].ravel())
    holes = [k for k in range(1, count + 1) if k not in at_border and (background == k).sum() <= most]
    return mask | np.isin(background, holes)


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("mask", MASKS)
def test_holes(mask, connectivity):
    made = cleaned_mask(mask, Cleaning.of(None, True), connectivity=connectivity)
    expected = ndimage.binary_fill_holes(mask, CORNERS[12 - connectivity])
    assert (made.mask == expected).all()
    assert made.filled == expected.sum() - mask.sum()


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("most", few([2, 1000, 1, 5], 2))
@pytest.mark.parametrize("mask", MASKS)
def test_holes_of_at_most_an_area(mask, connectivity, most):
    made = cleaned_mask(mask, Cleaning.of(None, most), connectivity=connectivity)
    expected = filled(mask, connectivity, most)
    assert (made.mask == expected).all()
    assert made.filled == expected.sum() - mask.sum()


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("min_area", few([2, 1000, 1, 5], 2))
@pytest.mark.parametrize("mask", MASKS)
def test_small_objects(mask, connectivity, min_area):
    made = cleaned_mask(mask, Cleaning.of(min_area, False), connectivity=connectivity)
    labels, count = ndimage.label(mask, CORNERS[connectivity])
    areas = np.bincount(labels.ravel(), minlength=count + 1)
    assert (made.mask == mask & (areas[labels] >= min_area)).all()
    assert made.removed == (areas[1:] < min_area).sum()


def test_holes_count_as_area_and_missing_pixels_stay():
    ring = np.zeros((7, 7), bool)
    ring[1:6, 1:6] = True
    ring[2:5, 2:5] = False
    assert cleaned_mask(ring, Cleaning.of(25, True)).mask.sum() == 25
    assert cleaned_mask(ring, Cleaning.of(25, 8)).mask.sum() == 0
    assert cleaned_mask(ring, Cleaning.of(17, False)).mask.sum() == 0
    missing = np.zeros((7, 7), bool)
    missing[3, 3] = True
    assert cleaned_mask(ring, Cleaning.of(None, True), missing=missing).mask.sum() == 24
    with pytest.raises(UsageError, match="connectivity is 6"):
        cleaned_mask(ring, Cleaning(), connectivity=6)


@pytest.mark.filterwarnings("ignore:.* seeds moved")
@pytest.mark.parametrize("mode", [None, "components", "pixels", "centroids"])
@pytest.mark.parametrize("connectivity", [4, 8])
def test_seeds_and_outlines_of_arrays(mode, connectivity):
    grey = RNG.integers(0, 255, (40, 50)).astype(np.uint8)
    clean = cleaned_mask(grey > 90, Cleaning(6, 3), connectivity=connectivity).mask
    options = {"threshold": 90, "min_area": 6, "fill_holes": 3, "connectivity": connectivity}
    made = seeds_from_raster(grey, mode=mode, **options)
    assert made == seeds_from_raster(clean, mode=mode, connectivity=connectivity)
    if mode in (None, "components"):
        assert outlines(grey, **options) == outlines(clean, connectivity=connectivity)


def rings_of(polygons):
    """Rings of polygons as sets of vertices in their order, each from its least one on."""
    made = []
    for k in range(len(polygons.ring_starts) - 1):
        ring = polygons.ring(k)
        made.append(np.roll(ring, -np.lexsort(ring.T)[0], axis=0).tobytes())
    return made


@pytest.mark.parametrize("invert", [False, True])
@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("above", [0, 0.5])
def test_contours_that_stay_are_as_they_were(above, connectivity, invert):
    rough = ndimage.gaussian_filter(RNG.random((60, 70)), 1.2)
    grey = np.round(240 * (rough - rough.min()) / np.ptp(rough)).astype(np.uint8)
    threshold = int(np.quantile(grey, 0.35 if invert else 0.65)) + above
    mask = (grey <= threshold) if invert else (grey > threshold)
    options = {"outline": "contour", "threshold": threshold, "invert": invert, "connectivity": connectivity}
    before, made = outlines(grey, **options), outlines(grey, **options, min_area=30, fill_holes=10)
    assert set(rings_of(made)) < set(rings_of(before))
    clean = cleaned_mask(mask, Cleaning(30, 10), connectivity=connectivity).mask
    shells = ndimage.label(clean, CORNERS[connectivity])[1]
    assert len(made) == shells < len(before)
    around = outlines(Raster(clean), outline="contour", connectivity=connectivity)
    assert len(rings_of(made)) == len(rings_of(around))


@pytest.mark.parametrize("fill_holes", [False, True, 4])
def test_contours_beside_masked_pixels_go_half_way(fill_holes):
    grey = RNG.integers(0, 9, (40, 50)).astype(np.uint8)
    missing = RNG.random(grey.shape) < 0.1
    options = {"connectivity": 4, "fill_holes": fill_holes}
    made = outlines(Raster(grey, mask=missing), outline="contour", threshold=3.5, **options)
    mask = (grey > 3.5) & ~missing
    clean = cleaned_mask(mask, Cleaning.of(None, fill_holes), connectivity=4, missing=missing).mask
    framed, values = np.pad(clean, 1), np.pad(grey.astype(float), 1, mode="edge")
    expected = set()
    for y, x in np.argwhere(framed):
        for dy, dx in [(0, 1), (1, 0), (0, -1), (-1, 0)]:
            if not framed[y + dy, x + dx]:
                inside, outside = values[y, x], values[y + dy, x + dx]
                share = (inside - 3.5) / (inside - outside) if (inside > 3.5) != (outside > 3.5) else 0.5
                expected.add((round(x - 1 + share * dx, 9), round(y - 1 + share * dy, 9)))
    assert {(round(x, 9), round(y, 9)) for x, y in made.xy.tolist()} == expected
