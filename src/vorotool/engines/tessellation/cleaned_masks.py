"""Masks without holes and without small objects."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.raster_objects import numbered_components
from vorotool.errors import UsageError
from vorotool.geometry.checks import is_choice
from vorotool.geometry.numbers import shown_number


class CleanedMask(NamedTuple):
    """A mask, and what was done to it.

    Parameters
    ----------
    mask : (H, W) bool array
        The foreground.
    filled : int
        Pixels of holes that are foreground now.
    removed, objects : int
        Objects that were left out, of how many.
    """

    mask: NDArray[np.bool_]
    filled: int
    removed: int
    objects: int


def cleaned_mask(
    mask: NDArray[np.bool_],
    *,
    min_area: int = 0,
    fill_holes: bool = False,
    connectivity: int = 8,
    missing: NDArray[np.bool_] | None = None,
) -> CleanedMask:
    """Fill the holes of the objects of a mask, and then leave out the objects that are small.

    A hole is a component of the background that does not reach the border of the image. Where pixels of objects are
    connected over corners, those of the background are not, and the other way round.

    Parameters
    ----------
    mask : (H, W) bool array
        The foreground.
    min_area : int
        Pixels that an object has at least, its filled holes included.
    fill_holes : bool
        Whether holes become foreground.
    connectivity : {8, 4}
        Of the pixels of an object.
    missing : (H, W) bool array, optional
        Pixels that stay background.

    Raises
    ------
    UsageError
        If the connectivity is another.

    Examples
    --------
    >>> ring = np.array([[1, 1, 1, 0, 1], [1, 0, 1, 0, 0], [1, 1, 1, 0, 0]], dtype=bool)
    >>> made = cleaned_mask(ring, min_area=2, fill_holes=True)
    >>> int(made.mask.sum()), made.filled, made.removed
    (9, 1, 1)
    """
    if not is_choice(connectivity, (4, 8)):
        raise UsageError(f"connectivity is {shown_number(connectivity)}: it must be 4 or 8")
    made = _filled(mask, 12 - connectivity) if fill_holes else mask
    if missing is not None:
        made = made & ~missing
    filled = int(np.count_nonzero(made)) - int(np.count_nonzero(mask))
    if min_area <= 1:
        return CleanedMask(made, filled, 0, 0)
    components = numbered_components(made, connectivity)
    areas = np.bincount(components.ravel())
    kept = areas >= min_area
    kept[0] = False
    return CleanedMask(kept[components], filled, len(areas) - 1 - int(np.count_nonzero(kept)), len(areas) - 1)


def _filled(mask: NDArray[np.bool_], connectivity: int) -> NDArray[np.bool_]:
    """The mask with what of its background does not reach the border."""
    background = numbered_components(~mask, connectivity)
    reaches = reaches_border(background)
    reaches[0] = False
    return ~reaches[background]


def reaches_border(components: NDArray[np.uint32]) -> NDArray[np.bool_]:
    """Return for each number whether a pixel at the border of the image has it.

    Examples
    --------
    >>> reaches_border(np.array([[1, 1, 1], [1, 2, 1], [1, 1, 1]], np.uint32)).tolist()
    [False, True, False]
    """
    reaches = np.zeros(int(components.max(initial=0)) + 1, dtype=bool)
    for side in (components[0], components[-1], components[:, 0], components[:, -1]):
        reaches[side] = True
    return reaches
