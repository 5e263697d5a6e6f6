"""Local thickness as an image of floats."""

from __future__ import annotations

from typing import BinaryIO, Literal

import numpy as np

from vorotool.formats.images.label_images import write_label_image
from vorotool.types.skeleton.thickness import ThicknessImage

ROWS = 256
"""Of a band, which is converted at a time."""


def write_thickness(out: BinaryIO, image: ThicknessImage, fmt: Literal["tiff", "npy"], *, threads: int = 0) -> None:
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
        threads=threads,
    )
