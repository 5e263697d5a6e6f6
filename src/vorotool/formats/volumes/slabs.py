"""Volumes that pass by as slabs of slices."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray


def checked_slabs(slabs: Iterable[NDArray[Any]], shape: tuple[int, int, int]) -> Iterator[NDArray[Any]]:
    """Pass on slabs of shape (slices, H, W), and see that they are D slices together."""
    depth, height, width = shape
    seen = 0
    for item in slabs:
        slab = np.asarray(item)
        if slab.ndim != 3 or slab.shape[1:] != (height, width):
            raise ValueError(f"a slab has shape {slab.shape}: it must be (slices, {height}, {width})")
        seen += len(slab)
        if seen > depth:
            break
        yield slab
    if seen != depth:
        raise ValueError(f"the slabs have {'more than ' * (seen > depth)}{min(seen, depth)} slices, not {depth}")
