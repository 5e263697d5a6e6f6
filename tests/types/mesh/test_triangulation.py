from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from support.families.point_families import FAMILIES, draw
from support.oracles.delaunay_oracle import circle, cross
from vorotool import delaunay

pytestmark = pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")


def square_root(value):
    """To 120 bits."""
    shift = 240 - value.numerator.bit_length() + value.denominator.bit_length()
    shift += shift % 2
    return Fraction(math.isqrt(int(value * Fraction(2) ** shift))) / Fraction(2) ** (shift // 2)


def within(value, right, error):
    """Whether a double is right up to the error, its own rounding, and overflow."""
    if math.isinf(value):
        return abs(right) * 2 > Fraction(np.finfo(float).max)
    return abs(Fraction(value) - right) <= error + abs(right) * Fraction(2) ** -50 + Fraction(5e-324)


@pytest.mark.parametrize("name", FAMILIES)
def test_circles_and_areas_against_rationals(name):
    mesh = delaunay(draw(name, 60, 1))
    centers, radii, areas = mesh.circumcenters, mesh.circumradii, mesh.areas
    for t, corners in enumerate(mesh.points[mesh.triangles].tolist()):
        a, b, c = ((Fraction(x), Fraction(y)) for x, y in corners)
        (x, y), square = circle(a, b, c)
        radius = square_root(square)
        assert within(radii[t], radius, radius / 10**9)
        assert within(centers[t, 0], x, radius / 10**9)
        assert within(centers[t, 1], y, radius / 10**9)
        assert within(areas[t], cross(a, b, c) / 2, cross(a, b, c) / 10**9)
        assert areas[t] >= 0
