"""Units of length as files and users write them: one name for each, and how long it is."""

from __future__ import annotations

from fractions import Fraction

_METRES = {
    "pm": Fraction(1, 10**12),
    "Å": Fraction(1, 10**10),
    "nm": Fraction(1, 10**9),
    "µm": Fraction(1, 10**6),
    "mm": Fraction(1, 1000),
    "cm": Fraction(1, 100),
    "m": Fraction(1),
    "km": Fraction(1000),
}
"""Metres in each unit of the metric system, by its one name."""

_NAMES = {
    "um": "µm",
    "μm": "µm",  # the Greek letter; the one above is the sign of the unit
    "micron": "µm",
    "microns": "µm",
    "angstrom": "Å",
    "inches": "inch",
    "in": "inch",
    '"': "inch",
    "foot": "ft",
    "feet": "ft",
    "degree": "deg",
    "degrees": "deg",
    "°": "deg",
}
_PREFIXES = {"pico": "pm", "nano": "nm", "micro": "µm", "milli": "mm", "centi": "cm", "": "m", "kilo": "km"}
_NAMES |= {
    f"{prefix}{metre}": name for prefix, name in _PREFIXES.items() for metre in ("metre", "metres", "meter", "meters")
}


def unit_name(text: str) -> str:
    """Give the one name of a unit, whatever its spelling; a unit that is not known keeps its own.

    Examples
    --------
    >>> unit_name("microns"), unit_name("um"), unit_name("Millimeters"), unit_name("furlong")
    ('µm', 'µm', 'mm', 'furlong')
    """
    plain = text.strip()
    return _NAMES.get(plain) or _NAMES.get(plain.lower()) or plain


def metres(unit: str | None) -> Fraction | None:
    """Give the metres of a unit of the metric system, by its one name; None of any other.

    Examples
    --------
    >>> metres("mm"), metres("inch"), metres(None)
    (Fraction(1, 1000), None, None)
    """
    return None if unit is None else _METRES.get(unit)


def same_unit(a: str | None, b: str | None) -> bool:
    """Tell whether two units are one.

    Examples
    --------
    >>> same_unit("um", "micron"), same_unit("um", None)
    (True, False)
    """
    return a == b if a is None or b is None else unit_name(a) == unit_name(b)
