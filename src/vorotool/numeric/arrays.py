"""Arrays: their types, and ragged ones, by the lengths of their rows or where these start."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import DTypeLike, NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Numbers = NDArray[np.intp]
Booleans = NDArray[np.bool_]


Lengths = NDArray[Any] | Sequence[int]


class Columns:
    """Arrays of the same length, the fields of a data class: rows are chosen and joined of all of them."""

    def __getitem__(self, chosen: NDArray[np.generic]) -> Self:
        return type(self)(*(getattr(self, name)[chosen] for name in self.__annotations__))

    def joined(self, more: Self) -> Self:
        """Return these rows and others."""
        return type(self)(
            *(np.concatenate([getattr(self, name), getattr(more, name)]) for name in self.__annotations__)
        )


class Nesting(NamedTuple):
    """Where the vertices of each ring begin, the rings of each polygon, the polygons of each cell; and the ends."""

    rings: NDArray[np.int64]
    polygons: NDArray[np.int64]
    cells: NDArray[np.int64]


def objects(values: Collection[Any]) -> NDArray[np.object_]:
    """Return values of any kind as a column; tuples and sequences are not taken apart."""
    return np.fromiter(values, dtype=object, count=len(values))


def starts_of(lengths: Lengths) -> Indices:
    """Where each row begins, and the end of the last."""
    starts = np.zeros(np.size(lengths) + 1, dtype=np.int64)
    np.cumsum(lengths, dtype=np.int64, out=starts[1:])
    return starts


def divides(starts: NDArray[Any], count: int, least: int = 0) -> bool:
    """Whether these are the starts of rows of so many items in all, of at least some each."""
    return bool(len(starts) and starts[0] == 0 and starts[-1] == count and (np.diff(starts) >= least).all())


def dots(u: NDArray[Any], v: NDArray[Any]) -> NDArray[Any]:
    """Scalar products of vectors, along the last axis: a sum column after column is faster than one of rows."""
    made: NDArray[Any] = u[..., 0] * v[..., 0]
    for axis in range(1, u.shape[-1]):
        made = made + u[..., axis] * v[..., axis]
    return made


def crosses(u: NDArray[Any], v: NDArray[Any]) -> NDArray[Any]:
    """Twice the signed areas of the triangles of vectors of the plane, along the last axis."""
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def norms(ways: NDArray[Any]) -> Floats:
    """Lengths of vectors, along the last axis; the same on every machine, as hypot is not."""
    return np.sqrt(dots(ways, ways))


def owners(lengths: Lengths, dtype: DTypeLike = np.int64) -> NDArray[Any]:
    """The row of each item."""
    return np.repeat(np.arange(np.size(lengths), dtype=dtype), lengths)


def within(lengths: Lengths) -> Indices:
    """The place of each item in its row."""
    return ranges(np.zeros(np.size(lengths), dtype=np.int64), lengths)


def mask_of(chosen: NDArray[Any], count: int) -> Booleans:
    """Tell of so many numbers from 0 which are chosen."""
    mask = np.zeros(count, dtype=bool)
    mask[chosen] = True
    return mask


def ranks_of(chosen: NDArray[Any], count: int, dtype: DTypeLike = np.int64) -> NDArray[Any]:
    """The place of each of so many numbers from 0 in a list; -1 of those that it lacks."""
    ranks = np.full(count, -1, dtype=dtype)
    ranks[chosen] = np.arange(len(chosen))
    return ranks


def ranges(first: NDArray[Any], lengths: Lengths) -> Indices:
    """Indices of the items of chosen rows, row after row: first, first + 1, … of each."""
    starts = starts_of(lengths)
    return np.arange(starts[-1]) + np.repeat(first - starts[:-1], lengths)


def following(starts: NDArray[Any]) -> Indices:
    """The item after each one in its row, which is a ring: after the last comes the first. Rows have items."""
    after = np.arange(1, starts[-1] + 1, dtype=np.int64)
    after[starts[1:] - 1] = starts[:-1]
    return after


def with_length(
    points: NDArray[np.float64], start: NDArray[Any]
) -> tuple[NDArray[np.float64], Indices, NDArray[np.bool_]]:
    """Leave out polylines whose points all are one place: the other points, their starts, and which lines are left."""
    moves = np.zeros(len(points), dtype=bool)
    moves[1:] = (points[1:] != points[:-1]).any(axis=1)
    moves[start[:-1]] = False
    sizes = np.diff(start)
    has_length = np.add.reduceat(moves, start[:-1], dtype=np.int64) > 0 if len(sizes) else np.zeros(0, dtype=bool)
    if has_length.all():
        return points, start.astype(np.int64), has_length
    return points[np.repeat(has_length, sizes)], starts_of(sizes[has_length]), has_length


def connected_roots(pairs: NDArray[np.integer], count: int) -> NDArray[np.int64]:
    """(count,) the smallest number that each is connected with by pairs."""
    from vorotool import _core

    return _core.graphs.connected_components(pairs.reshape(-1, 2).astype(np.int32), count).astype(np.int64)
