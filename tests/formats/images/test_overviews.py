"""Pages of TIFF files: overviews and masks of an image are none."""

import numpy as np
import pytest
import tifffile
from PIL import Image

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


@pytest.mark.parametrize(
    ("options", "is_volume"),
    [
        ({"imagej": True, "metadata": {"axes": "ZYX"}}, True),
        ({"metadata": None}, True),
        ({"imagej": True, "metadata": {"axes": "CYX"}}, False),
        ({"imagej": True, "metadata": {"axes": "TYX"}}, False),
        ({"ome": True, "metadata": {"axes": "TYX"}}, False),
        ({"ome": True, "metadata": {"axes": "ZYX"}}, True),
    ],
)
def test_pages_are_only_called_a_volume_where_they_are_read_as_one(tmp_path, options, is_volume):
    path = tmp_path / "pages.tif"
    tifffile.imwrite(path, np.zeros((3, 8, 9), np.uint8), photometric="minisblack", **options)
    message = str(refused(vorotool.InputError, "3 pages", vorotool.read, path))
    assert ("volume" in message) == is_volume
    if is_volume:
        assert vorotool.read(path, geometry="volume").shape == (3, 8, 9)
    else:
        refused(vorotool.InputError, "", vorotool.read, path, geometry="volume")


def test_an_image_that_follows_another_is_no_slice(tmp_path):
    path = tmp_path / "two.tif"
    for side in (8, 5):
        tifffile.imwrite(path, np.zeros((side, 9), np.uint8), append=side == 5)
    assert "volume" not in str(refused(vorotool.InputError, "2 pages", vorotool.read, path))
    message = refused(vorotool.InputError, "states 1 slice", vorotool.read, path, geometry="volume")
    assert "page=N" in str(message)


# ---- 0 is shown as white


@pytest.mark.parametrize("compression", ["raw", "group4", "packbits"])
def test_stored_values_are_read_where_0_is_shown_as_white(tmp_path, compression):
    values = np.eye(9, dtype=bool)
    path = tmp_path / "mask.tif"
    Image.fromarray(~values).save(path, compression=compression, tiffinfo={262: 0})  # Pillow is given what is seen
    notes = []
    assert np.array_equal(vorotool.read(path, note=notes.append).values, values)
    assert "WhiteIsZero" in notes[0]
    assert "invert=True" in notes[0]
