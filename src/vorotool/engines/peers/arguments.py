"""Arguments that these functions have in common with those that they are named after."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.images import as_raster
from vorotool.errors import InputError, LimitError, option
from vorotool.numeric.numbers import real_number, shown_number
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame

if TYPE_CHECKING:
    from vorotool.typing import ImageLike


def volume(values: Any, name: str, max_pixels: int) -> NDArray[Any]:
    """Give a volume as a 3-D array of booleans or numbers."""
    if np.ma.isMaskedArray(values) and np.ma.getmaskarray(values).any():
        raise InputError(f"invalid {name}: expected a value in each voxel, but some are masked; fill them first")
    array = np.asarray(values)
    if array.dtype.kind not in "buif":
        raise InputError(f"invalid {name}: expected booleans or numbers, but got {array.dtype}")
    if array.size > real_number(max_pixels, "max_pixels"):
        sides, most = " x ".join(map(str, array.shape)), option(f"--max-pixels {shown_number(max_pixels)}")
        raise LimitError(f"the volume has {sides} = {array.size} voxels, more than {most}")
    return array


def bare_seeds(places: NDArray[np.int64], labels: NDArray[np.uint32], shape: tuple[int, ...]) -> VolumeSeeds:
    """Give voxels as seeds of a volume of which no sites are wanted, which take time to find."""
    depth, height, width = shape
    frame = VoxelFrame(0, 0, 0, width, height, depth)
    places = np.asfortranarray(places[:, ::-1])
    return VolumeSeeds(places, labels, frame=frame, sites=np.empty((0, 3)), site_labels=np.empty(0, np.uint32))


def plane(values: ImageLike, name: str) -> NDArray[Any]:
    """Give an image as a 2-D array of booleans or numbers."""
    shape = getattr(values, "shape", None)
    if isinstance(shape, tuple) and len(shape) == 2 and 0 in shape:
        return np.asarray(values)
    image = as_raster(values, name, is_gray=True)
    if image.is_color:
        raise InputError(f"invalid {name}: expected one value in each pixel, but it is a color image")
    if image.mask is not None and image.mask.any():
        raise InputError(f"invalid {name}: expected a value in each pixel, but some are masked; fill them first")
    return image.values
