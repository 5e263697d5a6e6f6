"""Label images as text: a matrix of right-aligned integers, to be read by eye."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, BinaryIO

from numpy.typing import NDArray

from vorotool.errors import LimitError, option
from vorotool.formats.io.row_bands import checked

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
