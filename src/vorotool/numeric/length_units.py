"""Units of length as files and users write them: one name for each, and the exact ratios between them."""

from __future__ import annotations

from fractions import Fraction

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
