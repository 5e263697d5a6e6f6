"""The nearest seed of each column above or below a line: all that a band of an image needs of the other bands."""

from __future__ import annotations

import zlib

import numpy as np
from numpy.typing import NDArray

from vorotool.plain import plain


@plain
class ColumnEnvelope:
    """At most one seed a column."""

    row: NDArray[np.int32]  # (W,) int32 array: its row
    label: NDArray[np.uint32]  # (W,) uint32 array: its label; 0 where there is none

    @classmethod
    def empty(cls, width: int) -> ColumnEnvelope:
        """No seed in any column."""
        return cls(np.zeros(width, np.int32), np.zeros(width, np.uint32))

    def or_else(self, farther: ColumnEnvelope) -> ColumnEnvelope:
        """These seeds, and in the columns that have none those of another list."""
        has = self.label != 0
        return ColumnEnvelope(np.where(has, self.row, farther.row), np.where(has, self.label, farther.label))

    def numbered(self, number: NDArray[np.uint32]) -> ColumnEnvelope:
        """The list with other labels, from a table."""
        return ColumnEnvelope(self.row, number[self.label])

    def seeds(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.uint32]]:
        """Columns, rows and labels of the seeds."""
        x = np.flatnonzero(self.label)
        return x, self.row[x].astype(np.int64), self.label[x]

    def packed(self) -> bytes:
        """Give a short form: neighboring columns are much alike."""
        change = np.diff(self.row, prepend=np.int32(0))
        return zlib.compress(change.tobytes() + self.label.tobytes(), 1)

    @classmethod
    def unpacked(cls, data: bytes) -> ColumnEnvelope:
        """Give the list back."""
        row, label = np.frombuffer(zlib.decompress(data), np.uint32).reshape(2, -1)
        return cls(np.cumsum(row.view(np.int32), dtype=np.int32), label)


def last_seeds(objects: NDArray[np.uint32], first: int) -> ColumnEnvelope:
    """The lowest seed of each column, of rows from ``first`` on, which have labels and 0."""
    found = ColumnEnvelope.empty(objects.shape[1])
    for row, line in enumerate(objects, start=first):
        _put(found, row, line)
    return found


def first_seeds(objects: NDArray[np.uint32], first: int) -> ColumnEnvelope:
    """The uppermost seed of each column."""
    found = ColumnEnvelope.empty(objects.shape[1])
    for row in range(len(objects) - 1, -1, -1):
        _put(found, first + row, objects[row])
    return found


def _put(found: ColumnEnvelope, row: int, line: NDArray[np.uint32]) -> None:
    has = line != 0
    np.copyto(found.row, row, where=has)
    np.copyto(found.label, line, where=has)
