"""Units of length by name, the exact ratios between them, and the unit of an input."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

from vorotool.numeric.crs import crs_text, is_geographic

METERS = {
    "nm": Fraction(1, 10**9),
    "um": Fraction(1, 10**6),
    "µm": Fraction(1, 10**6),
    "mm": Fraction(1, 10**3),
    "cm": Fraction(1, 10**2),
    "dm": Fraction(1, 10),
    "m": Fraction(1),
    "km": Fraction(10**3),
    "in": Fraction(254, 10**4),
    "ft": Fraction(3048, 10**4),
    "ftUS": Fraction(1200, 3937),
    "yd": Fraction(9144, 10**4),
    "mi": Fraction(1609344, 10**3),
}
"""Of how many meters each unit is that options may have."""

_NAMES = {
    "um": "µm",
    "\N{GREEK SMALL LETTER MU}m": "µm",
    "micron": "µm",
    "microns": "µm",
    "angstrom": "Å",
    "inches": "inch",
    "in": "inch",
    '"': "inch",
    "foot": "ft",
    "feet": "ft",
    "yard": "yd",
    "yards": "yd",
    "mile": "mi",
    "miles": "mi",
    "us survey foot": "ftUS",
    "us survey ft": "ftUS",
    "ftus": "ftUS",
    "degree": "deg",
    "degrees": "deg",
    "°": "deg",
}
_PREFIXES = {
    "pico": "pm",
    "nano": "nm",
    "micro": "µm",
    "milli": "mm",
    "centi": "cm",
    "deci": "dm",
    "": "m",
    "kilo": "km",
}
_NAMES |= {
    f"{prefix}{meter}": name for prefix, name in _PREFIXES.items() for meter in ("metre", "metres", "meter", "meters")
}
_OTHERS = {"pm": Fraction(1, 10**12), "Å": Fraction(1, 10**10), "mil": Fraction(254, 10**7)}
_LENGTHS = {_NAMES.get(unit, unit): meters for unit, meters in METERS.items()} | _OTHERS
"""By the one name of each unit."""
_IMPERIAL = ("inch", "ft", "ftUS", "yd", "mi", "mil")


def unit_name(text: str) -> str:
    """Give the one name of a unit, whatever its spelling; a unit that is not known keeps its own."""
    plain = text.strip()
    return _NAMES.get(plain) or _NAMES.get(plain.lower()) or plain


def ascii_unit(unit: str) -> str:
    """Write a unit in ASCII, as tables and files have it."""
    return unit.replace("µ", "u").replace("\u03bc", "u")


def ratio(unit: str, other: str) -> Fraction | None:
    """Give how many of another unit make one; None if they are not the same and one is not known."""
    one, two = unit_name(unit), unit_name(other)
    if one == two:
        return Fraction(1)
    return _LENGTHS[one] / _LENGTHS[two] if one in _LENGTHS and two in _LENGTHS else None


def is_known(unit: str) -> bool:
    """Whether a unit is a length."""
    return unit_name(unit) in _LENGTHS


def meters(unit: str | None) -> Fraction | None:
    """Give the meters of a unit of the metric system, by its one name; None of any other."""
    return None if unit is None or unit in _IMPERIAL else _LENGTHS.get(unit)


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
    unit, columns = getattr(shapes, "unit", None) or None, getattr(value, "properties", {})
    for name in COLUMNS if unit is None else ():  # one unit for all rows
        stated = {each if isinstance(each, str) else "" for each in columns.get(name, ())}
        if len(stated) == 1 and is_known(text := stated.pop()):
            unit = text
            break
    return None if unit is None else InputUnit(unit_name(unit))


def own_unit(value: Any) -> str | None:
    """Return the unit that a value states, or what it was made of."""
    while value is not None and not hasattr(value, "unit"):
        value = next((getattr(value, name) for name in ("polygons", "skeleton", "path") if hasattr(value, name)), None)
    return getattr(value, "unit", None)


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
