import io
import struct
import zlib

import numpy as np
import pytest
import tifffile
from numpy.typing import NDArray
from PIL import Image

from support.readers.sources import image_of
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import InputError, LimitError
from vorotool.formats.io.sources import Source
from vorotool.formats.recognition import image_format

LIMIT = 10**7


def read(name: str, data: bytes, **options: object) -> NDArray[np.generic]:
    return image_of(Source(name, data), **{"max_pixels": LIMIT, **options}).values


def chunk(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def plain_png(rows: NDArray[np.generic], depth: int, color_type: int, width: int, filter_type: int = 0) -> bytes:
    """A PNG from rows of packed bytes, unfiltered or with filter Sub."""
    data = np.ascontiguousarray(rows).view(np.uint8).reshape(len(rows), -1)
    if filter_type == 1:
        step = max(1, depth // 8 * {0: 1, 2: 3, 4: 2, 6: 4}[color_type])
        data = np.concatenate([data[:, :step], data[:, step:] - data[:, :-step]], axis=1)
    body = b"".join(bytes([filter_type]) + row.tobytes() for row in data)
    header = struct.pack(">IIBBBBB", width, len(rows), depth, color_type, 0, 0, 0)
    parts = chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(body)), chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


def saved(image: Image.Image, fmt: str, **options: object) -> bytes:
    return bytes_of(image.save, fmt, **options)


def tiff(*pages: NDArray[np.generic], **options: object) -> bytes:
    out = io.BytesIO()
    with tifffile.TiffWriter(out) as writer:
        for page in pages:
            writer.write(page, contiguous=False, **options)
    return out.getvalue()


GREY = np.random.default_rng(1).integers(0, 256, (6, 11), dtype=np.uint8)
RGB = np.random.default_rng(2).integers(0, 256, (6, 11, 3), dtype=np.uint8)


# ---- PNG


@pytest.mark.parametrize("depth", [1, 2, 4])
def test_png_small_grey_is_not_spread(depth: int) -> None:
    values = np.random.default_rng(depth).integers(0, 1 << depth, (5, 8), dtype=np.uint8)
    packed = np.zeros((5, depth), np.uint8)
    for x in range(8):
        packed[:, x * depth // 8] |= values[:, x] << np.uint8(8 - depth - x * depth % 8)
    found = read("a.png", plain_png(packed, depth, 0, 8))
    assert found.dtype == np.uint8
    np.testing.assert_array_equal(found, values)


@pytest.mark.parametrize("filter_type", [0, 1])
def test_png_16_bit_is_exact(filter_type: int) -> None:
    rng = np.random.default_rng(5)
    for color_type, channels in ((0, 1), (2, 3), (4, 2), (6, 4)):
        values = rng.integers(0, 65536, (6, 11, channels)).astype(np.uint16)
        data = plain_png(values.astype(">u2").reshape(6, -1), 16, color_type, 11, filter_type)
        found = read("a.png", data)
        assert found.dtype == np.uint16
        np.testing.assert_array_equal(found, values[:, :, 0] if channels == 1 else values)


def test_png_color_and_alpha() -> None:
    np.testing.assert_array_equal(read("a.png", saved(Image.fromarray(RGB), "PNG")), RGB)
    grey = Image.fromarray(GREY)
    for mode in ("L", "RGB", "RGBA", "LA"):
        np.testing.assert_array_equal(read("a.png", saved(grey.convert(mode), "PNG")), GREY)
    opaque = Image.fromarray(RGB).convert("RGBA")
    np.testing.assert_array_equal(read("a.png", saved(opaque, "PNG")), RGB)
    opaque.putpixel((3, 2), (1, 2, 3, 4))
    np.testing.assert_array_equal(read("a.png", saved(opaque, "PNG")), np.asarray(opaque))


def test_png_bomb_is_a_limit_at_once() -> None:
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 60_000, 60_000, 16, 2, 0, 0, 0))
    with pytest.raises(LimitError, match=r"bomb.png"):
        read("bomb.png", b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", b"x"), max_pixels=2**31)


def test_png_that_cannot_hold_its_pixels_takes_no_memory() -> None:
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 40_000, 40_000, 16, 2, 0, 0, 0))
    data = b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(b"0")) + chunk(b"IEND", b"")
    refused(InputError, "cannot hold 40000 x 40000 pixels", read, "a.png", data, max_pixels=2**31)


