"""Sums by label over long lists, without copies of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

CHUNK = 1 << 22
"""Entries that are counted at a time."""


def numbered(labels: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Give the distinct labels, and the index of each one among them: by a table unless the labels are sparse."""
    largest = int(labels.max())
    if largest > 4 * labels.size + 65536:
        return np.unique(labels, return_inverse=True)
    present = np.zeros(largest + 1, bool)
    for part in parts(len(labels), CHUNK):
        present[labels[part]] = True
    distinct = np.flatnonzero(present)
    if len(distinct) == largest:
        return distinct, labels - labels.dtype.type(1)  # labels 1 to n: the commonest
    return distinct, (np.cumsum(present, dtype=np.uint32) - np.uint32(1))[labels]


def parts(count: int, size: int) -> Iterator[slice]:
    """Cut a list of so many into slices of a size."""
    for start in range(0, count, size):
        yield slice(start, start + size)


def sums(index: NDArray[Any], kinds: int, weights: NDArray[Any] | None = None) -> NDArray[Any]:
    """Give the sums of weights by index, part by part: NumPy would copy all of both to 64 bits."""
    total = np.zeros(kinds, np.int64 if weights is None else np.float64)
    for part in parts(len(index), max(CHUNK, kinds)):
        total += np.bincount(index[part], None if weights is None else weights[part], minlength=kinds)
    return total
