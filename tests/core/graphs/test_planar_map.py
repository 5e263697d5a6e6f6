"""Arcs by their ends, and half-edges around faces, by their definitions."""

import numpy as np
import pytest

from support.few import few
from vorotool import _core


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