@pytest.mark.parametrize("depth", [8, 16])
def test_png_truncated_anywhere(depth: int) -> None:
    data = plain_png(GREY if depth == 8 else GREY.astype(">u2"), depth, 0, 11)
    for end in range(len(data)):
        refused(InputError, r"a.png", read, "a.png", data[:end])


def test_png_damaged_anywhere() -> None:
    data = plain_png(GREY, 8, 0, 11)
    for at in range(16, len(data) - 12):
        damaged = data[:at] + bytes([data[at] ^ 0x55]) + data[at + 1 :]
        refused((InputError, LimitError), r"a.png", read, "a.png", damaged)


def test_png_damaged_stream_with_right_checksums() -> None:
    body = zlib.compress(b"".join(b"\x00" + row.tobytes() for row in GREY))
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 11, 6, 8, 0, 0, 0, 0))
    for stream in (body[:20], b"\x78\x9c" + b"\xff" * 40, body[:5] + b"\x00\x00" + body[7:]):
        data = b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", stream) + chunk(b"IEND", b"")
        refused(InputError, r"a.png", read, "a.png", data)


# ---- PBM, PGM, PPM


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"P1\n# ink is 1\n3 2\n1 0 1\n0 1 0\n", [[1, 0, 1], [0, 1, 0]]),
        (b"P1 3 2 101010", [[1, 0, 1], [0, 1, 0]]),
        (b"P4\n10 2\n\xff\x40\x01\x80", [[1] * 8 + [0, 1], [0] * 7 + [1, 1, 0]]),
        (b"P2 2 2\n9 # largest\n1 2\n9 0\n", [[1, 2], [9, 0]]),
        (b"P2 2 1 300 299 1", [[299, 1]]),
        (b"P5 2 2 5\n\x00\x01\x05\x02", [[0, 1], [5, 2]]),
        (b"P5#c\n2#c\n 1#c\n1000\n\x03\xe8\x00\x07", [[1000, 7]]),
        (b"P3 1 1 255 1 2 3", [[[1, 2, 3]]]),
        (b"P6 1 1 255\n\x01\x02\x03", [[[1, 2, 3]]]),
        (b"P6 1 1 255\n\x07\x07\x07", [[7]]),
    ],
)
def test_pnm_values_are_as_stored(data: bytes, expected: list[object]) -> None:
    for name in ("-", "a.pgm"):
        found = read(name, data)
        assert found.tolist() == expected
        assert found.dtype == (np.uint16 if found.max() > 255 else np.uint8)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"P5 2 2 255\n\x00\x01\x02", "cut off: its pixels need 4 bytes, it has 3"),
        (b"P4 9 2\n\x00\x01\x02", "cut off"),
        (b"P2 2 2 255 1 2 3", "cut off: it has 3 of 4 values"),
        (b"P1 2 2 1 0 1", "cut off: it has 3 of 4 values"),
        (b"P2 2 2 255 1 2 x 3", "value 3"),
        (b"P2 2 2 255 1 2 -3 3", "value 3"),
        (b"P2 2 2 9 1 2 10 3", "10 in row 1, column 0"),
        (b"P1 2 2 1 0 2 0", "2 in row 1, column 0"),
        (b"P5 2 2 70000\n\x00\x01\x02", "70000"),
        (b"P5 2 2 0\n\x00\x01\x02", "states 0 as the largest value"),
        (b"P5 2 ", "no complete PBM, PGM or PPM header"),
        (b"P5 0 2 255\n", "is 0 x 2 pixels"),
    ],
)
def test_pnm_damaged(data: bytes, message: str) -> None:
    refused(InputError, [message, "a.pgm"], read, "a.pgm", data)


# ---- NPY


@pytest.mark.parametrize("dtype", ["?", "u1", ">u2", "u4", "i8", "f4", "f8"])
def test_npy(dtype: str) -> None:
    values = np.arange(12).reshape(3, 4).astype(dtype)
    np.testing.assert_array_equal(read("a.npy", bytes_of(np.save, values)), values)


# ---- TIFF


