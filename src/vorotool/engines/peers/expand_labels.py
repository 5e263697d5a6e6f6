"""Labels that grow into the background, as `skimage.segmentation.expand_labels` has them."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.spacings import asked_sides
from vorotool.convert.volumes import is_volume
from vorotool.engines.peers.arguments import bare_seeds, plane, volume
from vorotool.engines.tessellation.frames import require_memory
from vorotool.engines.tessellation.raster_objects import LARGEST_LABEL
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.engines.volumes.inner_voxels import outer_voxels
from vorotool.engines.volumes.volume_tessellator import VolumeSweep
from vorotool.errors import InputError, UsageError
from vorotool.numeric.numbers import real_number, shown_number
from vorotool.types.pixel_frame import MAX_PIXELS, Frame
from vorotool.types.spacing import PixelSides, as_decimal

if TYPE_CHECKING:
    from vorotool.typing import ImageLike, Spacing


def expand_labels(
    labels: ImageLike,
    distance: float | Fraction = 1,
    *,
    spacing: Spacing | None = None,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
) -> NDArray[Any]:
    """Expand labels into the background, up to a distance.

    As `skimage.segmentation.expand_labels`: labels do not grow into each other. Whether a pixel is within the distance
    is decided exactly, and of several labels at one distance the smallest has the pixel; scikit-image compares rounded
    distances, and gives a tie to any of them.

    Parameters
    ----------
    labels : (H, W) or (D, H, W) array of integers or booleans
        0 is background. Labels are from 1 to 4294967295.
    distance : float or Fraction
        How far labels grow, between centers of pixels or voxels, this distance included; ``inf`` fills all the
        background.
    spacing : float, (height, width) or (depth, height, width), or "auto", optional
        Sides of a pixel or voxel in the unit of `distance`, by default 1. With it floats are the decimal numbers that
        they are written as: three pixels of 0.1 are within 0.3.
    threads : int
        Number of threads; 0 uses all.
    max_pixels : int
        Larger images are refused before memory is allocated.

    Returns
    -------
    array of the shape and the type of the input
        Labels.

    Raises
    ------
    InputError
        If the labels are no image, not integers, or out of range.
    LimitError
        If the image has more than `max_pixels` pixels.
    UsageError
        If the distance is negative or NaN, or the spacing is invalid.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.1.

    Examples
    --------
    >>> expand_labels([[7, 0, 0, 0, 2]]).tolist(), expand_labels([[7, 0, 0, 0, 2]], 2).tolist()
    ([[7, 7, 0, 2, 2]], [[7, 7, 2, 2, 2]])
    """
    is_solid = is_volume(labels)
    values = volume(labels, "labels", max_pixels) if is_solid else plane(labels, "labels")
    sides = asked_sides(labels, spacing, 3 if is_solid else 2)
    limit = real_number(distance, "distance")
    if not limit >= 0:
        raise UsageError(f"invalid distance {shown_number(distance)}: expected a number from 0")
    if values.dtype.kind == "f":
        raise InputError(f"invalid labels: expected integers or booleans, but got {values.dtype}; round them first")
    if not values.size or not values.any():
        return values.copy()
    exact = Fraction if spacing is None else as_decimal
    most = None if limit == float("inf") else exact(limit)
    if is_solid:
        return _grown_volume(values, sides, most, threads)
    height, width = values.shape
    require_memory(Frame(0, 0, width, height), max_pixels)
    seeds = seeds_from_raster(values.astype(np.uint8) if values.dtype == bool else values, mode="labels")
    grown = Tessellator(seeds, max_distance=most, sides=sides, threads=threads).labels(dtype=np.uint32)
    return grown.astype(values.dtype)


def _grown_volume(values: NDArray[Any], sides: PixelSides, most: Fraction | None, threads: int) -> NDArray[Any]:
    """The same for a volume: seeds are the outer voxels of each label."""
    labels = values.view(np.uint8) if values.dtype == bool else values
    if labels.min() < 0 or labels.max() > LARGEST_LABEL:
        found = f"{labels.min()} to {labels.max()}"
        raise InputError(f"invalid labels: expected 0 to {LARGEST_LABEL}, but they are {found}")
    outer = outer_voxels(labels)
    seeds = labels[outer].astype(np.uint32)
    bare = bare_seeds(np.argwhere(outer), seeds, values.shape)
    sweep = VolumeSweep(bare, sides=sides, max_distance=most, threads=threads)
    grown = sweep.labels(dtype=np.uint32).astype(values.dtype)
    np.copyto(grown, values, where=values != 0)
    return grown
