"""An exact check of digital tessellations, by another way than the one that makes them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common import label_array
from vorotool.errors import InputError, UsageError, VerificationError
from vorotool.numeric.checks import checked_threads
from vorotool.types.pixel_frame import Frame
from vorotool.types.points.label_image import LabelImage
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.spacing import SQUARE, PixelSides

_FARTHEST = 2**61


def verify_label_image(
    labels: NDArray[Any],
    seeds: SeedSet,
    frame: Frame,
    *,
    max_distance2: int | None = None,
    sides: PixelSides = SQUARE,
    threads: int = 0,
) -> None:
    """Check a tessellation exactly, by another way than the one that makes it."""
    image = LabelImage(labels, frame)
    high, low = split_limit(max_distance2)
    left, top = -(frame.width // 2), -(frame.height // 2)  # seen from the middle, as the engine has them
    x = _from_origin(seeds.x, seeds.scale * (frame.x - left), sides.x)
    y = _from_origin(seeds.y, seeds.scale * (frame.y - top), sides.y)
    try:
        wrong = _core.tessellation.verify_tessellation(
            label_array(image.labels),
            left,
            top,
            x,
            y,
            seeds.labels,
            (seeds.scale * sides.x, seeds.scale * sides.y),
            high,
            low,
            checked_threads(threads),
            None,
        )
    except IndexError as error:
        raise InputError(
            f"the result cannot be verified: {error}; move the frame and the seeds nearer to each other"
        ) from error
    if wrong.count:
        raise VerificationError(
            f"{wrong.count} of {frame.pixels} pixels {'is' if wrong.count == 1 else 'are'} wrong: the first, (x, y) = "
            f"({frame.x + wrong.column}, {frame.y + wrong.row}), has label {image.labels[wrong.row, wrong.column]}, "
            f"not {wrong.right}"
        )


def _from_origin(coordinates: NDArray[np.int64], origin: int, side: int) -> NDArray[np.int64]:
    """Return coordinates relative to an origin, from where they are within the limit of the core."""
    if abs(origin) > _FARTHEST:
        raise InputError(
            "the result cannot be verified: the frame is too far from the origin for its lattice; move the frame nearer"
        )
    return on_lattice(coordinates.clip(-2 * _FARTHEST, 2 * _FARTHEST) - origin, side)


def on_lattice(coordinates: NDArray[np.int64], side: int) -> NDArray[np.int64]:
    """Coordinates of seeds in steps of the lattice; what would not fit is left beyond the limit of the core."""
    most = 2**62 // side
    return coordinates.clip(-most, most) * side


def split_limit(limit: int | None) -> tuple[int | None, int]:
    """Halves of a 128-bit limit; no squared distance exceeds 128 bits."""
    if limit is None or limit >= 1 << 128:
        return None, 0
    if limit < 0:
        raise UsageError(f"max_distance2 is {limit}: it must not be negative")
    return int(limit) >> 64, int(limit) & 0xFFFFFFFFFFFFFFFF
