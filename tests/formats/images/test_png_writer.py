import io
import itertools
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from support.few import few
from support.processes.peak_memory import memory_below
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import LimitError
from vorotool.formats.images.png_writer import write_png

SHAPES = [(1, 1), (1, 17), (13, 1), (3, 7), (5, 8), (4, 9), (31, 33)]


def png(bands: object, shape: tuple[int, int], **options: object) -> bytes:
    return bytes_of(write_png, bands, shape, **options)


def read_back(data: bytes) -> NDArray[np.generic]:
    with Image.open(io.BytesIO(data)) as image:
        image.verify()
    with Image.open(io.BytesIO(data)) as image:
        return np.asarray(image)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("bit_depth", few([1, 8, 16, 2, 4], 3))
def test_grey_is_read_back_by_pillow(shape: tuple[int, int], bit_depth: int) -> None:
    values = np.random.default_rng(3).integers(0, 1 << bit_depth, shape).astype(np.uint16)
    found = read_back(png([values], shape, bit_depth=bit_depth)).astype(np.uint16)
    step = {2: 85, 4: 17}.get(bit_depth, 1)  # Pillow spreads these over 0..255
    np.testing.assert_array_equal(found, values * step)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("bit_depth", "colors"), few([(1, 2), (4, 16), (8, 256), (2, 3), (8, 1)], 3))
def test_palette_is_read_back_by_pillow(shape: tuple[int, int], bit_depth: int, colors: int) -> None:
    rng = np.random.default_rng(4)
    palette = rng.integers(0, 256, (colors, 3), dtype=np.uint8)
    values = rng.integers(0, colors, shape).astype(np.uint8)
    data = png([values], shape, bit_depth=bit_depth, palette=palette)
    with Image.open(io.BytesIO(data)) as image:
        assert image.mode == "P"
        np.testing.assert_array_equal(np.asarray(image), values)
        np.testing.assert_array_equal(np.asarray(image.convert("RGB")), palette[values])


def test_bytes_depend_on_pixels_alone() -> None:
    shape = (300, 2000)  # two blocks, of 262 rows and of the others
    values = np.random.default_rng(5).integers(0, 4, shape).astype(np.uint16)
    expected = png([values], shape, threads=1)
    np.testing.assert_array_equal(read_back(expected), values)
    cuts = [[0, 300], list(range(301)), [0, 261, 263, 300], [0, 0, 150, 150, 300]]
    for cut, threads in itertools.product(cuts, (0, 1, 2, 5)):
        bands = [values[a:b].astype(np.int32) for a, b in itertools.pairwise(cut)]
        assert png(bands, shape, threads=threads) == expected


@pytest.mark.parametrize(
    ("value", "options", "message"),
    [
        (65_536, {}, "value 65536"),
        (-1, {}, "the value -1 does not fit"),
        (2, {"bit_depth": 1}, "value 2"),
        (16, {"bit_depth": 4}, "value 16"),
        (3, {"bit_depth": 8, "palette": np.zeros((3, 3), np.uint8)}, "a palette of 3 colors"),
    ],
)
def test_nothing_is_wrapped(value: int, options: dict[str, object], message: str) -> None:
    refused(LimitError, message, png, [np.array([[0, value]])], (1, 2), **options)


@pytest.mark.parametrize(
    "options",
    [
        {"bit_depth": 3},
        {"bit_depth": 16, "palette": np.zeros((3, 3), np.uint8)},
        {"bit_depth": 1, "palette": np.zeros((3, 3), np.uint8)},
        {"bit_depth": 8, "palette": np.zeros((3, 4), np.uint8)},
    ],
)
def test_impossible_kinds_are_refused(options: dict[str, object]) -> None:
    refused(ValueError, r"bit|palette", png, [np.zeros((1, 1), np.uint8)], (1, 1), **options)


def test_memory_stays_bounded() -> None:
    shape = (4096, 8192)  # 64 MB of pixels
    band = np.arange(64 * 8192, dtype=np.uint16).reshape(64, 8192) // 50
    with Path("/dev/null").open("wb") as out, memory_below(40e6):
        write_png(out, (band for _ in range(64)), shape)


@pytest.mark.parametrize("threads", [1, 2])
def test_red_green_and_blue(threads: int) -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (300, 17, 3)).astype(np.uint8)
    bands = [pixels[:100].reshape(100, -1), pixels[100:].reshape(200, -1)]
    image = Image.open(io.BytesIO(png(bands, (300, 17), rgb=True, threads=threads)))
    assert image.mode == "RGB"
    np.testing.assert_array_equal(np.asarray(image), pixels)
    refused(ValueError, "shape", png, [pixels[:, :, 0]], (300, 17), rgb=True)
