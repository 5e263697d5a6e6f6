"""Options of all readers of points, and the checks that they share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, LimitError

LARGEST_LABEL = 0xFFFFFFFF
"""Labels are uint32: there cannot be more sites either."""

LONGITUDES = ("lon", "longitude")
LATITUDES = ("lat", "latitude")


def no_note(message: str) -> None:
    """Drop a note that nobody asked for."""


@dataclass(frozen=True)
class PointOptions:
    """Options of :func:`vorotool.formats.points.reader.read_points`, passed on to the reader of a format."""

    columns: str | None = None
    properties: bool = True
    max_sites: int | None = None
    threads: int = 0
    note: Callable[[str], None] = no_note
    crs: Any = None

    def check_sites(self, name: str, count: int) -> None:
        """Raise LimitError if ``count`` sites are too many."""
        limit = LARGEST_LABEL if self.max_sites is None else min(self.max_sites, LARGEST_LABEL)
        if count > limit:
            advice = "raise --max-sites or split the file" if limit < LARGEST_LABEL else "split the file"
            raise LimitError(f"{name} holds {count} points, more than the limit of {limit}: {advice}")


def no_points() -> NDArray[np.float64]:
    """Coordinates of no points."""
    return np.empty((0, 2))


def position_array(positions: list[Any], place: Callable[[int], str]) -> NDArray[np.float64]:
    """Coordinates of JSON positions ``[x, y, ...]``; what follows x and y is left out.

    Parameters
    ----------
    positions : list
        As they were parsed: anything.
    place : callable
        Gives the words that name the place of position i (0-based).

    Raises
    ------
    InputError
        If one is not a list of at least two finite numbers.
    """
    pairs = positions
    if set(map(type, positions)) <= {list} and max(map(len, positions), default=2) > 2:
        pairs = [position[:2] for position in positions]
    good = set(map(type, pairs)) <= {list} and set(map(len, pairs)) <= {2}
    if not good or not set(map(type, chain.from_iterable(pairs))) <= {int, float}:
        _refuse_first(positions, place)
    xy = np.fromiter(chain.from_iterable(pairs), np.float64, 2 * len(pairs)).reshape(-1, 2)
    bad = np.flatnonzero(~np.isfinite(xy).all(axis=1))
    if bad.size:
        raise _position_error(place(int(bad[0])), positions[int(bad[0])])
    return xy


def _refuse_first(positions: list[Any], place: Callable[[int], str]) -> None:
    for i, p in enumerate(positions):
        if type(p) is not list or len(p) < 2 or not {type(v) for v in p[:2]} <= {int, float}:
            raise _position_error(place(i), p)


def _position_error(place: str, value: Any) -> InputError:
    return InputError(f"{place}: {shortened(value)} is not a pair of finite numbers; write [x, y]")


def shortened(value: Any, size: int = 40) -> str:
    """Give a value as a message shows it: its beginning, when it is long."""
    text = repr(value)
    return text if len(text) <= size else text[: size - 1] + "…"
