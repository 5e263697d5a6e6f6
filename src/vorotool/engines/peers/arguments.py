"""Arguments that these functions have in common with those that they are named after."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.geometry.arguments.images import as_raster

if TYPE_CHECKING:
    from vorotool.typing import ImageLike


def plane(values: ImageLike, name: str) -> NDArray[Any]:
    """Give an image as a 2-D array of booleans or numbers.

    Raises
    ------
    InputError
        If it is none, or some pixels are masked.

    Examples
    --------
    >>> plane([[0, 1]], "mask").shape
    (1, 2)
    """
    shape = getattr(values, "shape", None)
    if isinstance(shape, tuple) and len(shape) == 2 and 0 in shape:
        return np.asarray(values)
    image = as_raster(values, name, is_grey=True)
    if image.is_colour:
        raise InputError(f"invalid {name}: expected one value in each pixel, but it is a colour image")
    if image.mask is not None and image.mask.any():
        raise InputError(f"invalid {name}: expected a value in each pixel, but some are masked; fill them first")
    return image.values
