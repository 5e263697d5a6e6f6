"""Images that pass by give the tessellation of images that are held, whatever the bands."""

import pickle
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from scipy import ndimage

from support.few import few
from support.processes.heard_signals import stop
from vorotool.engines.tessellation.raster_objects import PartwiseObjects
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.engines.tessellation.streamed_image import StreamedImage
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import InputError, LimitError, VorotoolWarning
from vorotool.types.pixels import PixelSides

rng = np.random.default_rng(7)


@dataclass
class Held:
    """An image in memory that is asked for in rows."""

    values: Any

    @property
    def shape(self):
        return self.values.shape

    def rows(self, first, count):
        return self.values[first : first + count]


def blobs(shape, share):
    return ndimage.gaussian_filter(rng.random(shape), 2) > np.quantile(
        ndimage.gaussian_filter(rng.random(shape), 2), share
    )


def images():
    yield "noise", rng.random((31, 27)) < 0.3
    yield "dense", rng.random((31, 27)) < 0.8
    yield "sparse", rng.random((50, 40)) < 0.005
    yield "blobs", blobs((48, 36), 0.7)
    yield "one pixel", np.pad([[1]], ((40, 9), (3, 30)))
    yield "a full row", np.pad(np.ones((1, 33), np.uint8), ((20, 20), (0, 0)))
    yield "a column", np.pad(np.ones((50, 1), np.uint8), ((0, 0), (9, 9)))
    yield "all", np.ones((9, 12), np.uint8)
    yield "narrow", rng.random((200, 1)) < 0.1
    yield "wide", rng.random((1, 200)) < 0.1
    spiral = np.zeros((41, 41), bool)
    for k in range(0, 20, 2):
        spiral[k, k : 41 - k] = spiral[k : 41 - k, 40 - k] = spiral[40 - k, k : 41 - k] = spiral[k + 2 : 41 - k, k] = 1
    yield "spiral", spiral


IMAGES = list(images())


def streamed(source, what, dtype, heights, limit=None, threads=1):
    image = StreamedImage(source)
    made, first = [], 0
    while first < image.frame.height:
        rows = min(heights[len(made) % len(heights)], image.frame.height - first)
        band = pickle.loads(pickle.dumps(image.band(what, dtype, first, rows, limit)))
        made.append(band.rows(threads=threads))
        first += rows
    return np.concatenate(made)


BANDS = {"whole": (10**9, 10**9), "bands": (300, 130), "rows": (1, 1)}
"""Pixels of the bands that are read, and of the pieces that are labelled."""


@pytest.fixture(params=BANDS)
def bands(request, monkeypatch):
    read, labelled = BANDS[request.param]
    monkeypatch.setattr("vorotool.engines.tessellation.streamed_image.BAND_PIXELS", read)
    monkeypatch.setattr("vorotool.engines.tessellation.streamed_image.SWEEP_PIXELS", labelled)


MODES = [("components", 8), ("components", 4), ("pixels", 8)]
CASES = [
    (name, mask, *MODES[(k + i + turn) % 3], bands)
    for images in (IMAGES[:4], IMAGES[4:])
    for turn in range(3)
    for k, (name, mask) in enumerate(images)
    for i, bands in enumerate(BANDS)
]


@pytest.mark.parametrize(
    ("name", "mask", "mode", "connectivity", "bands"), few(CASES, 4 * len(BANDS)), indirect=["bands"]
)
def test_masks(name, mask, mode, connectivity, bands):
    values = mask.astype(np.uint8)
    seeds = seeds_from_raster(values, mode=mode, connectivity=connectivity)
    whole = Tessellator(seeds, max_distance=8)
    source = PartwiseObjects(Held(values), mode, connectivity)
    for what, expected in (("labels", whole.labels()), ("distance", whole.distances())):
        for heights in ([1000], [7, 1, 16]) if what == "labels" else ([7, 1, 16],):
            found = streamed(source, what, expected.dtype, heights, 8 if what == "labels" else None)
            np.testing.assert_array_equal(found, expected, f"{name}, {what}")
    squares = whole.squared_distances()
    assert StreamedImage(source).square_dtype == squares.dtype
    np.testing.assert_array_equal(streamed(source, "distance2", squares.dtype, [30]), squares)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.int64, np.float32])
def test_rectangular_pixels(bands, dtype):
    labels = ndimage.label(blobs((80, 60), 0.6))[0].astype(dtype)
    sides = PixelSides((60, 13), Fraction(1, 40))
    whole = Tessellator(seeds_from_raster(labels), max_distance=2, sides=sides)
    image = StreamedImage(PartwiseObjects(Held(labels)), sides=sides)
    assert image.square_dtype == whole.square_dtype
    for what, expected in (("labels", whole.labels()), ("distance2", whole.squared_distances())):
        found = [image.band(what, expected.dtype, first, 16, 2).rows(threads=1) for first in range(0, 80, 16)]
        np.testing.assert_array_equal(np.concatenate(found), expected)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.int64, np.float32])
