"""Images that pass by as bands of rows, and volumes as slabs of slices: checking, and regrouping."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import LimitError, option

_WIDER = option("-o labels.tif or .npy", "the path labels.tif or labels.npy")
_SIGNED = option("-o labels.npy", "the path labels.npy")

BLOCK_BYTES = 1 << 20
"""Bytes of a block: its own code tables cost nothing, and it stays in the cache."""


def checked(bands: Iterable[NDArray[Any]], shape: tuple[int, ...]) -> Iterator[NDArray[Any]]:
    """Pass on bands of rows, or slabs of slices, and see that together they have a shape."""
    seen = 0
    for item in bands:
        band = np.asarray(item)
        if band.shape[1:] != shape[1:] or band.ndim != len(shape):
            raise ValueError(f"a band has shape {band.shape}: it must be (rows, {', '.join(map(str, shape[1:]))})")
        seen += len(band)
        if seen > shape[0]:
            break
        yield band
    if seen != shape[0]:
        raise ValueError(f"the bands have {'more than ' * (seen > shape[0])}{min(seen, shape[0])} rows, not {shape[0]}")


def check_fits(band: NDArray[Any], largest: int, target: str) -> None:
    """Refuse values that ``target`` cannot hold: nothing is ever wrapped."""
    if band.size == 0 or band.dtype.kind == "b":
        return
    if np.iinfo(band.dtype).max > largest and (top := int(band.max())) > largest:
        raise LimitError(f"the value {top} does not fit in {target}, which ends at {largest}: use {_WIDER}")
    if band.dtype.kind == "i" and (low := int(band.min())) < 0:
        raise LimitError(f"the value {low} does not fit in {target}, which begins at 0: use {_SIGNED}")


def blocks(
    bands: Iterable[NDArray[Any]],
    shape: tuple[int, ...],
    *,
    columns: int,
    dtype: DTypeLike,
    encode: Callable[[NDArray[Any], NDArray[Any]], None],
) -> Iterator[NDArray[Any]]:
    """Regroup bands into blocks whose limits depend on the shape alone, so that the bytes written do too."""
    row_bytes = max(1, columns * np.dtype(dtype).itemsize)
    rows = max(1, min(shape[0], BLOCK_BYTES // row_bytes))
    block, filled = np.zeros((1 + rows, columns), dtype), 1
    for band in checked(bands, shape):
        start = 0
        while start < len(band):
            take = min(1 + rows - filled, len(band) - start)
            encode(band[start : start + take], block[filled : filled + take])
            start, filled = start + take, filled + take
            if filled > rows:
                last = block[-1]
                yield block
                block, filled = np.empty_like(block), 1
                block[0] = last
    if filled > 1:
        yield block[:filled]
