"""What several engines share: label arrays, and the faults that checkers report."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, VerificationError
from vorotool.numeric.arrays import Floats, Indices, dots, following, norms
from vorotool.numeric.checks import as_array


def label_array(labels: NDArray[Any], what: str = "pixel") -> NDArray[Any]:
    """Labels as the core takes them, without a copy where possible; a negative int32 becomes one >= 2^31."""
    labels = np.ascontiguousarray(labels)
    native = labels.dtype.newbyteorder("=")
    if native.itemsize == 8:
        for bad in (labels.min(initial=0), labels.max(initial=0)):
            if not 0 <= int(bad) <= 0xFFFFFFFF:
                raise InputError(f"a {what} has label {bad}: labels must be from 0 to 4294967295")
        return labels.astype(np.uint32)
    return labels.astype(native, copy=False).view(f"u{native.itemsize}")


def refuse_negative(dtype: np.dtype[Any], largest: int, what: str = "pixel") -> None:
    """Refuse negative labels: the core takes them as unsigned, so they come back beyond the signed range."""
    bits = 8 * dtype.itemsize
    if dtype.kind == "i" and bits < 64 and largest >= 1 << (bits - 1):
        raise InputError(f"a {what} has label {largest - (1 << bits)}: labels must not be negative")


def next_row(row: NDArray[Any] | None, name: str, labels: NDArray[Any]) -> NDArray[Any] | None:
    """Return a row next to a band of labels, or a slice next to a slab, in the type of the labels."""
    if row is None:
        return None
    row = as_array(row, name)
    called = f"the {'row' if labels.ndim == 2 else 'slice'} {name}"
    if row.shape != labels.shape[1:]:
        raise InputError(f"{called} has shape {row.shape}, but the labels {labels.shape}")
    row = label_array(row)
    if not np.can_cast(row.dtype, labels.dtype):
        raise InputError(f"{called} has type {row.dtype}, but the labels {labels.dtype}: use one type")
    return row.astype(labels.dtype, copy=False)


def described(array: Any) -> str:
    """Name the type and shape of what was given as an array."""
    return f"{array.dtype} of shape {array.shape}" if isinstance(array, np.ndarray) else f"a {type(array).__name__}"


def nearest_on_segments(places: Floats, a: Floats, b: Floats) -> Floats:
    """(…, 2) the nearest place to each on a segment, which may have no length."""
    way = b - a
    square = dots(way, way)
    share = np.divide(dots(places - a, way), square, out=np.zeros_like(square), where=square > 0)
    return a + np.clip(share, 0, 1)[..., None] * way


def off_segments(places: Floats, a: Floats, b: Floats) -> Floats:
    """(n,) how far each place is from a segment, which may have no length."""
    return norms(places - nearest_on_segments(places, a, b))


def twice_areas(xy: Floats, start: Indices) -> Floats:
    """(r,) of rings, positive counter-clockwise."""
    first = np.repeat(xy[start[:-1]], np.diff(start), axis=0)
    (x, y), (u, v) = (xy - first).T, (xy[following(start)] - first).T
    return np.add.reduceat(x * v - y * u, start[:-1]) if len(xy) else np.zeros(0)


def fail(message: str) -> None:
    """Raise VerificationError."""
    raise VerificationError(message)


def first_wrong(wrong: NDArray[np.bool_]) -> int | None:
    """Where the first of some faults is, if any."""
    at = np.flatnonzero(wrong)
    return int(at[0]) if at.size else None
