"""What the tags of a TIFF say is checked before a pixel is decoded, whole or band by band."""

import zlib

import numpy as np
import pytest
import tifffile
from PIL import Image

import vorotool
from support.families.tiff_files import LONG, SHORT, grey, tiff_file
from support.few import few
from support.readers.sources import bands_of
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import InputError, LimitError
from vorotool.formats.images.tiff_layout import decode_rows

ROWS = bytes(range(60))  # 6 rows of 10 pixels


def check_refused(tmp_path, data, words, error=InputError):
    path = tmp_path / "a.tif"
    path.write_bytes(data)
    refused(error, [words, "a.tif"], vorotool.read, path)
    refused(error, words, whole_by_rows, path)


def whole_by_rows(path):
    rows = bands_of(path)
    return rows.rows(0, rows.shape[0])


def accepted(tmp_path, data, expected):
    path = tmp_path / "a.tif"
    path.write_bytes(data)
    np.testing.assert_array_equal(vorotool.read(path).values, expected)
    rows = bands_of(path)
    for first in range(len(expected)):
        np.testing.assert_array_equal(rows.rows(first, 1), expected[first : first + 1])
    return rows


def test_strips_in_any_order(tmp_path):
    strips = [ROWS[:20], ROWS[20:40], ROWS[40:]]
    expected = np.frombuffer(ROWS, np.uint8).reshape(6, 10)
    accepted(tmp_path, tiff_file(grey(10, 6, 2), strips), expected)
    backwards = grey(10, 6, 2) | {273: (LONG, [48, 28, 8]), 279: (LONG, [20, 20, 20])}
    accepted(tmp_path, tiff_file(backwards, strips), expected[[4, 5, 2, 3, 0, 1]])


def test_an_endless_image_without_strips(tmp_path):
    check_refused(tmp_path, tiff_file(grey(32, 577_990_168), []), "needs 1 strip, but there are offsets of 0")
    data = tiff_file(grey(32, 577_990_168, 16), [ROWS])
    check_refused(tmp_path, data, "needs 36124386 strips, but there are offsets of 1")


def test_what_is_left_out_is_background(tmp_path):
    strips = [ROWS[:20], b"", ROWS[40:]]
    expected = np.frombuffer(ROWS, np.uint8).reshape(6, 10).copy()
    expected[2:4] = 0
    accepted(tmp_path, tiff_file(grey(10, 6, 2), strips, left_out=[1]), expected)
    expected[2:4] = 7
    nodata = {42113: (2, [ord("7"), 0])}
    accepted(tmp_path, tiff_file(grey(10, 6, 2) | nodata, strips, left_out=[1]), expected)
    check_refused(tmp_path, tiff_file(grey(10, 6, 2), strips, left_out=[0, 1, 2]), "all of its 3 strips are empty")
    check_refused(tmp_path, tiff_file(grey(10, 6, 2), strips), "strip 1 has 0 bytes at byte 28")
    torn = tiff_file(grey(10, 6, 2), strips, left_out=[1], counts=[20, 20, 20])
    check_refused(tmp_path, torn, "strip 1 has 20 bytes at byte 0")


def test_strips_shorter_than_their_rows(tmp_path):
    data = tiff_file(grey(10, 6, 2), [ROWS[:20], ROWS[20:40], ROWS[40:]], counts=[20, 19, 20])
    check_refused(tmp_path, data, "strip 1 has 19 bytes, but its rows need more")
    packed = [zlib.compress(ROWS[:20]), zlib.compress(ROWS[20:39]), zlib.compress(ROWS[40:])]
    data = tiff_file(grey(10, 6, 2, compression=8), packed)
    check_refused(tmp_path, data, "strip 1 has 19 bytes, but its 2 rows need 20")
    cut = [packed[0], zlib.compress(ROWS[20:40])[:-6], packed[2]]
    check_refused(tmp_path, tiff_file(grey(10, 6, 2, compression=8), cut), "compressed data end too early")
    few = grey(100_000, 20_000, compression=8)
    check_refused(tmp_path, tiff_file(few, [zlib.compress(b"0")]), "strip 0 has 9 bytes, which cannot hold its pixels")


