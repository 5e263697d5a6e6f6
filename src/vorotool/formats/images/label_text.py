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
    """Write one line a row; columns are as wide as the largest label and one space apart.

    Parameters
    ----------
    out : binary file
        Receives ASCII.
    bands : iterable of (rows, W) integer arrays
        Rows from top to bottom.
    shape : (int, int)
        Height and width.
    largest_label : int
        Sets the width of the columns.

    Raises
    ------
    LimitError
        If the image is wider than 4096 or has more than 10^6 pixels.

    Examples
    --------
    >>> import io, numpy as np
    >>> out = io.BytesIO()
    >>> write_label_text(out, [np.array([[1, 1, 12], [1, 12, 12]])], (2, 3), largest_label=12)
    >>> print(out.getvalue().decode(), end="")
     1  1 12
     1 12 12
    """
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
