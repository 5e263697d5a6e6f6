"""Seeds from images: what a threshold makes of colours, transparency and values that are no numbers."""

import numpy as np
import pytest

from vorotool.engines.raster_objects import _fragments
from vorotool.engines.seeding import seeds_from_raster
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.geometry.raster import Raster

INK = np.array([[200, 0, 200], [0, 0, 0]], dtype=np.uint8)


@pytest.mark.parametrize("threshold", [100, "otsu"])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_a_threshold_takes_colour_and_leaves_transparency_out(threshold, channels):
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


@pytest.mark.parametrize("factor", [1, 10**6])
def test_objects_are_counted_alike_for_dense_and_sparse_labels(factor):
    labels = np.random.default_rng(0).integers(0, 40, (30, 50)) * factor
    seeds = seeds_from_raster(Raster(labels), mode="labels")
    expected, area = np.unique(labels[labels > 0], return_counts=True)
    np.testing.assert_array_equal(seeds.site_labels, expected)
    np.testing.assert_array_equal(seeds.object_area, area)
    np.testing.assert_array_equal(seeds.labels, labels[labels > 0])
    for site, label in zip(seeds.sites, expected, strict=True):
        np.testing.assert_allclose(site, np.argwhere(labels == label)[:, ::-1].mean(axis=0))


def test_seeds_are_counted_before_memory_is_taken_for_them():
    raster = Raster(np.ones((4, 5), np.uint8))
    for mode in ("pixels", "components", "labels"):
        with pytest.raises(LimitError, match="20 foreground pixels, more than --max-sites 19"):
            seeds_from_raster(raster, mode=mode, max_sites=19)
        assert len(seeds_from_raster(raster, mode=mode, max_sites=20)) == 20
    assert len(seeds_from_raster(raster, mode="centroids", max_sites=1)) == 1
    with pytest.raises(LimitError, match="2 objects"):
        seeds_from_raster(Raster(np.array([[1, 0, 2]])), mode="centroids", max_sites=1)


@pytest.mark.parametrize("bad", [-1.0, 2.5, 2.0**32])
def test_a_bad_label_is_named_with_its_place(bad):
    values = np.ones((3, 4))
    values[1, 2] = bad
    with pytest.raises(InputError, match=rf"value {bad} in row 1, column 2: labels must be integers"):
        seeds_from_raster(Raster(values), mode="labels")


@pytest.mark.parametrize("size", [8, 1])
def test_fragments_are_counted_alike_for_objects_and_for_noise(size):
    from skimage.measure import label

    image = np.kron(np.random.default_rng(1).integers(0, 9, (12, 14)), np.ones((2 * size, 3 * size))).astype(np.uint16)
    assert _fragments(image) == (9, label(image, connectivity=1).max())


def test_an_unknown_mode_is_refused():
    with pytest.raises(UsageError, match="mode is 'foo'"):
        seeds_from_raster(Raster(np.eye(2)), mode="foo")
