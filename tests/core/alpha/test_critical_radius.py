"""Radii correctly rounded and compared exactly, against rational numbers."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.oracles.alpha_oracle import rounded_root
from vorotool import _core

finite = st.floats(allow_nan=False, allow_infinity=False)
ordinary = st.floats(-1e3, 1e3)
small = st.integers(-40, 40).map(float)
ulps = st.integers(-4, 4).map(lambda k: 0.1 + k * 2.0**-56)
scaled = st.tuples(small, st.sampled_from([2.0**-1074, 2.0**-1030, 1e-200, 2.0**900])).map(lambda p: p[0] * p[1])


def coordinates(*kinds):
    return st.one_of([st.tuples(*[kind] * 6) for kind in kinds])


supports = coordinates(finite, ordinary, small, ulps, scaled, st.one_of(ordinary, small, ulps))


def squared(support):
    """Square of the exact radius; None for collinear points."""
    ax, ay, bx, by, cx, cy = map(Fraction, support)
    ab = (bx - ax) ** 2 + (by - ay) ** 2
    if (ax, ay) == (cx, cy):
        return ab / 4
    cross = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if cross == 0:
        return None
    return ab * ((cx - ax) ** 2 + (cy - ay) ** 2) * ((cx - bx) ** 2 + (cy - by) ** 2) / (4 * cross**2)


def edge_of(support):
    return (*support[:4], *support[:2])


def ranked(supports):
    """Of triangles and edges without others beside them the ranks of the exact radii, and the rounded radii."""
    points = np.array(supports, dtype=np.float64).reshape(-1, 2)
    corners = np.arange(len(points), dtype=np.int32).reshape(-1, 3)
    is_edge = (points[0::3] == points[2::3]).all(axis=1)
    edges = np.ascontiguousarray(corners[is_edge, :2])
    rule, sides = _core.alpha.AlphaRule.corrected, np.full_like(edges, -1)
    found = _core.alpha.alpha_complex(points, corners[~is_edge], edges, sides, rule, 1, None)
    rank = np.empty(len(corners), dtype=np.int64)
    rank[is_edge], rank[~is_edge] = found["rank_min"], found["triangle_rank"]
    return rank, np.append(found["spectrum"], np.inf)[rank]


def compared(p, q):
    ranks, _ = ranked([p, q])
    return int(np.sign(ranks[0] - ranks[1]))


@settings(max_examples=50, deadline=None)
@given(supports, st.booleans())
def test_correctly_rounded(support, is_edge):
    support = edge_of(support) if is_edge else support
    square = squared(support)
    _, (found,) = ranked([support])
    assert found == (np.inf if square is None else rounded_root(square))


@pytest.mark.parametrize("scale", [1.0, 1e-3, 2.0**-600, 1e200])
def test_many_correctly_rounded(scale):
    rng = np.random.default_rng(5)
    triangles = rng.random((900, 6)) * scale
    triangles[:300, 4:] = triangles[:300, :2] + (triangles[:300, 2:4] - triangles[:300, :2]) * rng.choice(
        [0.5, 2.0, -1.0], (300, 1)
    )  # flat but for rounding
    _, found = ranked(triangles)
    for support, radius in zip(triangles.tolist(), found.tolist(), strict=True):
        square = squared(support)
        assert radius == (np.inf if square is None else rounded_root(square))


def sign(value):
    return (value > 0) - (value < 0)


@settings(max_examples=60, deadline=None)
@given(supports, supports, st.integers(0, 3), st.booleans())
def test_compared_exactly(p, q, case, is_edge):
    if case == 1:  # the same triangle, mirrored
        q = tuple(p[k] for k in (3, 2, 5, 4, 1, 0))
    elif case == 2:  # moved by one unit in the last place
        q = (*p[:5], float(np.nextafter(p[5], 0)))
    elif case == 3:
        q = edge_of(q)
    p = edge_of(p) if is_edge else p
    a, b = squared(p), squared(q)
    right = (a is None) - (b is None) if a is None or b is None else sign(a - b)
    assert compared(p, q) == right
    assert compared(q, p) == -right


def test_equal_radii_of_different_triangles():
    """Pythagorean triangles of one circumcircle, and an edge as long as its diameter."""
    on_circle = [(5, 0), (3, 4), (-3, 4), (0, 5), (-4, 3), (4, -3), (0, -5)]
    for factor in (1.0, 0.25, 0.1, 2.0**600, 2.0**-1060):
        points = np.array(on_circle) * factor
        first = np.concatenate([points[0], points[1], points[2]])
        for k in range(2, 6):
            other = np.concatenate([points[k - 1], points[k], points[k + 1]])
            right = sign(squared(first) - squared(other))
            assert compared(first, other) == right
            assert factor == 0.1 or right == 0
    assert compared([-5, 0, 5, 0, -5, 0], [5, 0, 3, 4, 0, 5]) == 0
