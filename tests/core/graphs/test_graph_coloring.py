from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from vorotool import _core

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
