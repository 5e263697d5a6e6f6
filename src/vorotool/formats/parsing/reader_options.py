"""Options of all readers, and the checks that they share."""

from __future__ import annotations

from collections.abc import Callable
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, LimitError, option
from vorotool.plain import plain
from vorotool.types.fields import YAxis
from vorotool.types.pixels import MAX_PIXELS
from vorotool.types.values import counted

LARGEST_LABEL = 0xFFFFFFFF
"""Labels are uint32: there cannot be more sites either."""

MOST_VERTICES = 2**28
"""Vertices and edges are numbered in 32 bits, with room for the crossings of edges."""


def no_note(message: str) -> None:
    """Drop a note that nobody asked for."""


@plain
class ReadOptions:
    """What a reader is told beside its source; each format takes what is about it."""

    columns: str | None = None  # as of `vorotool.read`
    page: int | None = None  # as of `vorotool.read`
    properties: bool = True  # as of `vorotool.read`
    max_pixels: int = MAX_PIXELS  # as of `vorotool.read`
    max_sites: int | None = None  # as of `vorotool.read`
    threads: int = 0  # as of `vorotool.read`
    note: Callable[[str], None] = no_note  # as of `vorotool.read`
    crs: Any = None  # the `crs` member of GeoJSON for an input that names none
    to_crs: Any = None  # that of the system in which coordinates are wanted
    flatten: float | None = None  # how far lines may be from the curves of drawings
    join_tolerance: float | None = None  # how far ends of curves may be apart that are joined
    y_axis: YAxis | None = None  # which way y goes, where the caller says it
    wants_z: bool = False  # points are of space, and have a z
    curves_advice: str = ""  # what the note about flattened curves adds; drawings have the note only with it

    @property
    def axes(self) -> int:
        """Coordinates of a point."""
        return 3 if self.wants_z else 2

    def check_sites(self, name: str, count: int) -> None:
        """Raise LimitError if ``count`` sites are too many."""
        self._check_count(name, count, "points", LARGEST_LABEL)

    def check_vertices(self, name: str, count: int) -> None:
        """Raise LimitError if ``count`` vertices are too many."""
        self._check_count(name, count, "vertices", MOST_VERTICES)

    def _check_count(self, name: str, count: int, noun: str, most: int) -> None:
        limit = most if self.max_sites is None else min(self.max_sites, most)
        if count > limit:
            advice = f"raise {option('--max-sites')} or split the file" if limit < most else "split the file"
            raise LimitError(f"{name} holds {count} {noun}, more than the limit of {limit}: {advice}")

    def note_left_out(self, name: str, features: int) -> None:
        """Say how many features have no geometry, if any."""
        if features:
            self.note(f"{name}: {counted(features, 'feature')} without geometry skipped")

    def note_empty(self, name: str, features: int) -> None:
        """Say how many sites have no geometry, if any."""
        if features:
            self.note(f"{name}: {counted(features, 'feature')} without geometry, hence with an empty cell")

    def note_curves(self, name: str, curves: int) -> None:
        """Say how many curves were flattened, if any."""
        if curves:
            from vorotool.numeric.curves.well_known import flattened_note

            self.note(f"{name}: {flattened_note(curves)}{self.curves_advice}")

    def note_heights(self, name: str) -> None:
        """Say that coordinates beyond x and y are not used."""
        self.note(f"{name}: only x and y are used; z is ignored")


def no_points(axes: int = 2) -> NDArray[np.float64]:
    """Coordinates of no points."""
    return np.empty((0, axes))


def position_array(positions: list[Any], place: Callable[[int], str], axes: int = 2) -> NDArray[np.float64]:
    """Coordinates of JSON positions ``[x, y, ...]``; what follows x and y, or z, is left out."""
    tuples = positions
    if set(map(type, positions)) <= {list} and max(map(len, positions), default=axes) > axes:
        tuples = [position[:axes] for position in positions]
    good = set(map(type, tuples)) <= {list} and set(map(len, tuples)) <= {axes}
    if not good or not set(map(type, chain.from_iterable(tuples))) <= {int, float}:
        _refuse_first(positions, place, axes)
    found = np.fromiter(chain.from_iterable(tuples), np.float64, axes * len(tuples)).reshape(-1, axes)
    bad = np.flatnonzero(~np.isfinite(found).all(axis=1))
    if bad.size:
        raise _position_error(place(int(bad[0])), positions[int(bad[0])], axes)
    return found


def _refuse_first(positions: list[Any], place: Callable[[int], str], axes: int) -> None:
    for i, p in enumerate(positions):
        if type(p) is not list or len(p) < axes or not {type(v) for v in p[:axes]} <= {int, float}:
            raise _position_error(place(i), p, axes)


def _position_error(place: str, value: Any, axes: int) -> InputError:
    wanted = "a pair of finite numbers; write [x, y]" if axes == 2 else "three finite numbers; write [x, y, z]"
    return InputError(f"{place}: {shortened(value)} is not {wanted}")


def shortened(value: Any, size: int = 40) -> str:
    """Give a value as a message shows it: its beginning, when it is long."""
    text = repr(value)
    return text if len(text) <= size else text[: size - 1] + "…"
