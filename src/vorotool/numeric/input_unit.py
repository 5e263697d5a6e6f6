"""The unit of the coordinates of an input: of its coordinate reference system, or as its file states it."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from vorotool.numeric.crs import crs_text, is_geographic
from vorotool.numeric.length_units import is_known, unit_name

DEGREES = "deg"
COLUMNS = ("voro_unit", "unit")
"""Columns of tables that state the unit of their lengths."""


class InputUnit(NamedTuple):
    """How long 1 in the coordinates is: ``side`` times a unit; degrees have no length."""

    unit: str
    side: Fraction = Fraction(1)
    name: str | None = None  # what a coordinate reference system calls a unit that has no short name

    @property
    def is_length(self) -> bool:
        """Whether it has a length."""
        return is_known(self.unit)

    @property
    def text(self) -> str:
        """Words for it."""
        return self.name or self.unit


def unit_of(value: Any) -> InputUnit | None:
    """Return the unit of the coordinates of points, lines or polygons, or of a result, if it is known."""
    shapes = getattr(value, "polygons", value)
    if shapes.crs is not None:
        return unit_of_crs(shapes.crs)
    unit = getattr(shapes, "unit", None) or unit_of_columns(getattr(value, "properties", {}))
    return None if unit is None else InputUnit(unit_name(unit))


def own_unit(value: Any) -> str | None:
    """Return the unit that a value states, or what it was made of."""
    while value is not None and not hasattr(value, "unit"):
        value = next((getattr(value, name) for name in ("polygons", "skeleton", "path") if hasattr(value, name)), None)
    unit: str | None = getattr(value, "unit", None)
    return unit


def unit_of_columns(columns: Mapping[str, Any]) -> str | None:
    """Return the unit of length that a column of a table states for all rows."""
    for name in COLUMNS:
        stated = {each if isinstance(each, str) else "" for each in columns.get(name, ())}
        if len(stated) == 1 and is_known(unit := stated.pop()):
            return unit
    return None


def unit_of_crs(crs: Any) -> InputUnit | None:
    """Return the unit of the axes of a coordinate reference system; None if it, or pyproj, is not known."""
    if is_geographic(crs):
        return InputUnit(DEGREES)
    axis = _axis(crs_text(crs))
    if axis is None:
        return None
    name, factor = unit_name(axis.unit_name), float(axis.unit_conversion_factor)
    if name == DEGREES or is_known(name):
        return InputUnit(name)
    return InputUnit("m", _RATIOS.get(name) or Fraction(repr(factor)), name) if factor > 0 else None


def _axis(text: str | None) -> Any:
    if text is None:
        return None
    try:
        import pyproj
    except ImportError:
        return None
    try:
        axes = pyproj.CRS.from_user_input(text).axis_info
    except pyproj.exceptions.CRSError:
        return None
    return axes[0] if axes else None


_INCHES = {"US survey": 39370000, "(Sears 1922)": 39370147, "(Benoit 1895 B)": 39370113, "Indian": 39370142}
"""Millionths of inches in a meter, by which EPSG defines yards, feet, chains and links."""
_OF_A_YARD = {"yard": Fraction(1), "foot": Fraction(1, 3), "chain": Fraction(22), "link": Fraction(22, 100)}
_RATIOS = {
    name: Fraction(36 * 10**6, inches) * part
    for kind, inches in _INCHES.items()
    for unit, part in _OF_A_YARD.items()
    for name in (f"British {unit} {kind}", f"{kind} {unit}")
} | {"Gold Coast foot": Fraction(6378300, 20926201)}
"""Meters of units that are no short decimal numbers."""