def test_label_images(bands, dtype):
    labels = ndimage.label(blobs((80, 60), 0.6))[0].astype(dtype)
    labels[labels == 3] = 2  # one label of two pieces
    whole = Tessellator(seeds_from_raster(labels))
    source = PartwiseObjects(Held(labels))
    assert source.kind() == "labels"
    np.testing.assert_array_equal(streamed(source, "labels", np.dtype(np.uint16), [9]), whole.labels())


def test_threshold_and_inversion(bands):
    grey = rng.integers(0, 200, (50, 40)).astype(np.uint8)
    for options in ({"threshold": 180}, {"threshold": 20, "invert": True}, {"invert": True}):
        expected = Tessellator(seeds_from_raster(grey, **options)).labels()
        found = streamed(PartwiseObjects(Held(grey), **options), "labels", expected.dtype, [11])
        np.testing.assert_array_equal(found, expected)


def test_what_shares_a_label_is_found_out():
    def mode(values):
        return PartwiseObjects(Held(np.array(values))).kind()

    assert mode([[0, 1], [1, 0]]) == "components"
    assert mode([[0, 0], [0, 0]]) == "components"
    assert mode([[0, 7], [7, 0]]) == "labels"
    assert mode([[0, 7], [8, 0]]) == "labels"
    assert mode([[7, 7], [7, 7]]) == "labels"
    assert mode([[7, 7], [8, 8]]) == "labels"
    with pytest.raises(InputError, match="a photograph"):
        PartwiseObjects(Held(rng.integers(0, 200, (90, 90)))).kind()


VALUES, TYPES = [1, 7, 255, 65535], [np.uint8, np.uint16, np.int32, np.float32]
SINGLE = [(value, TYPES[(k + turn) % 4]) for turn in range(4) for k, value in enumerate(VALUES)]


@pytest.mark.parametrize(("value", "dtype"), few(SINGLE, 4))
def test_one_value_is_a_mask_or_a_label_as_in_memory(bands, value, dtype):
    if value > 255 and dtype == np.uint8:
        value = 254
    values = np.where(blobs((40, 30), 0.6), value, 0).astype(dtype)
    told, heard = [], []
    seeds = seeds_from_raster(values, note=heard.append)
    source = PartwiseObjects(Held(values))
    StreamedImage(source, note=told.append)
    assert told == heard
    np.testing.assert_array_equal(streamed(source, "labels", np.dtype(np.uint32), [9]), Tessellator(seeds).labels())


def test_without_foreground_all_labels_are_0(bands):
    source = PartwiseObjects(Held(np.zeros((30, 20), np.uint16)))
    with pytest.warns(VorotoolWarning, match="no foreground"):
        image = StreamedImage(source)
    band = pickle.loads(pickle.dumps(image.band("labels", np.dtype(np.uint16), 3, 20, 5)))
    assert band.rows().tolist() == np.zeros((20, 20)).tolist()
    for refused in (lambda: image.band("distance", np.dtype(np.float32), 0, 30), lambda: image.square_dtype):
        with pytest.raises(InputError, match="no foreground"):
            refused()


def test_what_is_refused(bands):
    with pytest.raises(InputError, match="no foreground"):
        StreamedImage(PartwiseObjects(Held(np.zeros((30, 20), np.uint8))), strict=True)
    noise = Held((rng.random((40, 40)) < 0.3).astype(np.uint8))
    for mode in ("pixels", "components"):
        with pytest.raises(LimitError, match="more than max_sites=5"):
            StreamedImage(PartwiseObjects(noise, mode), max_sites=5)
    bad = np.zeros((30, 20), np.int64)
    bad[29, 3] = -1
    with pytest.raises(InputError, match="the value -1 in row 29, column 3"):
        StreamedImage(PartwiseObjects(Held(bad), "labels"))
    with pytest.raises(InputError, match="NaN"):
        StreamedImage(PartwiseObjects(Held(np.full((30, 20), np.nan))))


def test_progress_is_told_and_stops():
    told = []
    mask = Held((rng.random((40, 40)) < 0.3).astype(np.uint8))
    image = StreamedImage(PartwiseObjects(mask), reading=told.append)
    image.band("labels", np.dtype(np.uint16), 10, 20).rows(progress=told.append)
    assert told == [1.0, 1.0]

    with pytest.raises(KeyboardInterrupt):
        StreamedImage(PartwiseObjects(mask), reading=stop)
