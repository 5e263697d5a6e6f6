"""Label images in and out, whatever the file format."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, BinaryIO, Literal

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import InputError, LimitError, UsageError, option
from vorotool.formats.io.arrays import checked
from vorotool.products.formats import resolved
from vorotool.types.images import LabelImage, Raster
from vorotool.types.pixels import PixelGrid

if TYPE_CHECKING:
    from vorotool.types.skeleton.arc_measures import ThicknessImage

_ANY_IMAGE = option("-o image.tif or image.npy", "the path image.tif or image.npy")

LabelFormat = Literal["png", "tiff", "npy", "text"]

_LARGEST_LABEL = 2**32 - 1


def write_label_image(
    out: BinaryIO,
    bands: Iterable[NDArray[Any]],
    *,
    shape: tuple[int, int],
    dtype: DTypeLike,
    fmt: LabelFormat,
    largest_label: int,
    palette: NDArray[np.uint8] | None = None,
    bit_depth: int | None = None,
    grid: PixelGrid | None = None,
    nodata: int | None = None,
    scale: float | None = None,
    tiled: bool = False,
) -> None:
    """Write an image from bands of rows; what the format cannot hold is refused before anything is written."""
    kind = np.dtype(np.uint8 if np.dtype(dtype) == np.bool_ else dtype)
    if kind.kind not in "ui" and fmt in ("png", "text"):
        raise UsageError(f"{kind} values cannot be written as {fmt}: use {_ANY_IMAGE}")
    if fmt == "png":
        depth = bit_depth or (16 if palette is None else 8)
        check_png(kind, largest_label, depth)
        resolved("formats.images.png_writer:write_png")(out, bands, shape, bit_depth=depth, palette=palette)
    elif fmt == "tiff":
        of_pixels: dict[str, Any] = {"grid": grid, "nodata": nodata, "scale": scale, "tiled": tiled}
        resolved("formats.images.tiff_writer:write_tiff")(out, bands, shape, dtype=kind, palette=palette, **of_pixels)
    elif fmt == "npy":
        resolved("formats.io.arrays:write_npy")(out, bands, shape, dtype=kind)
    elif fmt == "text":
        write_label_text(out, bands, shape, largest_label=largest_label)
    else:
        raise UsageError(f"invalid fmt {fmt!r}: expected png, tiff, npy or text")


def write_labels(out: BinaryIO, image: LabelImage, fmt: LabelFormat) -> None:
    """Write the labels of an image that is in memory; see `write_label_image`."""
    kind, largest = image.labels.dtype, int(image.labels.max())
    write_label_image(
        out,
        [image.labels],
        shape=image.shape,
        dtype=kind,
        fmt=fmt,
        largest_label=largest,
        grid=image.grid,
    )


def check_png(kind: np.dtype[Any], largest: int, depth: int = 16) -> None:
    """Refuse values that a PNG does not hold."""
    if kind.itemsize > 4:
        raise UsageError(f"{kind} values cannot be written as png: use {_ANY_IMAGE}")
    if largest >= 1 << depth:
        raise LimitError(
            f"labels up to {largest} do not fit in a {depth}-bit PNG, which ends at {(1 << depth) - 1}: "
            f"use {option('-o labels.tif or labels.npy', 'the path labels.tif or labels.npy')}"
        )


def label_image_of(image: Raster, name: str) -> LabelImage:
    """Take the values of an image for labels; masked pixels have none."""
    values = image.values
    if values.ndim != 2:
        raise InputError(f"{name} has {values.shape[2]} channels: labels need a single one")
    if image.is_lossy:
        raise InputError(f"{name} has lossy compression, so its values are not labels; give a PNG, TIFF or NPY file")
    if values.dtype.kind not in "bui":
        raise InputError(f"{name} holds {values.dtype} values: labels need integers")
    if image.mask is not None:
        values = np.where(image.mask, values.dtype.type(0), values)
    return LabelImage(values.view(np.uint8) if values.dtype == np.bool_ else _as_labels(values, name))


def _as_labels(values: NDArray[Any], name: str) -> NDArray[Any]:
    """Keep the unsigned types up to 32 bits; the others become uint32 where their values allow it."""
    if values.dtype in (np.uint8, np.uint16, np.uint32):
        return values
    outside = values < 0
    if values.dtype.itemsize > 4:
        outside |= values > _LARGEST_LABEL
    if outside.any():
        row, column = np.unravel_index(int(np.argmax(outside)), values.shape)
        raise InputError(
            f"{name} has {values[row, column]} in row {row}, column {column}: labels are from 0 to {_LARGEST_LABEL}"
        )
    return values.astype(np.uint32)


# ---- as text -------------------------------------------------------------------------------------
_IMAGES = option("-o labels.png, labels.tif or labels.npy", "the path labels.png, labels.tif or labels.npy")

WIDEST = 4096
MOST_PIXELS = 1_000_000


def write_label_text(
    out: BinaryIO, bands: Iterable[NDArray[Any]], shape: tuple[int, int], *, largest_label: int
) -> None:
    """Write one line a row; columns are as wide as the largest label and one space apart."""
    height, width = shape
    if width > WIDEST or width * height > MOST_PIXELS:
        raise LimitError(
            f"{width} x {height} pixels are too many for text (at most {WIDEST} wide, {MOST_PIXELS} pixels): "
            f"use {_IMAGES}"
        )
    digits = len(str(largest_label))
    for band in checked(bands, shape):
        for row in band.tolist():
            out.write((" ".join(f"{int(value):>{digits}}" for value in row) + "\n").encode("ascii"))


ROWS = 256
"""Of a band, which is converted at a time."""


def write_thickness(out: BinaryIO, image: ThicknessImage, fmt: Literal["tiff", "npy"]) -> None:
    """Write each thickness as a float of 32 bits."""
    values = image.values
    write_label_image(
        out,
        (values[row : row + ROWS].astype(np.float32) for row in range(0, len(values), ROWS)),
        shape=(values.shape[0], values.shape[1]),
        dtype=np.float32,
        fmt=fmt,
        largest_label=0,
        grid=image.grid,
    )
