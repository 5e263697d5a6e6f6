"""Pictures of an amount in each pixel, in colours from dark to light."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.render.canvas.colour_scales import colour_bar, scale_colours
from vorotool.render.canvas.insets import insets
from vorotool.render.canvas.layers import Backdrop, ImagePage
from vorotool.render.canvas.palettes import WHITE
from vorotool.render.canvas.png import layer_bands
from vorotool.render.canvas.styles import PictureStyle

COLOURS = 255
"""Of amounts; with the ground their numbers fit in a byte."""


def amount_indices(values: NDArray[np.float64], largest: float) -> NDArray[np.uint8]:
    """Give the number of each pixel's colour: 0 where there is no amount, else from 1 to `COLOURS`.

    Examples
    --------
    >>> amount_indices(np.array([[0.0, 1e-9, 4.0]]), 4.0).tolist()
    [[0, 1, 255]]
    """
    indices = np.zeros(values.shape, np.uint8)
    for row in range(0, len(values), 256):  # what is made beside it stays small
        band = values[row : row + 256]
        ranks = np.minimum(band * (COLOURS / largest), COLOURS - 1) + 1 if largest else band
        indices[row : row + 256] = np.where(band > 0, ranks, 0)
    return indices


def amount_palette(ground: str | None) -> NDArray[np.uint8]:
    """Give the colours of these numbers, the ground first: white where it is nothing.

    Examples
    --------
    >>> amount_palette("#000000")[:2].tolist()
    [[0, 0, 0], [68, 1, 84]]
    """
    first = np.array([list(bytes.fromhex((ground or WHITE)[1:]))], dtype=np.uint8)
    return np.concatenate([first, scale_colours(COLOURS)])


def with_colour_bar(
    pixels: NDArray[np.uint8], style: PictureStyle, largest: float, unit: str | None
) -> NDArray[np.uint8]:
    """Draw the bar of the colours, and a scale bar, over a picture.

    Parameters
    ----------
    pixels : (H, W, 3) uint8 array
        Red, green and blue.
    style : PictureStyle
        With the scale bar, if there is one.
    largest : float
        The amount that has the last colour; 0: there is no bar of colours.
    unit : str, optional
        Of amounts.

    Examples
    --------
    >>> made = with_colour_bar(np.zeros((90, 90, 3), np.uint8), PictureStyle(), 3.0, None)
    >>> made.shape, bool(made.any())
    ((90, 90, 3), True)
    """
    page = ImagePage(Backdrop(pixels, bytes))
    page.style = style
    over = [*(colour_bar(largest, unit, page) if largest > 0 else []), *insets([], page)]
    made: NDArray[np.uint8] = np.concatenate(list(layer_bands([], page, insets=over)))
    return made.reshape(pixels.shape)
