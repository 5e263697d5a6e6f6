import io

import numpy as np
import pytest

from support.readers.sources import labels_of
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.formats.images.label_images import write_label_image, write_label_text


def written(values: np.ndarray, fmt: str, **options: object) -> bytes:
    settings = {"shape": values.shape, "dtype": values.dtype, "largest_label": int(values.max()), **options}
    return bytes_of(write_label_image, [values], fmt=fmt, **settings)


@pytest.mark.parametrize("dtype", ["u1", "u2", "u4", "i4", "?"])
def test_round_trip(dtype: str) -> None:
    labels = np.random.default_rng(1).integers(0, 10, (17, 13)).astype(dtype)
    palette = {"palette": np.arange(30, dtype=np.uint8).reshape(10, 3)} if dtype == "u1" else {}
    depth = {"bit_depth": 1} if dtype == "?" else {}
    for fmt, options in (("png", palette | depth), ("tiff", palette), ("npy", {}), ("png", depth)):
        np.testing.assert_array_equal(labels_of(written(labels, fmt, **options)), labels)


def test_labels_above_16_bits_are_no_png() -> None:
    out = io.BytesIO()
    with pytest.raises(LimitError, match=r"labels up to 100000 .*use the path labels.tif or labels.npy"):
        write_label_image(out, [], shape=(1, 1), dtype=np.uint32, fmt="png", largest_label=100_000)
    assert out.getvalue() == b""
    write_label_image(out, [np.array([[65_535]])], shape=(1, 1), dtype="u4", fmt="png", largest_label=65_535)


@pytest.mark.parametrize(("dtype", "fmt"), [("f4", "png"), ("f4", "text"), ("u8", "png")])
def test_other_values_need_tiff_or_npy(dtype: str, fmt: str) -> None:
    with pytest.raises(UsageError, match=r"use the path image.tif or image.npy"):
        write_label_image(io.BytesIO(), [], shape=(1, 1), dtype=dtype, fmt=fmt, largest_label=1)


def test_unknown_format() -> None:
    with pytest.raises(UsageError, match="invalid fmt 'bmp'"):
        write_label_image(io.BytesIO(), [], shape=(1, 1), dtype="u1", fmt="bmp", largest_label=1)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.array([[0, 1], [2, -5]]), "-5 in row 1, column 1"),
        (np.array([[0, 2**32]]), "row 0, column 1"),
        (np.array([[0.5]]), "float64 values: labels need integers"),
        (np.arange(12, dtype=np.uint8).reshape(2, 2, 3), "3 channels: labels need a single one"),
    ],
)
def test_values_that_are_no_labels(values: np.ndarray, message: str) -> None:
    refused(InputError, message, labels_of, bytes_of(np.save, values))


def test_text_is_aligned_and_large_images_are_refused() -> None:
    labels = np.random.default_rng(1).integers(0, 120, (20, 30))
    text = bytes_of(write_label_text, [labels[:7], labels[7:]], (20, 30), largest_label=119).decode()
    assert {len(line) for line in text.splitlines()} == {30 * 4 - 1}
    np.testing.assert_array_equal(np.loadtxt(io.StringIO(text), dtype=int), labels)
    for shape in ((1, 4097), (1001, 1000)):
        words = r"use the path labels.png, labels.tif or labels.npy"
        refused(LimitError, words, write_label_text, io.BytesIO(), [], shape, largest_label=1)