@pytest.mark.parametrize("dtype", ["u1", "u2", "u4", "i4", "f4", "u8", ">u2"])
@pytest.mark.parametrize("options", [{}, {"compression": "zlib"}, {"tile": (16, 16)}])
def test_tiff(dtype: str, options: dict[str, object]) -> None:
    values = (np.arange(40 * 50).reshape(40, 50) % 251).astype(dtype)
    np.testing.assert_array_equal(read("a.tif", tiff(values, **options)), values)


def test_tiff_color_alpha_planar_and_bilevel() -> None:
    np.testing.assert_array_equal(read("a.tif", tiff(RGB, photometric="rgb")), RGB)
    planar = tiff(np.moveaxis(RGB, 2, 0), photometric="rgb", planarconfig="separate")
    np.testing.assert_array_equal(read("a.tif", planar), RGB)
    rgba = np.dstack([RGB, np.full(GREY.shape, 255, np.uint8)])
    np.testing.assert_array_equal(read("a.tif", tiff(rgba, photometric="rgb", extrasamples=[2])), RGB)
    found = read("a.tif", tiff(GREY > 100))
    assert found.dtype == np.uint8
    np.testing.assert_array_equal(found, GREY > 100)


@pytest.mark.parametrize("compression", ["tiff_lzw", "packbits", "tiff_adobe_deflate"])
@pytest.mark.parametrize("array", [GREY, RGB, GREY.astype(np.uint16) * 250])
def test_tiff_compressions_of_others(compression: str, array: NDArray[np.generic]) -> None:
    data = saved(Image.fromarray(array), "TIFF", compression=compression)
    np.testing.assert_array_equal(read("a.tif", data), array)


def test_tiff_pages() -> None:
    pages = [GREY, GREY[::-1], GREY[:, :5]]
    data = tiff(*pages)
    for number, page in enumerate(pages):
        np.testing.assert_array_equal(read("a.tif", data, page=number), page)
    refused(InputError, r"a.tif", read, "a.tif", data)
    for number in (3, -1):
        refused(InputError, f"page={number}", read, "a.tif", data, page=number)
    refused(InputError, "single page", read, "a.pgm", b"P2 1 1 9 1", page=1)


@pytest.mark.parametrize("options", [{}, {"compression": "zlib"}])
def test_tiff_truncated_anywhere(options: dict[str, object]) -> None:
    data = tiff(GREY, metadata=None, software=False, **options)
    for end in range(len(data) - 2):
        try:
            found = read("a.tif", data[:end])
        except InputError as error:
            assert "a.tif" in str(error)  # noqa: PT017
        else:  # only padding was cut
            np.testing.assert_array_equal(found, GREY)


def test_tiff_damaged_anywhere() -> None:
    data = tiff(GREY, compression="zlib", metadata=None, software=False)
    for at in range(4, len(data)):
        damaged = data[:at] + bytes([data[at] ^ 0x55]) + data[at + 1 :]
        try:
            read("a.tif", damaged)
        except (InputError, LimitError) as error:
            assert "a.tif" in str(error)  # noqa: PT017


# ---- which format


@pytest.mark.parametrize(
    ("name", "data", "expected"),
    [
        ("-", b"\x89PNG\r\n\x1a\n", True),
        ("-", b"II*\x00", True),
        ("-", b"MM\x00*", True),
        ("-", b"II+\x00", True),
        ("-", b"P1 2 2 1 0 1 0", True),
        ("-", b"P5\n# made by hand\n2 2 9 ", True),
        ("-", b"P7 1 2", False),
        ("-", b"P1,P2\n1,2\n", False),
        ("a.PNG", b"?", True),
        ("a.jpg", b"?", True),
        ("a.csv", b"1,2\n", False),
        ("-", b"", False),
    ],
)
def test_is_image(name: str, data: bytes, expected: bool) -> None:
    assert (image_format(Source(name, data)) is not None) is expected


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("a.png", b"", "a.png is empty"),
        ("a.png", b"II*\x00", "a.png"),
        ("a.jpg", b"\xff\xd8\xff\xe0", "a.jpg"),
        ("a.jpg", b"hello", "a.jpg"),
        ("-", b"GIF89a", "GIF"),
        ("a.dat", b"hello", "a.dat"),
    ],
)
def test_files_that_are_no_such_image(name: str, data: bytes, message: str) -> None:
    refused(InputError, message, read, name, data)
