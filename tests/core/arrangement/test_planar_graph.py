"""Planar graphs of lattice rings beside the definition, by brute force in rationals."""

import re

import numpy as np
import pytest

from support.families.polygon_families import FAMILIES, LIMIT, LINE, draw, graph_of, rings_of
from support.few import few
from support.oracles import planar_graph_oracle as oracle
from vorotool import _core


def fault(graph):
    return _core.arrangement.find_fault(graph.points, graph.segments, graph.segment_faces, None)


def assert_pieces_follow_their_edges(graph, vertices, rings):
    """Segments come edge by edge, directed and in order along the first edge that each is part of."""
    before = (-1, None)
    for k, (i, j) in enumerate(graph.segments.tolist()):
        edge = int(graph.sources_of(k)[0])
        begin, end, _, _ = rings[oracle.ring_of(rings, edge)]
        a, b = vertices[edge].tolist(), vertices[begin if edge + 1 == end else edge + 1].tolist()
        start, stop = (
            [(p - q) * (r - q) for p, q, r in zip(graph.points[e].tolist(), a, b, strict=True)] for e in (i, j)
        )
        assert all(x <= y for x, y in zip(start, stop, strict=True))
        assert start != stop
        assert edge > before[0] or (edge == before[0] and all(x <= y for x, y in zip(before[1], start, strict=True)))
        before = (edge, stop)


def check(vertices, rings):
    """Compare with the definition; small inputs only."""
    graph = graph_of(vertices, rings)
    assert fault(graph) is None
    points = [tuple(p) for p in graph.points.tolist()]
    assert oracle.fault(points, graph.segments.tolist()) is None
    assert_pieces_follow_their_edges(graph, vertices, rings)
    expected, moved = oracle.planar_graph(vertices.tolist(), rings)
    assert oracle.described(graph) == expected
    assert graph.repairs["moved_edges"] == moved
    ends = {p for pair in expected for p in pair}
    alone = {tuple(vertices[begin].tolist()) for begin, _, kind, _ in rings if kind == LINE}
    holes = oracle.holes_of(graph)
    assert holes == oracle.point_holes(vertices.tolist(), rings, expected)
    assert set(points) == ends | alone | {place for place, _ in holes}
    for vertex, point in zip(graph.point_vertex.tolist(), points, strict=True):
        first = next((i for i, v in enumerate(vertices.tolist()) if tuple(v) == point), -1)
        assert vertex == first
    return graph


@pytest.mark.parametrize("name", FAMILIES)
@pytest.mark.parametrize("n", few([3, 8, 1, 2, 4, 5, 6, 11], 3))
def test_small_inputs_beside_the_definition(name, n):
    for seed in range(5 if n < 6 else 2 if n < 11 else 1):
        check(*draw(name, n, [seed, n]))


HOLES = {
    "a point": ([[3, 2]], 0),
    "a point, twice": ([[3, 2], [3, 2], [3, 2]], 0),
    "a segment": ([[3, 2], [5, 4]], 0),
    "a segment, there and back": ([[3, 2], [5, 4], [3, 2], [5, 4]], 0),
    "from the middle of an edge": ([[4, 0], [5, 4]], 0),
    "across an edge": ([[4, -4], [5, 4]], 0),
    "across the polygon": ([[-2, 4], [12, 4]], 0),
    "along an edge": ([[-2, 0], [6, 0]], 0),
    "a point on an edge": ([[4, 0]], 0),
    "a point outside": ([[-4, 0]], 0),
    "a segment outside": ([[-4, 0], [-2, 5]], 0),
    "of another polygon": ([[3, 2], [5, 4]], 1),
}


@pytest.mark.parametrize(("hole", "polygon"), HOLES.values(), ids=HOLES)
def test_holes_without_an_area(hole, polygon):
    """Points and segments are there where they lie in their polygon; the last ones are a segment and its end."""
    shells = [[[0, 0], [8, 0], [8, 8], [0, 8]], [[20, 0], [28, 0], [28, 8], [20, 8]]]
    holes = [(hole, 1, polygon), ([[1, 6], [3, 6]], 1, 0), ([[3, 6]], 1, 0)]
    order = sorted([(shell, 0, k) for k, shell in enumerate(shells)] + holes, key=lambda ring: ring[2])
    end = np.cumsum([len(xy) for xy, _, _ in order]).tolist()
    rings = [(last - len(xy), last, kind, of) for last, (xy, kind, of) in zip(end, order, strict=True)]
    check(np.concatenate([xy for xy, _, _ in order]).astype(np.int32), rings)


