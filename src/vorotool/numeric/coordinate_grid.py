"""The grid of the coordinates of a file: multiples of a power of ten, or the doubles themselves."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError, option
from vorotool.numeric.arrays import Floats
from vorotool.numeric.numbers import shown_number, whole_number
from vorotool.plain import plain

Integers = NDArray[np.int64]

MOST_DECIMALS = 17

_EXACT = 2.0**52
"""Numbers of steps below this, and the results of dividing them by a power of ten, are distinct doubles."""


_DECIMALS: ContextVar[int | None] = ContextVar("decimals", default=None)
_IS_VERIFIED: ContextVar[bool] = ContextVar("is_verified", default=False)


@dataclass
class Written:
    """What is known of coordinates once they are written."""

    deviation: float = 0.0  # the largest distance of lines from the curves that they stand for
    has_y_down: bool = False
    crs: Any = None  # the coordinate reference system of the value
    has_places: bool = False  # of a table: some of its columns are coordinates
    system_unread: Any = None  # the coordinate reference system of a file whose readers assume another one


_WRITTEN: ContextVar[Written | None] = ContextVar("written", default=None)


def record_deviation(distances: Floats) -> None:
    """Record how far lines that are written are from their curves."""
    written = _WRITTEN.get()
    if written is not None:
        written.deviation = max(written.deviation, float(distances.max(initial=0)))


def record_system_unread(crs: Any) -> None:
    """Record that readers of what is written do not look at its coordinate reference system."""
    written = _WRITTEN.get()
    if written is not None:
        written.system_unread = crs


def record_places() -> None:
    """Record that a table that is written has coordinates."""
    written = _WRITTEN.get()
    if written is not None:
        written.has_places = True


def record_value(value: Any) -> None:
    """Record the coordinate reference system of a value that is written, and whether its y goes down."""
    written = _WRITTEN.get()
    if written is not None:
        written.crs = getattr(value, "crs", None)
        written.has_y_down = written.has_y_down or getattr(value, "y_axis", None) == "down"


@contextmanager
def coordinates_written(decimals: int | None, *, is_verified: bool = False) -> Iterator[Written]:
    """Say how coordinates of files are written within."""
    name = option("--decimals")
    if decimals is not None and not 0 <= whole_number(decimals, name) <= MOST_DECIMALS:
        raise UsageError(f"{name} is {shown_number(decimals)}: use 0 to {MOST_DECIMALS}, or leave it out")
    written = Written()
    tokens = _DECIMALS.set(decimals), _IS_VERIFIED.set(is_verified), _WRITTEN.set(written)
    try:
        yield written
    finally:
        _DECIMALS.reset(tokens[0])
        _IS_VERIFIED.reset(tokens[1])
        _WRITTEN.reset(tokens[2])


def current_decimals() -> int | None:
    """Return the decimals of the coordinates of the file that is being written."""
    return _DECIMALS.get()


@plain
class Grid:
    """Multiples of a step: of 10 to the power -decimals, or of 2 to the power of the exponent."""

    decimals: int | None
    exponent: int = 0

    @classmethod
    def of(cls, points: Floats, decimals: int | None) -> Grid:
        """Make the grid of these coordinates: powers of two where doubles are coarser than the decimals."""
        most = float(np.abs(points).max(initial=0))
        if decimals is not None and most * float(10**decimals) < _EXACT:
            return cls(decimals)
        return cls(None, int(np.frexp(most)[1]) - 53)

    def steps(self, values: Floats) -> Integers:
        """Return the nearest number of steps of each coordinate."""
        if self.decimals is None:
            return np.rint(np.ldexp(values, -self.exponent)).astype(np.int64)
        return np.rint(values * float(10**self.decimals)).astype(np.int64)

    def values(self, steps: Integers) -> Floats:
        """Return coordinates: the doubles nearest to multiples of the step."""
        made = steps.astype(np.float64)
        return np.ldexp(made, self.exponent) if self.decimals is None else made / float(10**self.decimals)


def finest_deviation(places: Floats) -> Floats:
    """(n,) how near to curves lines are at best: a step of the grid, for doubles 16 ulps of the largest coordinate."""
    largest = np.abs(places).max(axis=tuple(range(1, places.ndim)), initial=0)
    steps: Floats = 16 * np.spacing(largest)
    decimals = _DECIMALS.get()
    return steps if decimals is None else np.maximum(steps, 1 / float(10**decimals))


def is_verified() -> bool:
    """Return whether polygons are checked as they are written."""
    return _IS_VERIFIED.get()


def on_grid(points: Floats) -> Floats:
    """Round coordinates to the decimals of the file that is being written."""
    return rounded(points, _DECIMALS.get())


def rounded(points: Floats, decimals: int | None) -> Floats:
    """Round coordinates to decimals; those whose doubles are coarser stay, and so does what is no finite number."""
    if decimals is None:
        return points
    is_number = np.isfinite(points)
    if not is_number.all():
        made = points.copy()
        made[is_number] = rounded(points[is_number], decimals)
        return made
    grid = Grid.of(points, decimals)
    return points if grid.decimals is None else grid.values(grid.steps(points))
