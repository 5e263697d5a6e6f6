"""Centerlines: along the middle to the middles of the ends, beside brute force, alone and together."""

import numpy as np
import pytest
import shapely

import vorotool
from support.oracles.centerline_oracle import expected
from vorotool.engines.centerlines.ends import unforked
from vorotool.engines.centerlines.path_network import Network, at_strip_ends
from vorotool.engines.from_skeleton.points_along import first_hits
from vorotool.errors import InputError, UsageError, VorotoolWarning

RECTANGLE = [[0, 0], [10, 0], [10, 4], [0, 4]]
T = [[0, 0], [2, 0], [2, 8], [6, 8], [6, 10], [-4, 10], [-4, 8], [0, 8]]
PLUS = [[1, 0], [2, 0], [2, 1], [3, 1], [3, 2], [2, 2], [2, 3], [1, 3], [1, 2], [0, 2], [0, 1], [1, 1]]


def places(polygon, **options):
    return vorotool.centerline(vorotool.skeleton_exact(polygon), **options).flattened(0.01)[0].tolist()


def ends(polygon, **options):
    line = places(polygon, **options)
    return [line[0], line[-1]]


@pytest.mark.parametrize(
    "criterion", [{}, {"scale": 1.3}, {"scale": 1.42}, {"angle": 100}, {"ratio": 2}, {"length": 1}]
)
def test_a_rectangle_is_gone_through_in_the_middle(criterion):
    skeleton = vorotool.skeleton_exact(RECTANGLE)
    line = vorotool.centerline(vorotool.prune(skeleton, **criterion) if criterion else skeleton)
    assert line.flattened(1)[0].tolist() == [[0, 2], [10, 2]]
    assert (line.length.tolist(), line.width_mean.tolist()) == ([10], [4])


@pytest.mark.parametrize(
    ("kind", "line", "length"),
    [
        ("middle", [[0, 2], [10, 2]], 10),
        ("corner", [[0, 0], [2, 2], [8, 2], [10, 0]], 6 + 4 * 2**0.5),
        ("none", [[2, 2], [8, 2]], 6),
    ],
)
def test_kinds_of_ends(kind, line, length):
    made = vorotool.centerline(vorotool.skeleton_exact(RECTANGLE), ends=kind)
    assert (made.flattened(1)[0].tolist(), made.length.tolist()) == (line, [pytest.approx(length, rel=1e-15)])


@pytest.mark.parametrize(
    ("start", "end", "line"),
    [
        ((0, 2), (10, 2), [[0, 2], [10, 2]]),
        ((0, 0), (10, 4), [[0, 2], [10, 2]]),
        ((-5, 2), (4, 3), [[0, 2], [4, 2]]),
        ((0.5, 2), (1, 2), [[0.5, 2], [1, 2]]),
        ((4, 0), None, [[4, 2], [10, 2]]),
        (None, (4, 0), [[10, 2], [4, 2]]),
    ],
)
def test_paths_between_places_go_up_no_corner(start, end, line):
    found = vorotool.centerline(vorotool.skeleton_exact(RECTANGLE), start=start, end=end).flattened(1)[0]
    assert found[[0, -1]].tolist() == line
    assert (found[:, 1] == 2).all()


@pytest.mark.parametrize(
    ("name", "polygon", "line"),
    [
        ("square", [[3, 3], [5, 3], [5, 5], [3, 5]], [[4, 3], [4, 5]]),
        ("from another corner", [[5, 3], [5, 5], [3, 5], [3, 3]], [[3, 4], [5, 4]]),
        ("3-4-5", [[0, 0], [4, 0], [0, 3]], [[0, 1.5], [1, 1], [4, 0]]),
        ("nearly a square", [[0, 0], [10, 0], [10, 9.5], [0, 9.5]], [[0, 4.75], [10, 4.75]]),
        ("tall trapezoid", [[0, 0], [8, 0], [5, 5], [3, 5]], [[4, 0], [4, 5]]),
        ("hexagon", [[0, 0], [2, -1], [4, -1], [6, 0], [4, 1], [2, 1]], [[0, 0], [6, 0]]),
        ("tip and two edges", [[0, 0], [20, 2], [0, 4], [-0.25, 2]], [[-0.25, 2], [20, 2]]),
        ("parallelogram", [[0, 0], [10, 0], [12, 2], [2, 2]], [[1, 1], [11, 1]]),
        ("thin rhombus", [[0, 0], [5, 1], [10, 0], [5, -1]], [[0, 0], [10, 0]]),
        ("pencil", [[0, 0], [8, 0], [10, 2], [8, 4], [0, 4]], [[0, 2], [10, 2]]),
        ("end of two edges", [[0, 0], [10, 0], [10, 4], [0, 4], [-0.03125, 2]], [[-0.03125, 2], [10, 2]]),
    ],
)
def test_shapes_by_hand(name, polygon, line):
    found = np.array(places(polygon))
    assert found[[0, -1]].tolist() == pytest.approx(np.array(line)[[0, -1]], abs=1e-12)
    assert shapely.LineString(line).hausdorff_distance(shapely.LineString(found)) < 1e-12


@pytest.mark.parametrize(
    ("polygon", "found"),
    [
        (T, [[1, 0], [6, 9]]),  # both arms are as long: the first edge
        ([*T[4:], *T[:4]], [[1, 0], [-4, 9]]),
        (PLUS, [[1.5, 0], [3, 1.5]]),
        ([[-x, y] for x, y in T], [[-1, 0], [-6, 9]]),
    ],
)
def test_of_equally_long_paths_the_first_edges_count(polygon, found):
    assert sorted(ends(polygon)) == sorted(found)


