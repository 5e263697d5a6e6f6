"""Images from whatever a caller holds, and whether an array is an image or a list of points."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.spacings import grid_of
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.numeric.checks import (
    MAX_PIXELS,
    column_names,
    described,
    is_choice,
    is_masked_array,
    naming,
    refuse_paths,
    unexpected,
)
from vorotool.numeric.coordinates import MOST_AXES
from vorotool.numeric.numbers import real_number, shown_number
from vorotool.types.images import LabelImage, Raster

EXPECTED = "an image: a Raster, a LabelImage, or a 2-D array of truth values or integers"
POINT_WIDTHS = (2, 3)
"""Numbers a row of arrays of integers that are points unless they are said to be images."""

COLOR_CHANNELS = (1, 2, 3, 4)


def check_image_choice(image: Any) -> None:
    """Raise UsageError unless `image` is True, False or None."""
    if not is_choice(image, (None, True, False)):
        raise UsageError(f"invalid image {shown_number(image)}: expected True, False or None")


def is_image(source: Any, name: str, image: bool | None = None) -> bool:
    """Tell whether what may be points or an image is an image."""
    check_image_choice(image)
    if isinstance(source, Raster | LabelImage):
        return True
    if image is not None:
        return bool(image)
    if hasattr(source, "__array_interface__") and not hasattr(source, "shape"):  # of Pillow
        source = np.asarray(source)
    shape = getattr(source, "shape", None)
    if not isinstance(shape, tuple) or len(shape) < 2 or column_names(source) is not None:
        return False
    kind = _kind(source)
    if len(shape) > 2 or kind not in "iuf":
        return kind in "biuf"
    if kind != "f":
        return 0 not in shape and shape[1] not in POINT_WIDTHS
    if min(shape) > MOST_AXES:
        raise InputError(
            f"invalid {name}: it is {described(source)}, is it a gray image? give vorotool.seeds_from_raster({name}, "
            "threshold=…)"
        )
    return False


def as_raster(source: Any, name: str, *, is_gray: bool = False, max_pixels: int = MAX_PIXELS) -> Raster:
    """Give an image from whatever holds it."""
    if isinstance(source, Raster):
        return source
    if isinstance(source, LabelImage):
        return Raster(source.labels, source.grid)
    with naming(name):
        refuse_paths(source, texts=True)
        _check_shape(source, name, is_gray=is_gray, max_pixels=max_pixels)
        grid = grid_of(source) if _has_axes(source) else None
        array = _array(source)
        if array.dtype.kind not in "biuf":
            raise unexpected(source, EXPECTED)
        _check_shape(array, name, is_gray=is_gray, max_pixels=max_pixels)
        if array.dtype.kind == "f" and not is_gray:
            how = f"vorotool.seeds_from_raster({name}, threshold=…) takes gray values"
            raise InputError(f"expected truth values or integers, but got {described(array)}; {how}")
        return Raster(array, grid)


def as_label_image(source: Any, name: str, components: Callable[[NDArray[Any]], NDArray[Any]]) -> LabelImage:
    """Give a label image: of truth values the components are numbered, integers are labels."""
    if isinstance(source, LabelImage):
        return source
    raster = as_raster(source, name)
    values = raster.values if raster.mask is None else np.where(raster.mask, raster.values.dtype.type(0), raster.values)
    with naming(name):
        if values.ndim != 2 or values.dtype.kind == "f":
            raise InputError(f"expected labels, a 2-D array of integers, but got {described(values)}")
        return LabelImage(components(values) if values.dtype == bool else values, grid=raster.grid)


def _kind(source: Any) -> str:
    """Give the kind of the numbers of an array."""
    try:
        return np.dtype(getattr(source, "dtype", "O")).kind
    except TypeError:  # a type of another library
        return np.asarray(source).dtype.kind


def _has_axes(source: Any) -> bool:
    """Whether an array has named axes with coordinates, as those of xarray."""
    return hasattr(source, "dims") and hasattr(source, "coords") and len(source.dims) == 2


def _array(source: Any) -> NDArray[Any]:
    if is_masked_array(source):
        return source
    if column_names(source) is None and not isinstance(source, str | bytes):
        try:
            return np.asarray(source)
        except (TypeError, ValueError):
            pass
    raise unexpected(source, EXPECTED)


def _check_shape(source: Any, name: str, *, is_gray: bool, max_pixels: int) -> None:
    """Refuse what is no image by its shape alone: arrays of Dask and Zarr are not in memory yet."""
    shape = getattr(source, "shape", None)
    if not isinstance(shape, tuple):
        return
    if len(shape) == 3 and shape[2] in COLOR_CHANNELS and not is_gray:
        raise InputError(
            f"it is a color image, {described(source)}: give vorotool.seeds_from_raster({name}, threshold=…)"
        )
    if len(shape) == 3 and shape[2] not in COLOR_CHANNELS:
        raise InputError(
            f"it is a stack of {shape[0]} images, {described(source)}: give one of them, {name}[0]; "
            f"vorotool.tessellate takes it as a volume"
        )
    if len(shape) not in (2, 3):
        raise unexpected(source, EXPECTED)
    pixels = shape[0] * shape[1]
    if not isinstance(source, np.ndarray) and pixels > real_number(max_pixels, "max_pixels"):
        raise LimitError(
            f"{name} has {shape[1]} x {shape[0]} = {pixels} pixels, more than max_pixels {max_pixels}: the command "
            "line reads images of TIFF, NPY and Zarr band by band"
        )
