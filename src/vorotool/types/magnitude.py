"""How large and how small lengths may be where skeletons are computed in floating point."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError
from vorotool.types.box import bounds

LARGEST = 1e70
"""Magnitude of lengths and coordinates: products of four of these, or of parts of them, are floating-point numbers."""


def check_magnitude(xy: NDArray[np.float64]) -> None:
    """Refuse vertices so far away, or so near each other, that products of distances are no numbers."""
    if not len(xy):
        return
    low, high = bounds(xy)
    largest = float(max(-low.min(), high.max()))
    if largest > LARGEST:
        raise InputError(f"a coordinate is {largest:g}, too large to compute with: scale them to {LARGEST:g} at most")
    extent = float((high - low).max())
    if 0 < extent < 1 / LARGEST:
        raise InputError(f"the extent is {extent:g}, too small to compute with: scale it to {1 / LARGEST:g} at least")


def check_lengths(values: Iterable[float], noun: str) -> None:
    """Refuse lengths and coordinates of options that are beyond those of shapes."""
    for value in values:
        if not abs(value) <= LARGEST:
            raise UsageError(f"a {noun} of {value:g} is too large to compute with: use at most {LARGEST:g}")
