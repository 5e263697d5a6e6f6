import io

import numpy as np
import pytest

from support.readers.sources import labels_of
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.formats.images.label_images import write_label_image


def written(values: np.ndarray, fmt: str, **options: object) -> bytes:
    out = io.BytesIO()
    settings = {"shape": values.shape, "dtype": values.dtype, "largest_label": int(values.max()), **options}
    write_label_image(out, [values], fmt=fmt, **settings)
    return out.getvalue()


@pytest.mark.parametrize("fmt", ["png", "tiff", "npy"])
@pytest.mark.parametrize("dtype", ["u1", "u2", "u4", "i4"])
def test_round_trip(fmt: str, dtype: str) -> None:
    labels = np.random.default_rng(1).integers(0, 200, (17, 13)).astype(dtype)
    np.testing.assert_array_equal(labels_of(written(labels, fmt)), labels)


def test_diagram_round_trip() -> None:
    mask = np.random.default_rng(1).integers(0, 2, (17, 13)).astype(bool)
    for fmt, options in (("png", {"bit_depth": 1}), ("tiff", {}), ("npy", {})):
        data = written(mask, fmt, **options)
        np.testing.assert_array_equal(labels_of(data), mask)


def test_palette_indices_round_trip() -> None:
    palette = np.arange(30, dtype=np.uint8).reshape(10, 3)
    labels = np.random.default_rng(1).integers(0, 10, (17, 13)).astype(np.uint8)
    for fmt in ("png", "tiff"):
        data = written(labels, fmt, palette=palette)
        np.testing.assert_array_equal(labels_of(data), labels)


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
    out = io.BytesIO()
    np.save(out, values)
    with pytest.raises(InputError, match=message):
        labels_of(out.getvalue())
