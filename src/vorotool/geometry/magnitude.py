"""How large and how small lengths may be where skeletons are computed in floating point."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError
from vorotool.geometry.box import bounds

LARGEST = 1e70
"""Magnitude of lengths and coordinates: products of four of these, or of parts of them, are floating-point numbers."""


def check_magnitude(xy: NDArray[np.float64]) -> None:
    """Refuse vertices so far away, or so near each other, that products of distances are no numbers.

    Parameters
    ----------
    xy : (n, 2) array
        Finite.

    Raises
    ------
    InputError
        If a coordinate is beyond 1e70, or the extent below 1e-70 and not 0.

    Examples
    --------
    >>> check_magnitude(np.array([[0, 0], [1e300, 0]]))
    Traceback (most recent call last):
    vorotool.errors.InputError: a coordinate is 1e+300, too large to compute with: scale them to 1e+70 at most
    """
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
    """Refuse lengths and coordinates of options that are beyond those of shapes.

    Raises
    ------
    UsageError
        With the first such value.

    Examples
    --------
    >>> check_lengths((2.0, -1e90), "distance")
    Traceback (most recent call last):
    vorotool.errors.UsageError: a distance of -1e+90 is too large to compute with: use at most 1e+70
    """
    for value in values:
        if not abs(value) <= LARGEST:
            raise UsageError(f"a {noun} of {value:g} is too large to compute with: use at most {LARGEST:g}")