@pytest.mark.parametrize(
    ("tag", "value", "words"),
    [
        (256, (1, [10, 0]), "its ImageWidth has 2 values of type 1, which are not one integer"),
        (256, (7, [10]), "its ImageWidth has 1 values of type 7, which are not one integer"),
        (257, (LONG, [6, 6]), "its ImageLength has 2 values of type 4"),
        (257, (12, [6.0]), "its ImageLength has 1 values of type 12"),
        (32997, (2, [1] * 2000), "2000"),
        (256, (LONG, [0]), "is 0 x 6 pixels: an image needs at least 1 x 1"),
        (278, (LONG, [0]), "its RowsPerStrip is 0"),
        (277, (SHORT, [0]), "its SamplesPerPixel is 0"),
        (277, (SHORT, [1, 1]), "its SamplesPerPixel has 2 values of type 3"),
        (273, (12, [8.0]), "the offsets of its strips or tiles are"),
        (273, (2, [8, 0]), "the offsets of its strips or tiles are"),
        (32997, (LONG, [3]), "is a volume 3 deep"),
    ],
)
def test_tags_that_are_no_such_numbers(tmp_path, tag, value, words):
    check_refused(tmp_path, tiff_file(grey(10, 6) | {tag: value}, [ROWS]), words)


def test_tiles_out_of_proportion(tmp_path):
    tags = {code: value for code, value in grey(8, 8, compression=8).items() if code != 278}
    data = tiff_file(tags | {322: 2**17, 323: 2**17}, [zlib.compress(bytes(2**20))], is_tiled=True)
    check_refused(tmp_path, data, "tiles of 131072 x 131072 pixels for an image of 8 x 8")


def test_more_values_a_pixel_than_an_image_has(tmp_path):
    (tmp_path / "a.tif").write_bytes(tiff_file(grey(10, 6) | {277: (SHORT, [60_000])}, [bytes(60 * 60_000)]))
    with pytest.raises(LimitError, match="60000 values per pixel: with 10 x 6 pixels these are more than 4 x"):
        vorotool.read(tmp_path / "a.tif", max_pixels=10**5)


def test_a_file_without_an_image(tmp_path):
    (tmp_path / "a.tif").write_bytes(b"II*\0\0\0\0\0")
    for page in (None, 0, 1):
        refused(InputError, r"a\.tif", vorotool.read, tmp_path / "a.tif", page=page)


def test_bits_in_reverse(tmp_path):
    expected = np.frombuffer(ROWS, np.uint8).reshape(6, 10)
    reverse = bytes(int(f"{byte:08b}"[::-1], 2) for byte in range(256))
    for compression, strip in ((1, ROWS), (8, zlib.compress(ROWS))):
        tags = grey(10, 6, compression=compression) | {266: (SHORT, [2])}
        accepted(tmp_path, tiff_file(tags, [strip.translate(reverse)]), expected)


@pytest.mark.parametrize("dtype", few(["u2", "f4", "u1", "i4", "u8", "f8"], 2))
@pytest.mark.parametrize("byteorder", ["<", ">"])
@pytest.mark.parametrize("tile", [None, (16, 32)])
def test_predictors(tmp_path, dtype, byteorder, tile):
    image = np.random.default_rng(4).integers(0, 100, (37, 41)).astype(dtype)
    if dtype[0] == "f":
        image /= 3
        parts = np.ascontiguousarray(image.astype(">" + dtype)).view(np.uint8).reshape(37, 41, -1)
        planes = np.moveaxis(parts, 2, 1).reshape(37, -1)
        stored = zlib.compress(np.diff(planes, axis=1, prepend=np.uint8(0)).astype(np.uint8).tobytes())
        tags = grey(41, 37, bits=8 * image.itemsize, compression=8) | {317: (SHORT, [3]), 339: (SHORT, [3])}
        accepted(tmp_path, tiff_file(tags, [stored]), image)
        return
    options = {"byteorder": byteorder, "compression": "zlib", "predictor": 2, "tile": tile}
    accepted(tmp_path, bytes_of(tifffile.imwrite, image, **options), image)


@pytest.mark.parametrize("side", [40, 3000])
def test_a_jpeg_larger_than_its_strip(tmp_path, side):
    packed = bytes_of(Image.fromarray(np.zeros((side, side), np.uint8)).save, "JPEG")
    (tmp_path / "a.tif").write_bytes(tiff_file(grey(8, 8, compression=7), [packed]))
    refused(InputError, f"{side}", vorotool.read, tmp_path / "a.tif")
    (tmp_path / "a.tif").write_bytes(tiff_file(grey(side, side, compression=7), [packed]))
    assert vorotool.read(tmp_path / "a.tif").values.shape == (side, side)


def test_rows_of_a_strip_are_read_alone(tmp_path):
    tifffile.imwrite(tmp_path / "a.tif", np.zeros((1000, 900), np.uint16))
    rows = bands_of(tmp_path / "a.tif")
    image = np.arange(900_000, dtype=np.uint16).reshape(1000, 900)
    tifffile.imwrite(tmp_path / "a.tif", image)  # what is read now was not read before
    np.testing.assert_array_equal(rows.rows(500, 3), image[500:503])
    read = []
    layout = rows._layout

    def pieces(offset, size):
        read.append(size)
        return bytes(size)

    decode_rows(layout, pieces, 10, 2)
    assert read == [2 * 900 * 2]
