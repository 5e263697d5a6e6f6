"""What an image holds: foreground by a threshold, a mask of components, or labels."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import InputError
from vorotool.geometry.raster import Raster

Objects = Literal["components", "labels"]
Threshold = float | Literal["otsu"] | None

LARGEST_LABEL = 0xFFFFFFFF

_LUMINANCE = (0.2125, 0.7154, 0.0721)
"""Weights of red, green and blue (ITU-R BT.709, as scikit-image has them)."""


def foreground_values(raster: Raster, threshold: Threshold, *, invert: bool) -> NDArray[Any]:
    """Values of which the nonzero ones are foreground.

    Parameters
    ----------
    raster : Raster
        The image.
    threshold : float or "otsu", optional
        Foreground is what is larger, and of one value.
    invert : bool
        Exchange foreground and background.

    Raises
    ------
    InputError
        If there is no threshold, and the image has colours or values that are not finite; or if Otsu's method finds
        none.

    Examples
    --------
    >>> foreground_values(Raster(np.array([[3, 200]])), 100, invert=False).tolist()
    [[False, True]]
    """
    values = raster.values
    if threshold is not None:
        grey = grey_values(raster)
        values = grey > threshold_value(grey, threshold)
    elif raster.is_colour:
        raise InputError("a colour image holds no objects by itself: use --threshold T or --threshold otsu")
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        raise InputError("the image holds NaN or infinite values: use --threshold T, a number, or repair them")
    return values == 0 if invert else values


def grey_values(raster: Raster) -> NDArray[Any]:
    """(H, W) the values, or the luminance of a colour image; transparency does not count."""
    values = raster.values
    if not raster.is_colour:
        return values
    if values.shape[2] <= 2:
        return values[:, :, 0]
    red, green, blue = (weight * values[:, :, k] for k, weight in enumerate(_LUMINANCE))
    luminance: NDArray[np.float64] = red + green + blue
    return luminance


def threshold_value(grey: NDArray[Any], threshold: float | Literal["otsu"]) -> float:
    """Give the threshold as a number: for ``otsu`` the one of Otsu's method.

    Raises
    ------
    InputError
        If there is none, as all values are the same or some are not finite.

    Examples
    --------
    >>> threshold_value(np.array([[0, 10]]), 4.5)
    4.5
    """
    if threshold != "otsu":
        return threshold
    from skimage.filters import threshold_otsu

    if grey.dtype.kind == "f" and not np.isfinite(grey).all():
        raise InputError("the image holds NaN or infinite values: use --threshold T, a number, or repair them")
    if grey.min() == grey.max():
        raise InputError(f"all pixels have the value {grey.flat[0]}: --threshold otsu needs two values")
    return float(threshold_otsu(grey))


def default_objects(values: NDArray[Any]) -> Objects:
    """Tell whether the nonzero values are of a mask or labels: two values of which one is 0 are a mask.

    Raises
    ------
    InputError
        If they look like a photograph.

    Examples
    --------
    >>> default_objects(np.array([[0, 255]])), default_objects(np.array([[1, 2]]))
    ('components', 'labels')
    """
    if values.dtype == bool:
        return "components"
    is_zero = values == 0
    first = values.flat[int(is_zero.argmin())]  # nonzero, if any is
    if first == 0 or (is_zero.any() and (is_zero | (values == first)).all()):
        return "components"
    refuse_photograph(values)
    return "labels"


def refuse_photograph(values: NDArray[Any]) -> None:
    """A label image has about as many fragments as labels; a photograph falls into far more."""
    fractional = values.dtype.kind == "f" and bool((values != np.floor(values)).any())
    distinct, fragments = (len(np.unique(values)),) * 2 if fractional else _fragments(label_values(values))
    if fractional or (fragments > 4 * distinct and fragments > 256):
        raise InputError(
            f"the image holds {distinct} values in {fragments} fragments: a photograph? use --threshold otsu, "
            f"or --seeds labels if these are labels"
        )


def _fragments(labels: NDArray[Any]) -> tuple[int, int]:
    """Count the values of an image, and the 4-connected pieces of those that are not 0."""
    steps = sum(int(np.count_nonzero(row[1:] != row[:-1])) for row in labels)
    if 8 * steps < labels.size:  # the borders between the regions of noise would take more memory than labels do
        found = _core.measure_regions(np.ascontiguousarray(labels), 0, None)
        return len(found["labels"]) + bool((labels == 0).any()), int(found["components"].sum())
    from skimage.measure import label

    return len(np.unique(labels)), int(label(labels.astype(np.int64), connectivity=1).max())


def label_values(values: NDArray[Any], *, first_row: int = 0) -> NDArray[Any]:
    """Give labels in an unsigned type; the first value that is none is named with its place.

    Parameters
    ----------
    values : (h, W) array
        Rows of an image.
    first_row : int
        Which is the first.

    Raises
    ------
    InputError
        If a value is no integer from 0 to 2^32 - 1.

    Examples
    --------
    >>> label_values(np.array([[0, 7]])).dtype.name
    'uint32'
    """
    if values.dtype in (np.bool_, np.uint8, np.uint16, np.uint32):
        return values
    bad = (values < 0) | (values > LARGEST_LABEL)
    if values.dtype.kind == "f":
        bad |= values != np.floor(values)
    if bad.any():
        row, column = np.unravel_index(int(bad.argmax()), bad.shape)
        raise InputError(
            f"the image holds the value {values[row, column]} in row {first_row + row}, column {column}: labels must "
            f"be integers from 0 to {LARGEST_LABEL}; use --threshold T for a mask"
        )
    return values.astype(np.uint32)
