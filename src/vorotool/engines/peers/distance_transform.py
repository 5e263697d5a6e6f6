"""Distances to the background, as `scipy.ndimage.distance_transform_edt` gives them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.peers.arguments import plane
from vorotool.engines.tessellation.frames import require_memory
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import InputError, UsageError
from vorotool.geometry.pixel_frame import MAX_PIXELS, Frame
from vorotool.geometry.spacing import PixelSides, pixel_sides

if TYPE_CHECKING:
    from vorotool.typing import ImageLike, Spacing


@overload
def distance_transform(
    mask: ImageLike,
    *,
    spacing: Spacing | None = ...,
    return_distances: Literal[True] = ...,
    return_indices: Literal[False] = ...,
    threads: int = ...,
    max_pixels: int = ...,
) -> NDArray[np.float64]: ...
@overload
def distance_transform(
    mask: ImageLike,
    *,
    spacing: Spacing | None = ...,
    return_distances: Literal[False],
    return_indices: Literal[True],
    threads: int = ...,
    max_pixels: int = ...,
) -> NDArray[np.int32]: ...
@overload
def distance_transform(
    mask: ImageLike,
    *,
    spacing: Spacing | None = ...,
    return_distances: Literal[True] = ...,
    return_indices: Literal[True],
    threads: int = ...,
    max_pixels: int = ...,
) -> tuple[NDArray[np.float64], NDArray[np.int32]]: ...
def distance_transform(
    mask: ImageLike,
    *,
    spacing: Spacing | None = None,
    return_distances: bool = True,
    return_indices: bool = False,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
) -> NDArray[np.float64] | NDArray[np.int32] | tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Give the distance of each nonzero pixel to the nearest zero pixel, and which that is.

    As `scipy.ndimage.distance_transform_edt`, between centres of pixels. Squared distances are exact integers, whose
    roots are rounded once. Of several nearest pixels it is the first one, row by row, that the indices name; SciPy
    names any.

    Parameters
    ----------
    mask : (H, W) array
        Nonzero pixels are foreground.
    spacing : float or (height, width), optional
        Sides of a pixel, by default 1; SciPy's ``sampling``. A float is the decimal number that it is written as.
    return_distances, return_indices : bool
        What is wanted.
    threads : int
        0 uses all.
    max_pixels : int
        Larger images are refused before memory is taken.

    Returns
    -------
    distances : (H, W) float64 array
        0 at zero pixels.
    indices : (2, H, W) int32 array
        Row and column, from 0, of the nearest zero pixel; alone if distances are not wanted.

    Raises
    ------
    InputError
        If the mask is no image, or has no zero pixel: there are no distances then.
    LimitError
        If it has more than `max_pixels` pixels.
    UsageError
        If nothing is wanted, or the spacing is none.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.2.

    Examples
    --------
    >>> distance_transform([[0, 1, 1, 1], [1, 1, 1, 1]])[1].tolist()
    [1.0, 1.4142135623730951, 2.23606797749979, 3.1622776601683795]
    >>> distance_transform([[0, 1, 0]], return_distances=False, return_indices=True)[1].tolist()
    [[0, 0, 2]]
    """
    if not (return_distances or return_indices):
        raise UsageError("return_distances and return_indices are both False: nothing is wanted, set one of them")
    sides, values = pixel_sides(spacing), plane(mask, "mask")
    sweep = _sweep(values, sides, threads, max_pixels)
    if not return_indices:
        return _roots(sweep, values.shape)
    indices = _nearest(sweep, values.shape)
    return (_roots(sweep, values.shape), indices) if return_distances else indices


def _sweep(values: NDArray[Any], sides: PixelSides, threads: int, max_pixels: int) -> Tessellator | None:
    """The tessellation whose seeds are the zero pixels; None of an image without pixels."""
    if not values.size:
        return None
    height, width = values.shape
    require_memory(Frame(0, 0, width, height), max_pixels)
    background = values == 0
    if not background.any():
        raise InputError("invalid mask: expected a zero pixel, but there is none, so that there are no distances to it")
    return Tessellator(seeds_from_raster(background, mode="pixels"), sides=sides, threads=threads)


def _roots(sweep: Tessellator | None, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Roots of squared distances, in the unit of the spacing."""
    if sweep is None:
        return np.zeros(shape)
    squares = sweep.squared_distances().astype(np.float64)
    if sweep.step != 1:
        squares *= float(sweep.step**2)
    return np.sqrt(squares)


def _nearest(sweep: Tessellator | None, shape: tuple[int, ...]) -> NDArray[np.int32]:
    """Row and column of the nearest seed of each pixel: labels are the numbers of seeds, row by row."""
    indices = np.zeros((2, *shape), np.int32)
    if sweep is not None:
        seed = sweep.labels(dtype=np.uint32).astype(np.int64) - 1
        indices[0], indices[1] = sweep.seeds.y[seed], sweep.seeds.x[seed]
    return indices
