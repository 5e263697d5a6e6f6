"""Where the names of regions are written, compared with a distance transform of each region."""

import numpy as np
import pytest
from scipy import ndimage

from vorotool.engines.label_places import label_places
from vorotool.geometry.label_image import LabelImage


def random_labels(seed):
    rng = np.random.default_rng(seed)
    return rng.integers(0, 5, (6, 8)).repeat(rng.integers(3, 9), axis=0).repeat(rng.integers(3, 9), axis=1)


@pytest.mark.parametrize("seed", range(8))
def test_no_pixel_is_deeper_inside(seed):
    image = random_labels(seed)
    labels, places, radius = label_places(LabelImage(image))
    assert labels.tolist() == np.unique(image[image > 0]).tolist()
    for label, (column, row), found in zip(labels.tolist(), places.tolist(), radius.tolist(), strict=True):
        region = np.pad(image == label, 1)
        inner = ndimage.binary_erosion(region)
        outermost = (region & ~inner)[1:-1, 1:-1]
        everywhere = ndimage.distance_transform_edt(~outermost) * (image == label)
        assert image[row, column] == label
        assert found == everywhere[row, column] == everywhere.max()


def test_the_middle_of_a_bar_and_the_larger_of_two_pieces():
    image = np.zeros((12, 30), np.uint16)
    image[1:6, 2:25] = 9
    image[8:11, 3:6] = 9
    labels, places, radius = label_places(LabelImage(image))
    assert (labels.tolist(), places.tolist(), radius.tolist()) == ([9], [[13, 3]], [2.0])


def test_thin_regions_and_none():
    assert label_places(LabelImage(np.array([[4, 4, 4, 0]])))[1].tolist() == [[1, 0]]
    assert len(label_places(LabelImage(np.zeros((3, 3), np.uint8)))[0]) == 0
