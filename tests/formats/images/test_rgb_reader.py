"""Images as they look."""

import io

import numpy as np
import pytest
import tifffile
from PIL import Image

from support.readers.sources import picture_of
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import InputError
from vorotool.formats.io.sources import Source

RANDOM = np.random.default_rng(0)
COLORS = RANDOM.integers(0, 256, (5, 7, 3), dtype=np.uint8)
GREY = RANDOM.integers(0, 256, (5, 7), dtype=np.uint8)


def png(image, **options):
    image = image if isinstance(image, Image.Image) else Image.fromarray(image)
    return Source("a.png", bytes_of(image.save, "PNG", **options))


def tiff(*pages):
    out = io.BytesIO()
    with tifffile.TiffWriter(out) as writer:
        for page in pages:
            writer.write(page, contiguous=False, photometric="minisblack")
    return Source("a.tif", out.getvalue())


def test_palettes_have_their_colors():
    palette = Image.fromarray(COLORS).quantize(16)
    assert np.array_equal(picture_of(png(palette)), np.asarray(palette.convert("RGB")))


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        (np.array([[0, 1]], dtype=np.uint8), [0, 255]),
        (np.array([[0, 500, 1000]], dtype=np.uint16), [0, 128, 255]),
        (np.array([[-1.0, 1.0, np.nan]], dtype=np.float32), [0, 255, 128]),
        (np.array([[9, 9]], dtype=np.uint16), [0, 0]),
    ],
)
def test_others_are_spread(values, expected):
    assert picture_of(tiff(values))[0, :, 0].tolist() == expected


def test_what_is_transparent_lies_on_white():
    values = np.array([[[10, 20, 30, 255], [10, 20, 30, 0], [0, 0, 0, 51]]], dtype=np.uint8)
    assert picture_of(png(values)).tolist() == [[[10, 20, 30], [255, 255, 255], [204, 204, 204]]]
    assert picture_of(png(values[:, :, 2:])).tolist() == [[[30, 30, 30], [255, 255, 255], [204, 204, 204]]]


def test_pages():
    stack = tiff(GREY, GREY // 2)
    assert np.array_equal(picture_of(stack, page=1)[:, :, 0], GREY // 2)
    refused(InputError, "2 pages", picture_of, stack)
    assert np.array_equal(picture_of(tiff(GREY), page=3)[:, :, 0], GREY)  # a page of the other input
