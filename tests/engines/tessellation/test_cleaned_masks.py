"""Masks and volumes without holes and small objects: by scipy, whatever the slabs are in which volumes are read."""

import numpy as np
import pytest
from scipy import ndimage

from support.few import few
from vorotool import outlines, seeds_from_raster, seeds_from_volume
from vorotool.engines.tessellation.cleaned_masks import CleanedSlices, Cleaning, cleaned_mask
from vorotool.engines.tessellation.raster_objects import PartwiseObjects
from vorotool.engines.tessellation.volume_seeding import seeds_of_slabs
from vorotool.errors import UsageError
from vorotool.types.images import Raster
from vorotool.types.volumes.volume import Volume

RNG = np.random.default_rng(3)
CORNERS = {4: (2, 1), 8: (2, 2), 6: (3, 1), 26: (3, 3)}
CORNERS = {name: ndimage.generate_binary_structure(*each) for name, each in CORNERS.items()}
OTHER = {4: 8, 8: 4, 6: 26, 26: 6}
MASKS = [
    RNG.random(shape) < share
    for *shape, share in [(30, 40, 0.5), (30, 40, 0.7), (25, 25, 0.3), (1, 9, 0.5), (9, 1, 0.5), (2, 2, 0.5)]
]
MASKS += [np.zeros((3, 4), bool), np.ones((3, 4), bool), np.ones((1, 1), bool)]
SOLIDS = [
    RNG.random(shape) < share
    for *shape, share in [(9, 12, 11, 0.5), (9, 12, 11, 0.8), (7, 8, 9, 0.93), (1, 9, 8, 0.5), (9, 1, 8, 0.7)]
]
SOLIDS += [
    np.zeros((2, 3, 4), bool),
    np.ones((2, 3, 4), bool),
    RNG.random((6, 7, 1)) < 0.5,
    RNG.random((8, 9, 9)) < 0.1,
]


def cleaned(mask, cleaning, connectivity):
    """Clean by scipy; pixels that were filled, objects that were left out, and how many there were."""
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


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize(
    ("min_area", "most"),
    few([(None, True), (None, 2), (None, 1000), (2, False), (1000, False), (5, True), (None, 1), (5, 5)], 6),
)
@pytest.mark.parametrize("mask", MASKS)
def test_masks_are_cleaned_as_by_scipy(mask, min_area, most, connectivity):
    cleaning = Cleaning.of(min_area, most)
    made, (expected, filled, removed, _) = (
        cleaned_mask(mask, cleaning, connectivity=connectivity),
        cleaned(mask, cleaning, connectivity),
    )
    assert (made.mask == expected).all()
    assert (made.filled, made.removed) == (filled, removed)


@pytest.mark.parametrize("step", few([5, 1, 100], 1))
@pytest.mark.parametrize("connectivity", [6, 26])
@pytest.mark.parametrize("cleaning", [Cleaning(5, True), Cleaning(9, 2), Cleaning(0, 1), Cleaning(10**30, 3)])
@pytest.mark.parametrize("mask", SOLIDS)
def test_volumes_are_cleaned_as_by_scipy(mask, cleaning, connectivity, step):
    expected, filled, removed, count = cleaned(mask, cleaning, connectivity)
    made = CleanedSlices(PartwiseObjects(Volume(mask), connectivity=connectivity, step=step), cleaning)
    assert (made.slices(0, len(mask)) == expected).all()
    assert made.filled == filled
    assert (made.removed, made.objects) == ((removed, count) if cleaning.min_area > 1 else (0, 0))


def test_slices_are_read_in_any_order():
    mask = SOLIDS[1]
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
    told = []
    made = seeds_of_slabs(Volume(grey), **options, cleaning=Cleaning(3, 2), slices=slices, report=told.append)
    assert (made, len(told)) == (expected, 1)


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
