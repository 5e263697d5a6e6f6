"""Intersections of edges along the axes, points of segments, and the lattice, beside definitions in rationals."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import vorotool
from support.families.polygon_families import HOLE, LINE, SHELL, rings_of
from support.oracles.outline_oracle import random_labels
from vorotool import _core
from vorotool.engines.arrangement.planar_graph import placed_vertices

TOUCHING, CROSSING, MOVED, IDLE = 1, 2, 3, 4
"""Repairs, by their places in `geometry.planar_graph.REPAIRS`."""


def sheared(points):
    """Keeps the order of points, column by column, and that of slopes: only rows are no longer along an axis."""
    return np.stack([points[:, 0], points[:, 0] + points[:, 1]], axis=1).astype(np.int32)


def made(vertices, rings):
    _begin, end, kind, polygon = (list(column) for column in zip(*rings, strict=True))
    columns = np.array([0, *end], dtype=np.int64), np.array(kind, dtype=np.int8), np.array(polygon, dtype=np.int32)
    return _core.arrangement.make_planar_graph(np.ascontiguousarray(vertices, dtype=np.int32), *columns, None)


def checked(vertices, rings):
    """The number of repairs of each kind."""
    graph, other = made(vertices, rings), made(sheared(vertices), rings)
    assert sheared(graph.pop("points")).tobytes() == other.pop("points").tobytes()
    repairs = graph.pop("repairs")
    assert repairs == other.pop("repairs")
    assert [name for name in graph if graph[name].tobytes() != other[name].tobytes()] == []
    return [count for count, _, _ in repairs]


def of_outlines(polygons):
    vertices = placed_vertices(polygons).vertices // 4  # leaves room for the shear
    rings = zip(polygons.ring_starts, polygons.ring_starts[1:], polygons.ring_kind, polygons.ring_polygon, strict=False)
    return checked(vertices, list(rings))


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("mode", ["labels", "components"])
def test_outlines_of_pixels(mode, connectivity):
    for seed in range(12):
        labels = random_labels(np.random.default_rng(seed), 40)
        image = labels if mode == "labels" else labels > 0
        if image.any():
            assert of_outlines(vorotool.outlines(image, mode=mode, connectivity=connectivity)) == [0] * 6


@pytest.mark.parametrize("rows", [1, 64, 65, 4096, 4097, 9000])
def test_rows_in_several_levels(rows):
    random = np.random.default_rng(rows)
    mask = np.zeros((rows, 8), dtype=bool)
    mask[random.integers(0, rows, rows // 6 + 1), random.integers(0, 8, rows // 6 + 1)] = True
    mask[-1] = mask[0] = True
    assert of_outlines(vorotool.outlines(mask)) == [0] * 6


def test_rows_far_apart():
    """More of them than a table is made for."""
    assert checked(np.array([[0, 0], [3, 0], [3, 2**28 + 1], [0, 2**28 + 1]]), rings_of([4], [SHELL])) == [0] * 6


def rectilinear_ring(random, corners, size):
    """A closed ring between so many random columns and rows, which may do anything."""
    x, y = random.integers(0, size, (2, corners))
    return np.stack([np.repeat(x, 2), np.roll(np.repeat(y, 2), 1)], axis=1)


@pytest.mark.parametrize("size", [3, 6, 20, 1000])
def test_rings_that_meet_in_any_way(size):
    counts = np.zeros(6, dtype=int)
    for seed in range(60):
        random = np.random.default_rng([size, seed])
        corners = random.integers(1, 6, random.integers(1, 8))
        vertices = np.concatenate([rectilinear_ring(random, each, size) for each in corners])
        kinds = [SHELL, *random.choice([SHELL, HOLE, LINE], len(corners) - 1).tolist()]
        counts += checked(vertices, rings_of((2 * corners).tolist(), kinds))
    assert (counts[[TOUCHING, CROSSING, IDLE]] > 0).all()
    assert counts[MOVED] == 0


BOX = [[0, 0], [8, 0], [8, 8], [0, 8]]


@pytest.mark.parametrize(
    ("other", "kind"),
    [
        ([[2, -1], [4, -1], [4, 9], [2, 9]], CROSSING),
        ([[-1, 2], [9, 2], [9, 4], [-1, 4]], CROSSING),
        ([[8, 2], [9, 2], [9, 4], [8, 4]], TOUCHING),
        ([[-1, 2], [0, 2], [0, 4], [-1, 4]], TOUCHING),
        ([[2, 8], [4, 8], [4, 9], [2, 9]], TOUCHING),
        ([[2, -1], [4, -1], [4, 0], [2, 0]], TOUCHING),
        ([[2, 0], [9, 0], [9, 8], [2, 8]], TOUCHING),
        ([[0, 2], [0, 9], [-9, 9], [-9, 2]], TOUCHING),
        ([[0, 0], [0, 9], [-9, 9], [-9, 0]], TOUCHING),
        ([[0, 0], [9, 0], [9, -9], [0, -9]], TOUCHING),
        ([[8, 0], [9, 0], [9, 8], [8, 8]], None),
        ([[8, 8], [9, 8], [9, 9], [8, 9]], None),
        ([[2, 2], [4, 2], [4, 4], [2, 4]], None),
    ],
)
def test_two_boxes(other, kind):
    counts = checked(np.array(BOX + other), rings_of([4, 4], [SHELL, SHELL]))
    assert [k for k, count in enumerate(counts) if count] == ([] if kind is None else [kind])


@pytest.mark.parametrize("count", [0, 1, 2, 70, 5000])
@pytest.mark.parametrize(("size", "step"), [(1, 7), (3, 2**20), (40, 12), (2**30 - 1, 1)])
def test_first_at_place(count, size, step):
    random = np.random.default_rng([count, size])
    points = (random.integers(-size, size + 1, (count, 2)) * step).astype(np.int32)
    points[count // 2 :] = points[: count - count // 2][::-1]
    first = {}
    expected = [first.setdefault(tuple(point), k) for k, point in enumerate(points.tolist())]
    assert _core.arrangement.first_at_place(points, None).tolist() == expected


LIMIT = 2**30 - 1


def place(points, threads=1):
    return _core.arrangement.place_on_lattice(np.array(points, dtype=np.float64).reshape(-1, 2), threads, None)


def check(points):
    """All that is promised; returns the exponent and the largest move."""
    lattice, origin, exponent, most = place(points)
    step = Fraction(2) ** exponent
    assert np.abs(lattice.astype(np.int64)).max(initial=0) <= LIMIT
    squares = [Fraction(0)]
    for point, placed in zip(points, lattice.tolist(), strict=True):
        moves = [Fraction(x) - Fraction(o) - c * step for x, o, c in zip(point, origin, placed, strict=True)]
        assert all(abs(move) <= step / 2 for move in moves)
        squares.append(sum(move * move for move in moves))
    for o in origin:
        assert Fraction(o) % step == 0
    assert (most == 0) == (max(squares) == 0)
    assert max(squares) <= Fraction(most) ** 2
    tiny = Fraction(2) ** -1074
    assert (Fraction(most) - 4 * tiny) ** 2 <= 2 * max(squares) or Fraction(most) <= 4 * tiny
    extent = max((max(c) - min(c) for c in zip(*(map(Fraction, p) for p in points), strict=True)), default=0)
    if exponent > -1074:
        assert extent > step * (LIMIT - 1)  # a finer lattice would not hold it
    return exponent, most


finite = st.floats(allow_nan=False, allow_infinity=False)
close = st.integers(-(2**20), 2**20).flatmap(lambda k: st.sampled_from([float(k), k / 3, k * 1e-300, k * 1e300]))


@given(st.lists(st.tuples(finite, finite), min_size=1, max_size=8))
def test_any_doubles(points):
    check(points)


@given(st.lists(st.tuples(close, close), min_size=1, max_size=8), st.floats(-1e16, 1e16), st.integers(-1000, 900))
def test_offsets(points, offset, exponent):
    """Small extents far away, and everything times a power of two."""
    check([(x + offset, y) for x, y in points])
    scaled = [(x * 2.0**exponent, y * 2.0**exponent) for x, y in points]
    if np.isfinite(scaled).all():
        check(scaled)


@pytest.mark.parametrize(
    "points",
    [
        [(0.0, 0.0), (2.0**31 - 2, 1.0)],
        [(-(2.0**30) + 1, -5.0), (2.0**30 - 1, 2.0**30 - 1)],
        [(1e15, 1e15), (1e15 + 0.125, 1e15 + 7)],
        [(0.5, 0.25), (1000.75, 3.0)],
        [(0.1, 1e-300)],
        [(1e300, -1e300)],
        [(5e-324, 0.0), (0.0, 5e-324)],
        [(1e-300, 1e-300), (1e-300, np.nextafter(1e-300, 1))],
        [(7.0, 7.0)] * 5,
        [(x, 3.0) for x in range(-1000, 1000, 7)],
    ],
)
def test_what_is_on_a_lattice_does_not_move(points):
    assert check(points)[1] == 0


@pytest.mark.parametrize("scale", [1e-300, 1e-150, 1.0, 1e150, 1e300])
def test_extreme_extents(scale):
    rng = np.random.default_rng(1)
    points = (rng.uniform(-1, 1, (50, 2)) * scale).tolist()
    exponent, most = check([tuple(p) for p in points])
    assert 0 < most <= 0.71 * 2.0**exponent
    check([(-1.7e308, 1.7e308), (1.7e308, -1.7e308), (scale, -scale)])
