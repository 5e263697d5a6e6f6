"""Sets of integers as sorted arrays.

NumPy finds distinct values by hashing since 2.3: a million different ones take 20 times as long as sorting them does.
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Integer = TypeVar("Integer", bound=np.integer[Any])


def distinct(values: NDArray[Integer]) -> NDArray[Integer]:
    """Each value once, increasing."""
    found = np.sort(values, axis=None)
    is_new = np.ones(len(found), dtype=bool)
    np.not_equal(found[1:], found[:-1], out=is_new[1:])
    return found[is_new]


def is_among(values: NDArray[Integer], chosen: NDArray[Integer]) -> NDArray[np.bool_]:
    """Whether each value is one of those that are chosen."""
    found = distinct(chosen)
    if not len(found):
        return np.zeros(np.shape(values), dtype=bool)
    place = np.searchsorted(found, values)
    return np.asarray(found[np.minimum(place, len(found) - 1)] == values)
