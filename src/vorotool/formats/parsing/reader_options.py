"""Options of all readers, and the checks that they share."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, Kind, LimitError, Message, UsageError, option
from vorotool.frozen import frozen
from vorotool.numeric.checks import MAX_PIXELS
from vorotool.numeric.crs import TO_CRS, crs_member, crs_name, crs_text, note_degrees, same_crs
from vorotool.types.fields import DOWN, UP, YAxis, with_y_axis
from vorotool.types.values import counted

if TYPE_CHECKING:
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.polygons.polygon_set import PolygonSet

LARGEST_LABEL = 0xFFFFFFFF
"""Labels are uint32: there cannot be more sites either."""

MOST_VERTICES = 2**28
"""Vertices and edges are numbered in 32 bits, with room for the crossings of edges."""


def no_note(message: str) -> None:
    """Drop a note that nobody asked for."""


@frozen
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
    axes: int = 2  # coordinates of a point: 3 in space
    curves_advice: str = ""  # what the note about flattened curves adds; drawings have the note only with it

    def check_vertices(self, name: str, count: int) -> None:
        """Raise LimitError if ``count`` vertices are too many."""
        self.check_sites(name, count, "vertices", MOST_VERTICES)

    def check_sites(self, name: str, count: int, noun: str = "points", most: int = LARGEST_LABEL) -> None:
        """Raise LimitError if ``count`` sites are too many."""
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
            self.note(f"{name}: {counted(features, 'feature')} without geometry kept, and empty")

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
    """Give a value as a message shows it: lists and objects as JSON has them, and what is long by its beginning."""
    text = repr(value)
    if isinstance(value, list | dict):
        from json import dumps

        text = dumps(value, ensure_ascii=False, default=repr, skipkeys=True)
    return text if len(text) <= size else text[: size - 1] + "…"


_CRS = option("--input-crs", "crs")
_Y_DOWN = option("--y-down", "y_up=False")

Placed = TypeVar("Placed", "PointSet", "PolygonSet")


def with_crs(value: Placed, name: str, options: ReadOptions) -> Placed:
    """Return the coordinate reference system of an input: its own, else the declared one, else the wanted one."""
    if options.crs is not None:
        check_known(options.crs)
        value = declared_in(value, name, options.crs)
    if options.to_crs is not None:
        if value.crs is None:
            raise InputError(
                f"{name} states no coordinate reference system, so {TO_CRS} cannot reproject it: name its system with "
                f"{_CRS}"
            )
        if not same_crs(value.crs, options.to_crs):
            value = replace(value, xy=reprojected(value.xy, name, value.crs, options.to_crs))
        value = replace(value, crs=options.to_crs, y_axis=UP)
    if value.crs is not None:
        note_degrees(value, name, options.note)
    return value


def with_stated_axis(value: Any, name: str, axis: YAxis) -> Any:
    """Return an input whose y goes the way that the caller states."""
    crs = getattr(getattr(value, "polygons", value), "crs", None)
    if axis == DOWN and crs is not None:
        raise UsageError(f"{name} is in {crs_name(crs)}, where y goes up: leave out {_Y_DOWN}")
    return with_y_axis(value, axis)


def declared_in(value: Placed, name: str, declared: Any) -> Placed:
    """Give an input that names no coordinate reference system the one that is declared, if one is."""
    if value.crs is None:
        return replace(value, crs=declared, y_axis=UP)
    if not same_crs(value.crs, declared):
        raise InputError(
            f"{name} is in {crs_name(value.crs)}, as the file states, not in {crs_name(declared)}: leave out {_CRS}, "
            f"which does not reproject; {TO_CRS} does"
        )
    return value


def note_unnamed(name: str, xy: NDArray[np.float64], note: Callable[[str], None]) -> None:
    """Tell of GeoJSON that names no system and may be longitude and latitude: by its numbers that is not known."""
    if len(xy) and bool((np.abs(xy) <= (180.0, 90.0)).all()) and bool((xy % 1 != 0).any()):
        text = (
            f"{name} states no coordinate reference system and is treated as planar: for longitude and latitude use "
            + option("--input-crs OGC:CRS84", 'crs="OGC:CRS84"')
        )
        note(Message(text, Kind.UNNAMED_CRS, source=name))


def crs_of_numbers(name: str, srids: Sequence[int], line_of: Callable[[int], int]) -> Any:
    """Give the ``crs`` member for the numbers (SRID) of extended well-known text, 0 where a geometry has none."""
    first = next((k for k, srid in enumerate(srids) if srid), None)
    if first is None:
        return None
    other = next((k for k, srid in enumerate(srids) if srid not in (0, srids[first])), None)
    if other is not None:
        raise InputError(
            f"{name}, line {line_of(other)}: the geometry is in EPSG:{srids[other]}, but that of line "
            f"{line_of(first)} in EPSG:{srids[first]}: put them into separate files"
        )
    return crs_member(f"EPSG:{srids[first]}")


def reprojected(xy: NDArray[np.float64], name: str, source: Any, target: Any) -> NDArray[np.float64]:
    """Bring coordinates from one system into another, vertex by vertex: edges stay straight lines between them."""
    from vorotool.convert.extras import needed

    pyproj = needed("pyproj", "gis", "other coordinate reference systems")
    systems = [_known(pyproj, each) for each in (source, target)]
    pyproj.network.set_network_enabled(False)  # grids that are not there are not looked for elsewhere
    made = np.stack(pyproj.Transformer.from_crs(*systems, always_xy=True).transform(*xy.T), axis=1)
    bad = np.flatnonzero(~np.isfinite(made).all(axis=1))
    if bad.size:
        x, y = xy[bad[0]].tolist()
        raise InputError(
            f"{name}: ({x}, {y}) in {crs_name(source)} cannot be expressed in {crs_name(target)} ({bad.size} such "
            "vertices): choose a system for this region"
        )
    return made


def check_known(crs: Any) -> None:
    """Refuse a coordinate reference system that does not exist, where there is what knows all that do."""
    try:
        import pyproj
    except ImportError:
        return
    _known(pyproj, crs)


def _known(pyproj: Any, crs: Any) -> Any:
    try:
        return pyproj.CRS.from_user_input(crs_text(crs))
    except pyproj.exceptions.CRSError:
        raise UsageError(
            f"the coordinate reference system {crs_name(crs)} is unknown: check authority and code, as in EPSG:3857"
        ) from None
