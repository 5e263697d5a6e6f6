"""Units of length, and the exact ratios between them."""

from __future__ import annotations

from fractions import Fraction

METRES = {
    "nm": Fraction(1, 10**9),
    "um": Fraction(1, 10**6),
    "µm": Fraction(1, 10**6),
    "mm": Fraction(1, 10**3),
    "cm": Fraction(1, 10**2),
    "m": Fraction(1),
    "km": Fraction(10**3),
    "in": Fraction(254, 10**4),
    "ft": Fraction(3048, 10**4),
}
"""Of how many metres each unit is."""

_OTHER_LETTERS = {"\N{GREEK SMALL LETTER MU}m": "µm"}


def ratio(unit: str, other: str) -> Fraction | None:
    """Give how many of another unit make one; None if they are not the same and one is not known.

    Examples
    --------
    >>> ratio("in", "mm"), ratio("um", "µm"), ratio("voxel", "voxel"), ratio("voxel", "um")
    (Fraction(127, 5), Fraction(1, 1), Fraction(1, 1), None)
    """
    one, two = (_OTHER_LETTERS.get(name, name) for name in (unit, other))
    if one == two:
        return Fraction(1)
    return METRES[one] / METRES[two] if one in METRES and two in METRES else None


def is_known(unit: str) -> bool:
    """Whether a unit is one of these.

    Examples
    --------
    >>> is_known("km"), is_known("parsec")
    (True, False)
    """
    return _OTHER_LETTERS.get(unit, unit) in METRES
