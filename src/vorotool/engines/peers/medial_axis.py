"""The axis of a mask as pixels, by the name of `skimage.morphology.medial_axis`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.from_skeleton.points_along import points_along
from vorotool.engines.label_images.outlines import outlines
from vorotool.engines.peers.arguments import plane
from vorotool.engines.peers.distance_transform import distance_transform
from vorotool.engines.pruning.pruning import default_pruning_for_masks, prune
from vorotool.engines.skeleton_api import skeleton_exact
from vorotool.engines.tessellation.cleaned_masks import reaches_border
from vorotool.engines.tessellation.raster_objects import numbered_components
from vorotool.numeric.checks import checked_flag

if TYPE_CHECKING:
    from vorotool.typing import ImageLike

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
