"""Cycles of a permutation of half-edges, taken apart at vertices that they pass twice; connected components."""

from itertools import chain, pairwise

import networkx
import numpy as np
import pytest

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
