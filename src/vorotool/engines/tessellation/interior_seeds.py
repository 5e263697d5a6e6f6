"""Seeds that no other pixel needs: the inside of large objects, which an image brings along pixel by pixel."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.pixel_frame import Frame
from vorotool.geometry.points.seed_set import SeedSet

CHUNK = 1 << 20
"""Seeds that are painted at a time: what that needs beside them stays small."""


def needed_seeds(seeds: SeedSet) -> NDArray[np.intp] | None:
    """Find the seeds that still give every other pixel its label, where that leaves many out.

    A seed is surrounded if its four neighbours on the pixel lattice are seeds of its label. From a surrounded
    seed one step towards any other pixel leads to a seed of the same label that is strictly nearer to that
    pixel. So among the nearest seeds of a pixel none is surrounded, but for the seed on the pixel itself: the
    others give the same labels and distances everywhere except on the seeds, and there `paint_seeds` puts them.

    Parameters
    ----------
    seeds : SeedSet
        Of any kind.

    Returns
    -------
    (k,) index array or None
        Increasing indices of the seeds that are not surrounded; None where all seeds should be used: they lie
        between pixels, two share a place, they are not in raster order, or are too sparse to surround each
        other.

    Examples
    --------
    >>> y, x = (k.ravel() for k in np.indices((5, 5)))
    >>> len(needed_seeds(SeedSet(x, y, np.ones(25))))
    16
    """
    if seeds.scale != 1 or not _may_be_surrounded(seeds):
        return None
    left, top = int(seeds.x.min()), int(seeds.y[0])
    width, height = int(seeds.x.max()) - left + 1, int(seeds.y[-1]) - top + 1
    if width * height > 4 * len(seeds):
        return None
    image = np.zeros((height, width), np.uint32)
    paint_seeds(image, seeds, Frame(left, top, width, height))
    if np.count_nonzero(image) != len(seeds):
        return None
    return np.flatnonzero(
        ~surrounded_pixels(image)[image != 0]
    )  # a mask takes values in raster order, as the seeds are


def surrounded_pixels(image: NDArray[Any]) -> NDArray[np.bool_]:
    """Find the pixels that have the value of their four neighbours; those at the sides have not four.

    Examples
    --------
    >>> surrounded_pixels(np.ones((3, 3)))[1].tolist()
    [False, True, False]
    """
    inside = np.zeros(image.shape, bool)
    centre, surrounded = image[1:-1, 1:-1], inside[1:-1, 1:-1]
    np.equal(centre, image[1:-1, :-2], out=surrounded)
    for neighbour in (image[1:-1, 2:], image[:-2, 1:-1], image[2:, 1:-1]):
        surrounded &= centre == neighbour
    return inside


def _may_be_surrounded(seeds: SeedSet) -> bool:
    """Whether the seeds are in raster order, and most of them follow one of their label."""
    same_label = np.count_nonzero(seeds.labels[1:] == seeds.labels[:-1])
    if 2 * same_label <= len(seeds):
        return False
    same_row = seeds.y[1:] == seeds.y[:-1]
    return bool(((seeds.x[1:] > seeds.x[:-1]) | ~same_row).all() and (seeds.y[1:] >= seeds.y[:-1]).all())


def paint_seeds(rows: NDArray[Any], seeds: SeedSet, frame: Frame, value: int | None = None) -> None:
    """Set the pixels on which seeds lie, to their labels or to one value.

    Parameters
    ----------
    rows : (h, w) array
        Written in place.
    seeds : SeedSet
        On pixels, in raster order.
    frame : Frame
        Where the rows lie.
    value : int, optional
        Instead of the labels.

    Examples
    --------
    >>> rows = np.zeros((1, 4), np.uint8)
    >>> paint_seeds(rows, SeedSet(np.array([3, 9]), np.array([5, 5]), np.array([7, 8])), Frame(1, 5, 4, 1))
    >>> rows
    array([[0, 0, 7, 0]], dtype=uint8)
    """
    first, last = np.searchsorted(seeds.y, [frame.y, frame.y + frame.height])
    for start in range(int(first), int(last), CHUNK):
        part = slice(start, min(start + CHUNK, int(last)))
        x, y = seeds.x[part] - frame.x, seeds.y[part] - frame.y
        labels: Any = seeds.labels[part] if value is None else value
        inside = (x >= 0) & (x < frame.width)
        if not inside.all():
            x, y = x[inside], y[inside]
            labels = labels[inside] if value is None else value
        rows[y, x] = labels