@pytest.mark.parametrize("name", ["tiny", "collinear", "mosaic", "star", "spikes"])
def test_the_eight_symmetries(name):
    """The cells are half-open, so that only what does not move is the same under reflection."""
    for seed in range(5):
        vertices, rings = draw(name, 12, [3, seed])
        graph = graph_of(vertices, rings)
        if graph.repairs["moved_edges"]:
            continue
        pairs = {frozenset(map(tuple, pair)) for pair in graph.points[graph.segments].tolist()}
        for sx, sy, swap in [(1, -1, 0), (-1, 1, 0), (-1, -1, 0), (1, 1, 1), (1, -1, 1), (-1, 1, 1), (-1, -1, 1)]:
            turned = vertices * np.array([sx, sy], dtype=np.int32)
            turned = np.ascontiguousarray(turned[:, ::-1] if swap else turned)
            other = graph_of(turned, rings)
            back = other.points[:, ::-1] if swap else other.points
            back = back * [sx, sy]
            assert {frozenset(map(tuple, pair)) for pair in back[other.segments].tolist()} == pairs
            assert other.repairs == graph.repairs


def chain_of_disturbances(length):
    """Segments of which each bends where it passes beside the first end of the next one; and two that are far away."""
    xy = [[-10, 2], [-8, -2]]  # crosses the first one
    for i in range(length):
        xy += [[10 * (i - 1), 0], [10 * i + 12, 1]]
    xy += [[-1000, 50], [-900, 51], [-960, 50], [-960, 40]]
    return np.array(xy, dtype=np.int32), rings_of([2] * (length + 3), [LINE] * (length + 3))


def test_disturbances_that_spread():
    graph = check(*chain_of_disturbances(12))
    assert graph.repairs["moved_edges"] == 13


def test_disturbances_that_spread_too_far():
    """After some rounds everything is snapped, even what is far away."""
    graph = graph_of(*chain_of_disturbances(40))
    assert fault(graph) is None
    assert graph.repairs["moved_edges"] == 43
    assert any({-960} < set(graph.points[pair, 0].tolist()) for pair in graph.segments)


def test_every_lattice_point_of_a_crossing_of_many():
    """Lines through one point, on the lattice and beside it."""
    for center in ((0, 0), (1, 0), (1, 1)):
        ends = [(a, b) for a in range(-6, 7) for b in range(-6, 7) if max(abs(a), abs(b)) == 6]
        xy = [p for a, b in ends for p in ((a, b), (center[0] - a, center[1] - b))]
        vertices = np.array(xy, dtype=np.int32)
        graph = check(vertices[: 2 * 14], rings_of([2] * 14, [LINE] * 14))
        assert fault(graph) is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda p, s, f: (p[:, [0, 1]] * [1, 0], s, None), "are both at"),
        (lambda p, s, f: (p, s * 0, None), "segment 0 has no length"),
        (lambda p, s, f: (p, s + 1, None), "segment 2 ends at a point that does not exist"),
        (lambda p, s, f: (p, np.concatenate([s, s[:1, ::-1]]), None), "segments 0 and 4 "),
        (lambda p, s, f: (p, np.concatenate([s, [[0, 2], [1, 3]]]), None), "segments 4 and 5 cross"),
        (lambda p, s, f: (np.concatenate([p, [[2, 0]]]), s, None), r"point 4 at \(2, 0\) lies inside segment 0"),
        (lambda p, s, f: (p + LIMIT, s, None), "is beyond the lattice"),
        (lambda p, s, f: (p, s, f[::-1] * [[1, 1], [1, 1], [1, 1], [0, 0]]), "one corner has two faces"),
    ],
)
def test_the_checker_finds_faults(change, message):
    vertices = np.array([[0, 0], [4, 0], [4, 4], [0, 4]], dtype=np.int32)
    graph = graph_of(vertices, rings_of([4], [0]))
    points, segments, faces = change(graph.points, graph.segments, graph.segment_faces)
    points, segments = (np.ascontiguousarray(a, dtype=np.int32) for a in (points, segments))
    faces = None if faces is None else np.ascontiguousarray(faces, dtype=np.int32)
    assert re.search(message, _core.arrangement.find_fault(points, segments, faces, None))


def test_the_checker_compares_new_neighbors():
    """Two segments cross above the end of a third one between them, and nothing else happens."""
    points = np.array([[0, 0], [10, 10], [10, 0], [0, 10], [5, 0], [5, 2]], dtype=np.int32)
    segments = np.array([[0, 1], [2, 3], [4, 5]], dtype=np.int32)
    assert "segments 0 and 1 cross" in _core.arrangement.find_fault(points, segments, None, None)


def test_the_checker_agrees_with_brute_force():
    """On graphs that are made wrong at random."""
    seen = {True: 0, False: 0}
    for seed in range(400):
        rng = np.random.default_rng([2, seed])
        points = np.unique(rng.integers(0, 7, (int(rng.integers(2, 9)), 2)), axis=0).astype(np.int32)
        rng.shuffle(points)
        n = len(points)
        pairs = np.array([(i, j) for i in range(n) for j in range(n) if i != j], dtype=np.int32).reshape(-1, 2)
        chosen = pairs[rng.permutation(len(pairs))[: int(rng.integers(0, 4))]]
        ours = _core.arrangement.find_fault(points, np.ascontiguousarray(chosen), None, None)
        theirs = oracle.fault([tuple(p) for p in points.tolist()], chosen.tolist())
        assert (ours is None) == (theirs is None), (points, chosen, ours, theirs)
        seen[ours is None] += 1
    assert min(seen.values()) > 50
