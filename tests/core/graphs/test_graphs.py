"""Cycles of permutations, components, colorings and planar maps, beside definitions."""

from itertools import chain, pairwise

import networkx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.few import few
from vorotool import _core


def cycles(following, tail, vertices):
    start, half_edge = _core.graphs.boundary_cycles(
        np.array(following, dtype=np.int32), np.array(tail, dtype=np.int32), vertices
    )
    return [half_edge[a:b].tolist() for a, b in pairwise(start.tolist())]


@pytest.mark.parametrize("seed", few(range(20)))
def test_random_permutations(seed):
    random = np.random.default_rng(seed)
    count, vertices = int(random.integers(1, 60)), int(random.integers(1, 20))
    following, tail = random.permutation(count), random.integers(0, vertices, count)
    found = cycles(following, tail, vertices)
    assert sorted(chain.from_iterable(found)) == list(range(count))
    assert found == sorted(found)
    assert all(each[0] == min(each) for each in found)
    for each in found:
        passed = [tail[h] for h in each]
        assert len(set(passed)) == len(passed)
        # each goes on where the walk goes on from, or at the vertex where a cycle was cut off
        heads = [tail[following[h]] for h in each]
        assert heads == passed[1:] + passed[:1]


def test_what_is_no_permutation():
    with pytest.raises(ValueError, match="permutation"):
        cycles([1, 1], [0, 1], 2)
    for following, tail in (([2, 0], [0, 1]), ([1, 0], [0, 2]), ([0], [0, 1])):
        with pytest.raises(ValueError, match=r"range|tail"):
            cycles(following, tail, 2)
    assert cycles([], [], 0) == []


@pytest.mark.parametrize("seed", range(10))
def test_connected_components(seed):
    random = np.random.default_rng(seed)
    vertices = int(random.integers(1, 50))
    edges = random.integers(0, vertices, (int(random.integers(0, 60)), 2)).astype(np.int32)
    graph = networkx.Graph(edges.tolist())
    graph.add_nodes_from(range(vertices))
    expected = np.empty(vertices, dtype=int)
    for each in networkx.connected_components(graph):
        expected[list(each)] = min(each)
    np.testing.assert_array_equal(_core.graphs.connected_components(edges, vertices), expected)
    with pytest.raises(ValueError, match="range"):
        _core.graphs.connected_components(np.array([[0, vertices]], dtype=np.int32), vertices)


graphs = st.integers(2, 30).flatmap(
    lambda n: st.tuples(st.just(n), st.sets(st.tuples(st.integers(0, n - 1), st.integers(0, n - 1))))
)


def color_graph(vertices, edges):
    edges = np.array(edges, dtype=np.uint32).reshape(-1, 2)
    a, b = (np.ascontiguousarray(edges[:, k]) for k in (0, 1))
    colors = _core.graphs.color_graph(vertices, a, b, None)
    assert (colors[a] != colors[b]).all()
    assert vertices == 0 or sorted(set(colors.tolist())) == list(range(1, colors.max() + 1))
    return colors


def degeneracy(vertices, edges):
    adjacent = {v: set() for v in range(vertices)}
    for a, b in edges:
        adjacent[a].add(b)
        adjacent[b].add(a)
    largest = 0
    while adjacent:
        vertex = min(adjacent, key=lambda v: len(adjacent[v]))
        largest = max(largest, len(adjacent[vertex]))
        for other in adjacent.pop(vertex):
            adjacent[other].discard(vertex)
    return largest


@given(graphs)
@settings(max_examples=50, deadline=None)
def test_coloring_of_any_graph(graph):
    vertices, pairs = graph
    edges = sorted({(min(p), max(p)) for p in pairs if p[0] != p[1]})
    assert color_graph(vertices, edges).max() <= degeneracy(vertices, edges) + 1


def test_coloring_of_adversarial_graphs():
    assert color_graph(0, []).size == 0
    assert color_graph(5, []).tolist() == [1] * 5
    assert color_graph(40, [(a, b) for b in range(40) for a in range(b)]).max() == 40
    crown = [(a, 20 + b) for a in range(20) for b in range(20) if a != b]
    color_graph(40, crown)
    assert color_graph(1001, [(0, k) for k in range(1, 1001)]).max() == 2
    wheel = [(0, k) for k in range(1, 12)] + [(k, k % 11 + 1) for k in range(1, 12)]
    assert color_graph(12, wheel).max() <= 4


@pytest.mark.parametrize("seed", few(range(20)))
def test_arcs_by_ends(seed):
    random = np.random.default_rng(seed)
    vertices = int(random.integers(1, 12))
    arcs = random.integers(0, vertices, (int(random.integers(0, 60)), 2)).astype(np.int32)
    expected = np.lexsort((arcs[:, 1], arcs[:, 0]))
    assert _core.graphs.arcs_by_ends(arcs, vertices).tolist() == expected.tolist()


@pytest.mark.parametrize("seed", few(range(20)))
def test_next_half_edges(seed):
    random = np.random.default_rng(seed)
    vertices, count = int(random.integers(1, 12)), int(random.integers(1, 60))
    arcs = random.integers(0, vertices, (count, 2)).astype(np.int32)
    order = random.permutation(2 * count).reshape(-1, 2).astype(np.int64)
    following = _core.graphs.next_half_edges(arcs, order, vertices)
    tail, rank = arcs.ravel(), order.ravel()
    for h, after in enumerate(following.tolist()):
        back = h ^ 1
        around = [k for k in range(2 * count) if tail[k] == tail[back]]
        below = [k for k in around if rank[k] < rank[back]]
        assert after == max(below or around, key=lambda k: rank[k])


def test_what_is_no_map():
    arcs, order = np.array([[0, 1]], dtype=np.int32), np.zeros((1, 2), dtype=np.int64)
    with pytest.raises(ValueError, match="range"):
        _core.graphs.arcs_by_ends(arcs, 1)
    with pytest.raises(ValueError, match="range"):
        _core.graphs.next_half_edges(arcs, order, 1)
    with pytest.raises(ValueError, match="order"):
        _core.graphs.next_half_edges(arcs, np.zeros((2, 2), dtype=np.int64), 2)