def arms(count, turn):
    """As many equal arms around the origin, whose coordinates are rounded."""
    step = 2 * np.pi / count
    ring = []
    for k in range(count):
        way = np.array([np.cos(k * step + turn), np.sin(k * step + turn)])
        across = np.array([-way[1], way[0]])
        ring += [(12 * way - across).tolist(), (12 * way + across).tolist()]
        ring.append((np.hypot(1, 1 / np.tan(step / 2)) * _middle(way, step)).tolist())
    return ring


def _middle(way, step):
    c, s = np.cos(step / 2), np.sin(step / 2)
    return np.array([c * way[0] - s * way[1], s * way[0] + c * way[1]])


@pytest.mark.parametrize("count", [3, 4, 5])
def test_ties_are_settled_by_edges_however_lengths_are_rounded(count):
    for k in range(12):
        ring = np.add(arms(count, 0.1 * k), [k * 100, k])
        (ends_of,) = vorotool.centerline(vorotool.skeleton_exact(ring.tolist())).ends
        middles = (ring[::3] + ring[1::3]) / 2
        nearest = [int(np.hypot(*(middles - end).T).argmin()) for end in ends_of]
        assert sorted(nearest) == [0, 1]
        assert ends_of == pytest.approx(middles[nearest], abs=1e-6)


def regular(count, turn):
    """A polygon around the origin, whose coordinates are rounded."""
    turns = turn + np.arange(count) * (2 * np.pi / count)
    return np.stack([10 * np.cos(turns), 10 * np.sin(turns)], axis=1)


@pytest.mark.parametrize("count", [5, 6, 8, 9, 24])
def test_a_regular_polygon_is_gone_through_straight_however_it_is_turned(count):
    found = []
    for turn in np.arange(6) * 0.3:
        line = np.array(places(regular(count, turn).tolist()))
        corner, middle = sorted(line[[0, -1]], key=lambda place: -np.hypot(*place))
        assert np.hypot(*corner) == pytest.approx(10)
        assert np.hypot(*middle) == pytest.approx(10 * np.cos(np.pi / count) if count % 2 else 10)
        assert np.abs(line[:, 0] * corner[1] - line[:, 1] * corner[0]).max() < 1e-5
        found.append((np.degrees(np.arctan2(*corner[::-1]) - turn) + 1) % (360 if count % 2 else 180))
    assert np.ptp(found) < 1e-5  # the same corner


def random_polygon(random):
    """Around the origin, with spikes or without."""
    count = int(random.integers(4, 14))
    angle = np.sort(random.random(count)) * 2 * np.pi
    radius = random.choice([(900, 1000), (100, 1000)][int(random.integers(2))], count) + random.random(count)
    return np.round(np.stack([3 * radius * np.cos(angle), radius * np.sin(angle)], axis=1) * 64) / 64


def random_skeletons(count):
    for seed in range(count):
        polygon = random_polygon(np.random.default_rng(seed))
        if shapely.Polygon(polygon).is_valid:
            yield polygon, vorotool.skeleton_exact(polygon.tolist())


def has_strip_ends(skeleton):
    """Whether the centerline ends in the middle of an end of several edges: strips are tested with known axes."""
    network = Network(unforked(skeleton), by_edge=True)
    pieces = network.pieces(network.longest_paths(None))
    return at_strip_ends(network.axis, pieces, len(skeleton), (True, True))[1].any()


def test_brute_force_agrees():
    compared = 0
    for polygon, skeleton in random_skeletons(60):
        brute = expected(skeleton)
        if brute is None or has_strip_ends(skeleton):
            continue
        line = vorotool.centerline(skeleton)
        found = line.flattened(1e-3)[0][[0, -1]]
        for place in brute[0]:
            assert place is None or np.abs(found - place).max(axis=1).min() < 1e-9
        assert (
            np.isnan(line.ends).any() or shapely.Polygon(polygon).boundary.distance(shapely.points(found)).max() < 1e-9
        )
        assert line.path.length.sum() == pytest.approx(brute[1], rel=1e-9)
        compared += 1
    assert compared > 30


def test_lines_that_are_led_on_end_on_edges_exactly():
    random = np.random.default_rng(3)
    square = vorotool.skeleton_exact(RECTANGLE).polygons
    ways = random.standard_normal((1000, 2))
    found, _ = first_hits(square, np.zeros(1000, dtype=int), np.full((1000, 2), [3.1, 1.7]), ways)
    assert (np.isin(found[:, 0], [0, 10]) | np.isin(found[:, 1], [0, 4])).all()


def test_what_is_refused():
    skeleton = vorotool.skeleton_exact(RECTANGLE)
    with pytest.raises(UsageError, match="'round': use middle, corner, none"):
        vorotool.centerline(skeleton, ends="round")
    with pytest.raises(InputError, match="single point"):
        vorotool.centerline(skeleton, start=(3, 2), end=(3, 2))
    with pytest.warns(VorotoolWarning, match="1 of 1 polygons has no centerline: number 1$"):
        assert len(vorotool.centerline(vorotool.skeleton_exact([[0, 0], [2, 0], [2, 2], [0, 2]]), ends="none")) == 0
