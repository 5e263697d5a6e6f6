"""Results in other units: coordinates and lengths times a factor, areas times its square; and placed on a map."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import fields, replace
from fractions import Fraction
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.numeric.arrays import within
from vorotool.numeric.coordinates import LARGEST_INTEGER
from vorotool.types.box import Box
from vorotool.types.fields import UP, Declared, Meaning, Record
from vorotool.types.pixels import Frame
from vorotool.types.polygons.polygon_set import LINE, PolygonSet
from vorotool.types.table import Table

Place = tuple[float, float] | None
T = TypeVar("T")

LENGTHS = frozenset(
    {
        *("x", "y", "perimeter", "nearest_distance", "max_distance", "bbox_x", "bbox_y", "bbox_w", "bbox_h"),
        *("border_length", "centroid_distance", "voronoi_length", "r", "length"),
        *("birth", "death", "persistence"),
    }
)
_UNSCALED = (Meaning.NUMBER, Meaning.AXIS)
AREAS = frozenset({"area", "object_area"})
VOLUMES = frozenset({"volume"})
"""Columns of tables that are lengths, coordinates included, areas and volumes; others are numbers, labels and names."""


def scaled(value: Any, factor: Fraction, origin: Place = None, *, unit: str | None = None) -> Any:
    """Return a result in units of which one is ``1 / factor`` of the old."""
    measures = {name: each for name, each in _declared(value).items() if each.meaning not in _UNSCALED}
    if not measures or any(each.meaning is Meaning.STEPS for each in measures.values()):
        raise UsageError(f"a {type(value).__name__} cannot be scaled")
    parts: dict[str, Any] = {}
    for name, each in measures.items():
        part = getattr(value, name)
        if part is not None and each.meaning is Meaning.VALUE:
            parts[name] = scaled(part, factor, origin, unit=unit)
        elif part is not None:
            moved = origin if each.meaning is Meaning.POSITION else None
            parts[name] = _scaled(part, factor * factor if each.meaning is Meaning.AREA else factor, moved)
    if factor != 1 and origin is None and any(each.name == "crs" for each in fields(value)):
        parts["crs"] = None  # the coordinates are others than those of the system
    if not isinstance(value, PolygonSet):
        return replace(value, **parts)
    made = replace(value, **parts, unit=unit)
    if value.as_given is value:
        return made
    as_given = _scaled(value.as_given.xy, factor, origin)
    return replace(made, xy=as_given).moved(made.xy)


def stretched(value: T, x: int, y: int) -> T:
    """Multiply coordinates of points, seeds or polygons; a y below 0 mirrors them, and goes upwards then."""
    parts: dict[str, Any] = {}
    for name, each in _declared(value).items():
        part = getattr(value, name)
        if isinstance(part, Box):
            parts[name] = part.stretched(x, y)
        elif isinstance(part, Frame):
            parts[name] = part.mirrored()
        elif each.meaning is Meaning.STEPS:
            parts[name] = part * (x, y)[each.along]
        elif each.meaning is Meaning.POSITION and part is not None:
            parts[name] = part * (x, y) + 0.0
        elif each.meaning is Meaning.AXIS and y < 0:
            parts[name] = UP
    if y < 0 and isinstance(value, PolygonSet):
        parts["xy"] = parts["xy"][_reversed_rings(value)]
    return replace(value, **parts)  # type: ignore[type-var]


def _reversed_rings(polygons: PolygonSet) -> NDArray[np.integer]:
    """Indices of vertices: closed rings begin at the same one and run the other way, so that areas keep their signs."""
    sizes = np.diff(polygons.ring_starts)
    place = within(sizes)
    size, first = np.repeat(sizes, sizes), np.repeat(polygons.ring_starts[:-1], sizes)
    is_line = np.repeat(polygons.ring_kind == LINE, sizes)
    return np.asarray(first + np.where(is_line, place, (size - place) % np.maximum(size, 1)))


def _declared(value: Any) -> dict[str, Declared]:
    return value._declared if isinstance(value, Record) else {}


def _scale(factor: Fraction) -> tuple[float, float]:
    """What numbers are multiplied by, and then divided by: integers, where doubles hold them, are rounded once."""
    is_held = max(factor.numerator, factor.denominator) <= LARGEST_INTEGER
    return (float(factor.numerator), float(factor.denominator)) if is_held else (float(factor), 1.0)


def _scaled(part: Any, factor: Fraction, origin: Place) -> Any:
    """Return a number, an array, a box, or a tuple x, y, width, height."""
    times, over = _scale(factor)
    if isinstance(part, Box):
        sides = (side * times / over for side in part.sides)
        return Box(
            *(sides if origin is None else (side + shift for side, shift in zip(sides, 2 * origin, strict=True)))
        )
    if isinstance(part, tuple):
        shifts = (*(origin or (0.0, 0.0)), 0.0, 0.0)
        return tuple(side * times / over + shift for side, shift in zip(part, shifts, strict=True))
    made = part * factor if isinstance(part, Fraction) else part * times / over
    return made if origin is None else made + np.asarray(origin)


def scaled_table(
    table: Table,
    factor: Fraction,
    *,
    properties: Collection[str] = (),
    origin: Place = None,
    y_up: bool = False,
    pixel: tuple[float, float] = (1.0, 1.0),
) -> Table:
    """Return a table of tessellations, triangulations or alpha shapes in other units."""
    columns = table.stored()
    scale = {names: _scale(factor**k) for k, names in enumerate((LENGTHS, AREAS, VOLUMES), 1)}
    made = {name: _scaled_column(name, column, scale, properties) for name, column in columns.items()}
    if origin is not None:
        made |= _placed_columns(columns, scale[LENGTHS], origin, pixel, y_up=y_up, properties=properties)
    return Table(made)


def _placed_columns(
    columns: Mapping[str, Any],
    scale: tuple[float, float],
    origin: tuple[float, float],
    pixel: tuple[float, float],
    *,
    y_up: bool,
    properties: Collection[str],
) -> dict[str, Any]:
    """Coordinates on the map: of sites, and of the left and the lower side of boxes."""
    own = {"" if name in properties else name.removeprefix("voro_"): name for name in columns}
    x, y, left, top, high = (
        np.ma.asanyarray(columns[own[name]]) if name in own else None
        for name in ("x", "y", "bbox_x", "bbox_y", "bbox_h")
    )
    made: dict[str, Any] = {}
    (across, down), (times, over) = (pixel[0] / 2, pixel[1] / 2), scale
    if x is not None and y is not None:
        made[own["x"]] = x * times / over + origin[0]
        made[own["y"]] = (-y if y_up else y) * times / over + origin[1]
    if left is not None and top is not None and high is not None:
        made[own["bbox_x"]] = (left - across) * times / over + origin[0]
        made[own["bbox_y"]] = (-(top + high - down) if y_up else top - down) * times / over + origin[1]
    return made


def _scaled_column(
    name: str, column: Any, scale: Mapping[frozenset[str], tuple[float, float]], properties: Collection[str]
) -> Any:
    ours = "" if name in properties else name.removeprefix("voro_")
    found = next((names for names in scale if ours in names), None)
    if found is None:
        return column
    times, over = scale[found]
    values = column if isinstance(column, np.ndarray) else np.ma.asanyarray(column)
    return values * times / over
