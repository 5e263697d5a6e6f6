"""Distances to the background, as `scipy.ndimage.distance_transform_edt` gives them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.spacings import asked_sides
from vorotool.convert.volumes import is_volume
from vorotool.engines.peers.arguments import bare_seeds, plane, volume
from vorotool.engines.tessellation.frames import require_memory
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.engines.volumes.inner_voxels import outer_voxels
from vorotool.engines.volumes.volume_tessellator import VolumeSweep
from vorotool.errors import InputError, UsageError
from vorotool.numeric.checks import checked_flag
from vorotool.types.pixel_frame import MAX_PIXELS, Frame
from vorotool.types.spacing import PixelSides

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
    """Compute the distance of each nonzero pixel or voxel to the nearest zero one, and its indices.

    As `scipy.ndimage.distance_transform_edt`, between centers. Squared distances are exact integers, whose roots are
    rounded once. Of several nearest pixels it is the first one, row by row, that the indices name; SciPy names any.

    Parameters
    ----------
    mask : (H, W) or (D, H, W) array
        Nonzero pixels or voxels are foreground.
    spacing : float, (height, width) or (depth, height, width), or "auto", optional
        Sides of a pixel or voxel, by default 1; SciPy's ``sampling``. A float is the decimal number that it is written
        as.
    return_distances, return_indices : bool
        Which results to return.
    threads : int
        Number of threads; 0 uses all.
    max_pixels : int
        Larger images are refused before memory is allocated.

    Returns
    -------
    distances : float64 array of the shape of the mask
        0 at zero pixels.
    indices : (2, H, W) or (3, D, H, W) int32 array
        Row and column, or slice, row and column, from 0, of the nearest zero pixel; alone if distances are not wanted.

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
    >>> distance_transform([[[0, 1, 1]], [[1, 1, 1]]], spacing=(3, 1, 2)).tolist()
    [[[0.0, 2.0, 4.0]], [[3.0, 3.605551275463989, 5.0]]]
    >>> distance_transform([[0, 1, 0]], return_distances=False, return_indices=True)[1].tolist()
    [[0, 0, 2]]
    """
    return_distances = checked_flag(return_distances, "return_distances")
    return_indices = checked_flag(return_indices, "return_indices")
    if not (return_distances or return_indices):
        raise UsageError("return_distances and return_indices are both False: set at least one of them")
    sweep: Tessellator | _Background | None
    if is_volume(mask):
        values = volume(mask, "mask", max_pixels)
        sweep = _Background.of(values, asked_sides(mask, spacing, 3), threads)
    else:
        values = plane(mask, "mask")
        sweep = _sweep(values, asked_sides(mask, spacing), threads, max_pixels)
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
    _require(background)
    return Tessellator(seeds_from_raster(background, mode="pixels"), sides=sides, threads=threads)


def _require(background: NDArray[np.bool_]) -> None:
    if not background.any():
        raise InputError("invalid mask: expected at least one zero pixel to measure distances to, but all are nonzero")


class _Background(VolumeSweep):
    """The tessellation of a volume whose seeds are its zero voxels, of which those at the foreground are enough."""

    def __init__(self, background: NDArray[np.bool_], sides: PixelSides, threads: int) -> None:
        self.is_seed = background
        self.places = np.argwhere(outer_voxels(background))
        labels = np.arange(1, len(self.places) + 1, dtype=np.uint32)
        super().__init__(bare_seeds(self.places, labels, background.shape), sides=sides, threads=threads)

    @classmethod
    def of(cls, values: NDArray[Any], sides: PixelSides, threads: int) -> _Background | None:
        """None of a volume without voxels."""
        if not values.size:
            return None
        background = values == 0
        _require(background)
        return cls(background, sides, threads)

    def squared_distances(
        self,
        first: int = 0,
        slices: int | None = None,
        *,
        dtype: np.dtype[Any] | None = None,
        out: NDArray[Any] | None = None,
    ) -> NDArray[Any]:
        """Those of the sweep, and 0 where a seed is that it was not told of."""
        squares = super().squared_distances(first, slices, dtype=dtype, out=out)
        squares[self.is_seed[first : first + len(squares)]] = 0
        return squares

    def nearest(self) -> NDArray[np.int32]:
        """(3, D, H, W) slice, row and column of the nearest zero voxel."""
        seed = self.labels(dtype=np.uint32).astype(np.int64) - 1
        own = np.nonzero(self.is_seed)
        indices = np.empty((3, *self.frame.shape), np.int32)
        for axis in range(3):
            indices[axis] = self.places[:, axis][seed]
            indices[axis][own] = own[axis]
        return indices


def _roots(sweep: Tessellator | _Background | None, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Roots of squared distances, in the unit of the spacing."""
    if sweep is None:
        return np.zeros(shape)
    squares = sweep.squared_distances().astype(np.float64)
    if sweep.step != 1:
        squares *= float(sweep.step * sweep.step)
    return np.sqrt(squares)


def _nearest(sweep: Tessellator | _Background | None, shape: tuple[int, ...]) -> NDArray[np.int32]:
    """Row and column of the nearest seed of each pixel: labels are the numbers of seeds, row by row."""
    if isinstance(sweep, _Background):
        return sweep.nearest()
    indices = np.zeros((len(shape), *shape), np.int32)
    if sweep is not None:
        seed = sweep.labels(dtype=np.uint32).astype(np.int64) - 1
        indices[0], indices[1] = sweep.seeds.y[seed], sweep.seeds.x[seed]
    return indices
