"""Seeds from images: what a threshold makes of colours, transparency and values that are no numbers."""

import numpy as np
import pytest

from vorotool.engines.seeding import seeds_from_raster
from vorotool.errors import InputError
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
