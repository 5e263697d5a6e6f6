"""Seeds that no other pixel needs: the inside of large objects, which an image brings along pixel by pixel."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.types.pixel_frame import Frame
from vorotool.types.points.seed_set import SeedSet

CHUNK = 1 << 20
"""Seeds that are painted at a time: what that needs beside them stays small."""


def needed_seeds(seeds: SeedSet) -> NDArray[np.intp] | None:
    """Find the seeds that still give every other pixel its label, where that leaves many out."""
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
    """Find the pixels that have the value of their four neighbors; those at the sides have not four."""
    inside = np.zeros(image.shape, bool)
    center, surrounded = image[1:-1, 1:-1], inside[1:-1, 1:-1]
    np.equal(center, image[1:-1, :-2], out=surrounded)
    for neighbor in (image[1:-1, 2:], image[:-2, 1:-1], image[2:, 1:-1]):
        surrounded &= center == neighbor
    return inside


def _may_be_surrounded(seeds: SeedSet) -> bool:
    """Whether the seeds are in raster order, and most of them follow one of their label."""
    same_label = np.count_nonzero(seeds.labels[1:] == seeds.labels[:-1])
    if 2 * same_label <= len(seeds):
        return False
    same_row = seeds.y[1:] == seeds.y[:-1]
    return bool(((seeds.x[1:] > seeds.x[:-1]) | ~same_row).all() and (seeds.y[1:] >= seeds.y[:-1]).all())


def paint_seeds(rows: NDArray[Any], seeds: SeedSet, frame: Frame, value: int | None = None) -> None:
    """Set the pixels on which seeds lie, to their labels or to one value."""
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
