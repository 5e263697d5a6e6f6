import io
import itertools
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
import tifffile
from numpy.typing import NDArray
from PIL import Image

from support.few import few
from support.processes.peak_memory import memory_below
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import LimitError
from vorotool.formats.images import tiff_writer as tiff
from vorotool.formats.images.tiff_reader import read_tiff
from vorotool.formats.images.tiff_writer import write_tiff
from vorotool.types.pixels import PixelGrid


def written(bands: object, shape: tuple[int, int], **options: object) -> bytes:
    return bytes_of(write_tiff, bands, shape, **options)


def values_of(dtype: str, shape: tuple[int, int]) -> NDArray[np.generic]:
    values = np.random.default_rng(2).integers(0, 250, shape)
    return (values * 16_000_000 if np.dtype(dtype).itemsize >= 4 else values).astype(dtype)


@pytest.mark.parametrize("dtype", few(["u2", "f4", "u1", "u4", "i4", "u8"], 2))
@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (8, 1), (33, 21)])
def test_read_back_by_tifffile(dtype: str, shape: tuple[int, int]) -> None:
    values = np.abs(values_of(dtype, shape)) if dtype != "i4" else values_of("u4", shape).astype("i4") & 0x7FFFFFFF
    np.testing.assert_array_equal(tifffile.imread(io.BytesIO(written([values], shape, dtype=dtype))), values)


def test_palette_is_read_back_by_pillow() -> None:
    rng = np.random.default_rng(3)
    palette, values = rng.integers(0, 256, (7, 3), dtype=np.uint8), rng.integers(0, 7, (5, 9), dtype=np.uint8)
    with Image.open(io.BytesIO(written([values], (5, 9), dtype="u1", palette=palette))) as image:
        np.testing.assert_array_equal(np.asarray(image.convert("RGB")), palette[values])


def test_bytes_depend_on_pixels_alone() -> None:
    shape = (600, 1000)
    values = np.random.default_rng(5).integers(0, 4, shape).astype(np.uint32)
    expected = written([values], shape, dtype="u4", threads=1)
    assert b"tifffile" not in expected
    for cut, threads in itertools.product([[0, 600], list(range(601)), [0, 262, 263, 600]], (0, 1, 3)):
        bands = [values[a:b] for a, b in itertools.pairwise(cut)]
        assert written(bands, shape, dtype="u4", threads=threads) == expected


def test_nothing_is_wrapped() -> None:
    refused(LimitError, "65536 does not fit in uint16 pixels", written, [np.array([[65_536]])], (1, 1), dtype="u2")


def test_output_that_cannot_be_sought() -> None:
    class Pipe(io.BytesIO):
        def seekable(self) -> bool:
            return False

        def seek(self, *_: object) -> int:
            raise io.UnsupportedOperation("seek")

    pipe = Pipe()
    values = values_of("u2", (9, 7))
    write_tiff(pipe, [values], (9, 7), dtype="u2")
    assert pipe.getvalue() == written([values], (9, 7), dtype="u2")


def test_large_images_are_bigtiff(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tiff, "CLASSIC_LIMIT", 1000)
    values = values_of("u2", (30, 20))
    data = written([values], (30, 20), dtype="u2")
    assert data[:4] == b"II+\x00"
    np.testing.assert_array_equal(tifffile.imread(io.BytesIO(data)), values)


@pytest.mark.parametrize("dtype", ["u4", "f4"])
def test_memory_stays_bounded(dtype: str, tmp_path: object) -> None:
    band = (np.arange(64 * 4096).reshape(64, 4096) // 50).astype(dtype)
    with (tmp_path / "large.tif").open("w+b") as out, memory_below(40e6):  # type: ignore[operator]
        write_tiff(out, (band for _ in range(128)), (8192, 4096), dtype=dtype)


@pytest.mark.parametrize(
    ("given", "kept"),
    [
        (("1/300", "1/150", "inch"), ("1/300", "1/150", "inch")),
        (("1/40", "1/40", "cm"), ("1/40", "1/40", "cm")),
        (("0.325", "0.325", "um"), ("0.0000325", "0.0000325", "cm")),
        (("1/2", "1/3", "mm"), ("1/20", "1/30", "cm")),
        (("1/2", "1/3", "furlong"), None),
        (("1e-300", "1/3", "cm"), None),
        (("1/3", "1e300", "cm"), None),
        (("0.325", "0.325", "um", "imagej"), ("0.325", "0.325", "µm", "imagej")),
        (("0.325", "0.5", "Å", "imagej"), ("0.325", "0.5", "Å", "imagej")),
        (("0.325", "0.5", "micron", "ome"), ("0.325", "0.5", "µm", "ome")),
        (("1e-9", "1e9", "furlong", "ome"), ("1e-9", "1e9", "furlong", "ome")),
        (None, None),
    ],
)
def test_grids(given, kept):
    def grid_of(values):
        return values and PixelGrid(Fraction(values[0]), Fraction(values[1]), *values[2:])

    data = written([np.ones((2, 3), np.uint8)], (2, 3), dtype=np.uint8, grid=grid_of(given))
    _, found = read_tiff(SimpleNamespace(name="a.tif", data=data), page=None, max_pixels=10)
    assert found.grid == grid_of(kept)
