"""Rational places as whole numbers of one small unit: exact, and much faster than fractions."""

from fractions import Fraction
from math import lcm


def in_units(points):
    """Return the places as pairs of integers, and how many units are 1."""
    exact = [(Fraction(x), Fraction(y)) for x, y in points]
    scale = lcm(*(value.denominator for place in exact for value in place))
    return [(int(x * scale), int(y * scale)) for x, y in exact], scale
