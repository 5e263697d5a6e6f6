"""Images are read band by band as they are read whole; what is damaged is refused by name."""

import pickle
import sys

import numpy as np
import pytest
import tifffile
import zarr
from PIL import Image

import vorotool
from support.few import few
from support.readers.sources import bands_of
from support.refusals import refused
from vorotool.errors import InputError, LimitError, UsageError

IMAGE = np.random.default_rng(2).integers(0, 200, (70, 50))
WORDS = IMAGE.astype(np.uint16)


def make(path, image=WORDS, **options):
    array = zarr.create_array(path, shape=image.shape, dtype=image.dtype, chunks=(32, 20)[: image.ndim], **options)
    array[...] = image
    return path


def check(path, expected, page=None):
    rows = pickle.loads(pickle.dumps(bands_of(path, page=page)))
    assert rows.shape == expected.shape
    for first, count in ((0, 70), (0, 1), (69, 1), (31, 2), (16, 40)):
        found = rows.rows(first, count)
        assert found.dtype == expected.dtype
        np.testing.assert_array_equal(found, expected[first : first + count])


@pytest.mark.parametrize("dtype", few([bool, ">u2", np.uint64, np.uint8, np.int16, np.float32], 3))
@pytest.mark.parametrize("version", [2, 3])
def test_zarr(tmp_path, dtype, version):
    image = (IMAGE > 100 if dtype is bool else IMAGE).astype(dtype)
    if version == 3:
        image = image.astype(image.dtype.newbyteorder("="))
    path = make(tmp_path / "a", image, zarr_format=version)
    expected = vorotool.read(path).values
    np.testing.assert_array_equal(expected, image)
    check(path, expected)


@pytest.mark.parametrize("dtype", few([bool, ">u2", np.float32, np.uint8, np.int16, np.uint32], 3))
@pytest.mark.parametrize(
    "layout", [{}, {"tile": (32, 16)}, {"rowsperstrip": 7}, {"compression": "zlib", "predictor": 2}]
)
def test_tiff(tmp_path, dtype, layout):
    image = (IMAGE > 100 if dtype is bool else IMAGE).astype(dtype)
    if "predictor" in layout and image.dtype.kind == "f":
        layout = {"compression": "zlib"}
    if "predictor" in layout and dtype is bool:  # which not every version of tifffile compresses
        Image.fromarray(image).save(tmp_path / "a.tif", compression="tiff_adobe_deflate")
        check(tmp_path / "a.tif", image.astype(np.uint8))
        return
    tifffile.imwrite(tmp_path / "a.tif", image, byteorder=">" if dtype == ">u2" else "<", bigtiff=True, **layout)
    check(tmp_path / "a.tif", vorotool.read(tmp_path / "a.tif").values)


def test_pages(tmp_path):
    tifffile.imwrite(tmp_path / "a.tif", np.stack([IMAGE, IMAGE + 1]).astype(np.uint8), photometric="minisblack")
    check(tmp_path / "a.tif", (IMAGE + 1).astype(np.uint8), page=1)
    with pytest.raises(InputError, match="2 pages"):
        _ = bands_of(tmp_path / "a.tif").shape


def test_what_is_written_is_read(tmp_path):
    image = vorotool.tessellate([[3, 4], [30, 20]], shape=(40, 3000))
    vorotool.write(image, tmp_path / "a.zarr")
    np.testing.assert_array_equal(vorotool.read(tmp_path / "a.zarr").values, image.labels)


def test_what_is_read_otherwise(tmp_path):
    tifffile.imwrite(tmp_path / "color.tif", np.zeros((5, 5, 3), np.uint8))
    (tmp_path / "dots.csv").write_text("1,2\n")
    for name in ("color.tif", "dots.csv", "none.tif", "none.zarr"):
        assert bands_of(tmp_path / name) is None


def test_bad_stores(tmp_path):
    (tmp_path / "empty.zarr").mkdir()
    for name, text in (("torn", '{"node_type": "array", "shape"'), ("odd", '{"node_type": "array", "shape": 7}')):
        (tmp_path / f"{name}.zarr").mkdir()
        (tmp_path / f"{name}.zarr/zarr.json").write_text(text)
    zarr.create_group(tmp_path / "group.zarr")
    zarr.create_array(tmp_path / "three.zarr", shape=(3, 4, 5), dtype=np.uint8)
    zarr.create_array(tmp_path / "complex.zarr", shape=(3, 4), dtype=np.complex64)
    zarr.create_array(tmp_path / "none.zarr", shape=(0, 4), dtype=np.uint8)
    for name, words in {
        "empty.zarr": "holds no Zarr array",
        "torn.zarr": "holds no Zarr array",
        "odd.zarr": "cannot be read as Zarr",
        "group.zarr": r"is a Zarr group: name an array in it, such as .*group.zarr/0",
        "three.zarr": r"has 3 axes, shape \(3, 4, 5\)",
        "complex.zarr": "holds complex64: an image of numbers",
        "none.zarr": "needs at least 1 x 1",
    }.items():
        refused(InputError, words, vorotool.read, tmp_path / name)


def test_limits_and_options(tmp_path, monkeypatch):
    path = make(tmp_path / "a.zarr")
    refused(LimitError, "50 x 70 = 3500 pixels", vorotool.read, path, max_pixels=3499)
    refused(InputError, "page=1 does not exist", vorotool.read, path, page=1)
    (tmp_path / "file.zarr").write_text("")
    refused(InputError, "a Zarr store is a folder", vorotool.read, tmp_path / "file.zarr", input_format="zarr")
    monkeypatch.setitem(sys.modules, "numcodecs.zstd", None)
    refused(UsageError, "packed with zstd need the numcodecs package: pip install", vorotool.read, path)
