"""Alpha complexes: their radii beside the definition in rationals, and what must not change them."""

from fractions import Fraction

import numpy as np
import pytest

from support.families.alpha_cases import quietly
from support.families.point_families import FAMILIES, draw
from support.few import few
from support.oracles.alpha_oracle import rounded_root
from vorotool import alpha_complex

families = pytest.mark.parametrize("name", FAMILIES)


def distinct(points):
    return len({(x, y) for x, y in np.asarray(points, float).tolist()})


def exact_radii(family):
    """Squares of the circumradii, and of half the lengths of the edges."""
    triangles = []
    for corners in family.points[family.mesh.triangles].tolist():
        (ax, ay), (bx, by), (cx, cy) = ((Fraction(x), Fraction(y)) for x, y in corners)
        sides = [(bx - cx) ** 2 + (by - cy) ** 2, (ax - cx) ** 2 + (ay - cy) ** 2, (ax - bx) ** 2 + (ay - by) ** 2]
        cross = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        triangles.append((sides[0] * sides[1] * sides[2] / (4 * cross * cross), sides))
    halves = []
    for ends in family.points[family.edges].tolist():
        (ax, ay), (bx, by) = ((Fraction(x), Fraction(y)) for x, y in ends)
        halves.append(((ax - bx) ** 2 + (ay - by) ** 2) / 4)
    return triangles, halves


@families
@pytest.mark.parametrize("n", few([24, 8], 1))
def test_radii_are_correctly_rounded_and_ranked(name, n):
    points = draw(name, n, 3)
    if distinct(points) < 2:
        return
    family = quietly(points)
    triangles, halves = exact_radii(family)
    values = set()
    for e, (t, u) in enumerate(family.sides.tolist()):
        around = sorted(triangles[k][0] for k in (t, u) if k >= 0)
        # Gabriel: no opposite corner strictly inside the diametral disc, by the law of cosines
        gabriel = all(
            2 * max(triangles[k][1]) <= sum(triangles[k][1]) or 4 * halves[e] != max(triangles[k][1])
            for k in (t, u)
            if k >= 0
        )
        least = halves[e] if gabriel else around[0]
        values |= {least, *around}
        exact = [least, *around, *[None] * (2 - len(around))]
        for radii, ranks, square in zip(
            (family.r_min, family.r_mid, family.r_max),
            (family.rank_min, family.rank_mid, family.rank_max),
            exact,
            strict=True,
        ):
            if square is None:
                assert (radii[e], ranks[e]) == (np.inf, len(family.spectrum))
            else:
                assert radii[e] == rounded_root(square)
                assert family.squared_radius(ranks[e]) == square
    assert [family.squared_radius(k) for k in range(len(family.spectrum))] == sorted(values)
    assert family.spectrum.tolist() == [rounded_root(square) for square in sorted(values)]


def test_a_radius_is_compared_exactly():
    """0.1 as a double is more than 1/10: three points whose circle has exactly that radius tell them apart."""
    family = alpha_complex([[0, 0], [4, 0], [0, 3]])
    for step, reached in ((Fraction(-1, 10**40), 2), (Fraction(0), 3), (Fraction(1, 10**40), 3)):
        assert family.reached(Fraction(5, 2) + step) == reached
    edge = alpha_complex([[0, 0], [0.2, 0]])  # half of the double 0.2 is the double 0.1
    assert edge.reached(0.1) == 1
    assert edge.reached(Fraction(1, 10)) == 0
    huge = alpha_complex([[-1e308, 0], [1e308, 0], [0, 1e308], [0, 1.7e308]])
    assert huge.reached(np.inf) == len(huge.spectrum)
    assert huge.reached(Fraction(10) ** 400) == len(huge.spectrum)
    flat = alpha_complex([[0, 0], [1e300, 1], [2e300, 0]])  # its circle is beyond the largest double
    assert flat.spectrum.tolist() == [5e299, np.inf]
    assert isinstance(flat.radius_from(1), Fraction)
    assert [flat.reached(flat.radius_from(k)) for k in range(2)] == [1, 2]
    assert flat.reached(1e308) == 1
