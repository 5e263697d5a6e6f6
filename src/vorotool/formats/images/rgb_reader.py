"""Images as they look: red, green and blue, to draw over."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.images import png_reader, tiff_reader
from vorotool.formats.images.reader import read_image
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.types.pixel_grid import PixelGrid

_WHITE = 255


def picture_and_grid(source: Source, options: ReadOptions) -> tuple[NDArray[np.uint8], PixelGrid | None]:
    """Read an image as a screen shows it, and what its file says of its pixels."""
    if source.format != "tiff" or tiff_reader.tiff_pages(source) == 1:
        options = replace(options, page=None)
    image = read_image(source, options)
    return _as_seen(source, image.values), image.grid


def _as_seen(source: Source, values: NDArray[Any]) -> NDArray[np.uint8]:
    palette = png_reader.png_palette(source) if source.format == "png" else None
    if palette is not None and values.ndim == 2:
        colors: NDArray[np.uint8] = palette[values]
        return colors
    channels = _spread(values[:, :, None] if values.ndim == 2 else values)
    if channels.shape[2] in (2, 4):
        alpha = channels[:, :, -1:].astype(np.uint16)
        channels = ((channels[:, :, :-1] * alpha + _WHITE * (_WHITE - alpha) + _WHITE // 2) // _WHITE).astype(np.uint8)
    return np.ascontiguousarray(np.broadcast_to(channels, (*channels.shape[:2], 3)))


def _spread(values: NDArray[Any]) -> NDArray[np.uint8]:
    """Values as 8 bits; an alpha channel runs from 0 to the largest value of its type."""
    if values.dtype == np.uint8 and not _is_two_valued(values):
        return values
    colors = slice(None, -1) if values.shape[2] in (2, 4) else slice(None)
    scaled = np.nan_to_num(values.astype(np.float64), nan=0.0, posinf=0.0, neginf=0.0)
    low, high = scaled[:, :, colors].min(), scaled[:, :, colors].max()
    spread = (scaled - low) * (_WHITE / (high - low)) if high > low else np.zeros_like(scaled)
    if values.shape[2] in (2, 4):
        opaque = 1.0 if values.dtype.kind == "f" else np.iinfo(values.dtype).max
        spread[:, :, -1] = np.clip(scaled[:, :, -1] / opaque, 0, 1) * _WHITE
    return np.rint(spread).astype(np.uint8)


def _is_two_valued(values: NDArray[np.uint8]) -> bool:
    return values.shape[2] == 1 and bool(((values == values.min()) | (values == values.max())).all())
