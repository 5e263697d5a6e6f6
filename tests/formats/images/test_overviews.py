"""Pages of TIFF files: overviews and masks of an image are none."""

import numpy as np
import pytest
import tifffile

import vorotool
from support.refusals import refused
from vorotool.formats.images.image_header import page_count


@pytest.mark.parametrize("kinds", [[1], [1, 1]])
def test_overviews_are_no_pages(tmp_path, kinds):
    values = np.random.default_rng(2).integers(0, 9, (40, 60)).astype(np.uint8)
    path = tmp_path / "map.tif"
    with tifffile.TiffWriter(path) as file:
        file.write(values, photometric="minisblack")
        for step, kind in enumerate(kinds, 2):
            file.write(values[::step, ::step].copy(), photometric="minisblack", subfiletype=kind)
    assert np.array_equal(vorotool.read(path).values, values)
    assert page_count(str(path)) == 1
    assert np.array_equal(vorotool.read(path, page=1).values, values[::2, ::2])  # it can be asked for


def test_pages_beside_an_overview_are_pages(tmp_path):
    path = tmp_path / "pages.tif"
    with tifffile.TiffWriter(path) as file:
        for kind in (0, 1, 0):
            file.write(np.eye(9, dtype=np.uint8), photometric="minisblack", subfiletype=kind)
    refused(vorotool.InputError, "3 pages", vorotool.read, path)
