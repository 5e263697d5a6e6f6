"""Local thickness of masks, by the name of `porespy.filters.local_thickness`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.spacings import asked_sides
from vorotool.engines.from_skeleton.thickness import thickness_of_pixels
from vorotool.engines.label_images.outlines import outlines
from vorotool.engines.peers.arguments import plane
from vorotool.engines.skeleton_api import skeleton_exact
from vorotool.engines.tessellation.frames import require_memory
from vorotool.numeric.progress import Progress
from vorotool.types.pixel_frame import MAX_PIXELS, Frame
from vorotool.types.points.raster import Raster

if TYPE_CHECKING:
    from vorotool.typing import ImageLike, OutlineKind, Spacing


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
