"""JPEG, BMP, GIF, WebP and AVIF: what Pillow shows of them, limits, damage."""

import io

import numpy as np
import pytest
from PIL import Image, ImageOps, features

from support.few import few
from support.readers.sources import image_of, picture_of
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool import InputError, LimitError
from vorotool.formats.io.sources import Source

RNG = np.random.default_rng(5)
GREY = RNG.integers(0, 256, (7, 11), dtype=np.uint8)
COLORS = RNG.integers(0, 256, (7, 11, 3), dtype=np.uint8)
SMOOTH = np.add.outer(np.arange(40) * 4, np.arange(60) * 2).astype(np.uint8)
COLOR = np.dstack([SMOOTH, 255 - SMOOTH, SMOOTH // 2])
KINDS = ["jpeg", "bmp", "gif", "webp"] + ["avif"] * ("avif" in features.get_supported())
ORIENTATION = 274


def saved(image, kind, **options):
    image = image if isinstance(image, Image.Image) else Image.fromarray(image)
    return bytes_of(image.save, kind.upper(), **options)


def source(data, name="a"):
    return Source(name, data)


def read(data, **options):
    return image_of(source(data), **options).values


def pillow(data):
    return np.asarray(Image.open(io.BytesIO(data)))


@pytest.mark.parametrize("kind", ["bmp", "webp"])
def test_values_of_exact_formats_are_as_stored(kind):
    options = {"lossless": True} if kind == "webp" else {}
    raster = image_of(source(saved(COLORS, kind, **options)))
    np.testing.assert_array_equal(raster.values, COLORS)
    assert not raster.is_lossy
    np.testing.assert_array_equal(read(saved(GREY, kind, **options)), GREY)  # what is grey has one channel


@pytest.mark.parametrize("kind", ["jpeg", *KINDS[3:]])
def test_lossy_formats_are_what_pillow_shows(kind):
    data = saved(COLORS, kind)
    raster = image_of(source(data))
    np.testing.assert_array_equal(raster.values, pillow(data))
    assert raster.is_lossy
    np.testing.assert_array_equal(picture_of(source(data)), pillow(data))


def test_what_a_gif_leaves_free_is_transparent():
    image = Image.fromarray(GREY % 3)
    image.putpalette([250, 0, 0, 0, 240, 0, 0, 0, 230])
    data = saved(image, "gif", transparency=1)
    np.testing.assert_array_equal(read(data)[:, :, 3], np.where(GREY % 3 == 1, 0, 255))
    assert (picture_of(source(data))[GREY % 3 == 1] == 255).all()  # on white


@pytest.mark.parametrize("kind", ["jpeg", *KINDS[3:]])
@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("values", few([COLOR, SMOOTH], 1), ids=["color", "grey"])
def test_pictures_are_upright(kind, orientation, values):
    exif = Image.Exif()
    exif[ORIENTATION] = orientation
    data = saved(values, kind, exif=exif)
    expected = np.asarray(ImageOps.exif_transpose(Image.open(io.BytesIO(data))))
    found = read(data)
    np.testing.assert_array_equal(found, expected if found.ndim == expected.ndim else expected[:, :, 0])


@pytest.mark.parametrize("kind", ["gif", "webp"])
def test_of_an_animation_the_first_picture_is_read_which_is_said(kind):
    frames = [Image.fromarray(np.full((6, 9), value, np.uint8)) for value in (10, 90, 200)]
    options = {"lossless": True} if kind == "webp" else {}
    data = saved(frames[0], kind, save_all=True, append_images=frames[1:], **options)
    notes = []
    assert (read(data, note=notes.append) == 10).all()
    assert notes == ["a has 3 pictures: the first one is read; choose another with page=..."]
    assert (read(data, page=2, note=notes.append) == 200).all()
    assert len(notes) == 1
    for page in (3, -1):
        refused(InputError, f"page={page}", read, data, page=page)
    refused(InputError, "page=1", read, saved(GREY, kind), page=1)


@pytest.mark.parametrize("kind", KINDS)
def test_pixels_are_counted_before_they_are_decoded(kind):
    data = saved(GREY, kind)
    refused(LimitError, r"max_pixels=76", read, data, max_pixels=76)
    assert read(data, max_pixels=77).shape[:2] == (7, 11)


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_cut_off_is_refused(kind):
    data = saved(COLORS, kind)
    for end in {*range(1, 60), *range(60, len(data) - 2, 7), len(data) // 2}:
        refused(InputError, r"^a.img ", image_of, source(data[:end], "a.img"), input_format=kind)


@pytest.mark.parametrize("kind", few(KINDS, 3))
def test_what_is_damaged_is_read_or_refused(kind):
    data = saved(COLORS, kind)
    for _ in range(200):
        damaged = bytearray(data)
        for at in RNG.integers(0, len(data), 3):
            damaged[at] = RNG.integers(0, 256)
        try:
            image_of(source(bytes(damaged), "a.img"), input_format=kind, max_pixels=10**6)
        except (InputError, LimitError) as error:
            assert str(error).startswith("a.img")  # noqa: PT017
