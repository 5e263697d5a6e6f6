"""The medial axis and the local thickness of images, as scikit-image and its users know them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.spacings import asked_sides
from vorotool.engines.from_skeleton.points_along import points_along
from vorotool.engines.from_skeleton.thickness import thickness_of_pixels
from vorotool.engines.label_images.outlines import outlines
from vorotool.engines.peers.distance_transform import distance_transform, plane
from vorotool.engines.pruning.pruning import default_pruning_for_masks, prune
from vorotool.engines.skeleton_api import skeleton_exact
from vorotool.engines.tessellation.cleaned_masks import reaches_border
from vorotool.engines.tessellation.frames import require_memory
from vorotool.engines.tessellation.raster_objects import numbered_components
from vorotool.numeric.checks import checked_flag
from vorotool.numeric.parallel import Progress
from vorotool.types.images import Raster
from vorotool.types.pixels import MAX_PIXELS, Frame

if TYPE_CHECKING:
    from vorotool.typing import ImageLike, OutlineKind, Spacing

_STEP = 0.125
"""Between the places along the skeleton whose pixels are marked: an arc marks each pixel in which it is this long."""


@overload
def medial_axis(mask: ImageLike, *, return_distance: Literal[False] = ..., threads: int = ...) -> NDArray[np.bool_]: ...
@overload
def medial_axis(
    mask: ImageLike, *, return_distance: Literal[True], threads: int = ...
) -> tuple[NDArray[np.bool_], NDArray[np.float64]]: ...
def medial_axis(
    mask: ImageLike, *, return_distance: bool = False, threads: int = 0
) -> NDArray[np.bool_] | tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Mark the pixels that the exact skeleton of a mask passes through.

    The skeleton is that of the outline of the pixels (`skeleton_exact` of `outlines`), pruned as that of a mask is by
    default, so that no branch goes to each corner of a pixel. Every object has one 8-connected part of it, with the
    holes of the object and no others: pixels that branches enclose between them are marked, too. It is not
    `skimage.morphology.medial_axis`, which thins pixels in an order that chance decides in part: that axis is one pixel
    wide and has branches to corners of the outline, while this one may be two pixels wide, since it has all pixels
    that the skeleton passes through, and takes the border of the image for a part of the outline.

    Parameters
    ----------
    mask : (H, W) array
        Nonzero pixels are foreground.
    return_distance : bool
        Return the distances to the background as well.
    threads : int
        Number of threads; 0 uses all.

    Returns
    -------
    axis : (H, W) bool array
        The pixels.
    distance : (H, W) float64 array
        As of `distance_transform`, between centers of pixels: only with `return_distance`.

    Raises
    ------
    InputError
        If the mask is no image; or has no zero pixel, with `return_distance`.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.2.

    Examples
    --------
    >>> medial_axis(np.ones((3, 9))).astype(int).tolist()
    [[0, 0, 0, 0, 0, 0, 0, 0, 0], [0, 1, 1, 1, 1, 1, 1, 1, 0], [0, 0, 0, 0, 0, 0, 0, 0, 0]]
    """
    return_distance = checked_flag(return_distance, "return_distance")
    foreground = plane(mask, "mask") != 0
    axis = np.zeros(foreground.shape, np.bool_)
    if foreground.any():
        skeleton = skeleton_exact(outlines(foreground, threads=threads), threads=threads)
        limits: dict[str, Any] = dict([default_pruning_for_masks()])
        pruned = prune(skeleton, threads=threads, **limits)
        x, y = np.floor(points_along(pruned, every=_STEP).xy + 0.5).astype(np.int64).T
        axis[y, x] = True
        axis &= foreground
        axis |= _false_holes(axis, foreground)
    return (axis, distance_transform(foreground, threads=threads)) if return_distance else axis


def _false_holes(axis: NDArray[np.bool_], foreground: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the pixels that an axis encloses without any background: two branches beside each other may."""
    components = numbered_components(~axis, 4)
    is_true = reaches_border(components)
    is_true[components[~foreground]] = True
    return ~(is_true[components] | axis)


def local_thickness(
    mask: ImageLike,
    *,
    outline: OutlineKind = "crack",
    connectivity: int = 8,
    spacing: Spacing | None = None,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
    progress: Progress = None,
) -> NDArray[np.float64]:
    """Compute for each pixel of an object the diameter of the largest inscribed disc that covers it.

    That is the local thickness of bone and pore analysis, of each component of a mask, or of each label, by itself.
    The discs are inside the outline of the object (see :func:`vorotool.outlines`), and their centers are all places of
    its exact skeleton: no set of radii is chosen, and no distance is counted in pixels. Values are exact but for
    rounding. Discs are closed: a pixel whose center is on the rim is covered, and to see that in spite of rounding a
    disc covers what is at most 64 units in the last place of the image's larger side beyond it.

    Parameters
    ----------
    mask : (H, W) array
        Nonzero pixels are foreground. With several values, or one that is none of a mask, these are labels.
    outline : {"crack", "contour"}
        Around the pixels, or half-way between the centers of pixels inside and outside.
    connectivity : {8, 4}
        Of the pixels of an object.
    spacing : float, (height, width) or "auto", optional
        Sides of a pixel, by default 1. A float is the decimal number that it is written as.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    max_pixels : int
        Larger images are refused before memory is allocated.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    (H, W) float64 array
        In the unit of the spacing; 0 at pixels without an object.

    Raises
    ------
    InputError
        If the mask is no image.
    LimitError
        If it has more than `max_pixels` pixels.
    UsageError
        If an option is invalid.

    References
    ----------
    Hildebrand and Rüegsegger, "A new method for the model-independent assessment of thickness in three-dimensional
    images", Journal of Microscopy 185, 1997.

    Examples
    --------
    >>> local_thickness([[1, 1, 1, 0, 0], [1, 1, 1, 1, 1], [1, 1, 1, 0, 0]])[1].tolist()
    [3.0, 3.0, 3.0, 1.0, 1.0]
    """
    values = plane(mask, "mask")
    sides = asked_sides(mask, spacing)
    height, width = values.shape
    require_memory(Frame(0, 0, max(width, 1), max(height, 1)), max_pixels)
    if not values.any():
        return np.zeros(values.shape)
    shapes = outlines(Raster(values), outline=outline, connectivity=connectivity, threads=threads, progress=progress)
    if sides.units != (1, 1):
        from dataclasses import replace

        shapes = replace(shapes, xy=shapes.xy * (sides.x, sides.y), frame=None)
    skeleton = skeleton_exact(shapes, threads=threads, progress=progress)
    made = thickness_of_pixels(skeleton, values.shape, sides=(sides.y, sides.x), threads=threads, progress=progress)
    return made if sides.step == 1 else made * sides.step.numerator / sides.step.denominator
