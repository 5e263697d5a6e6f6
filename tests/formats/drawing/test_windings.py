"""How often rings turn around places, beside a count over all edges, and in how much memory."""

import numpy as np
import pytest

from support.few import few
from support.processes.peak_memory import memory_below
from vorotool.formats.drawing import fill_rules as module
from vorotool.formats.drawing.fill_rules import windings


def counted(rings, places):
    """Count the edges that a ray towards larger x crosses, one by one."""
    found = []
    for x, y in places:
        turns = 0
        for ring in rings:
            for (ax, ay), (bx, by) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
                side = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
                turns += int(ay <= y < by and side > 0) - int(by <= y < ay and side < 0)
        found.append(turns)
    return found


@pytest.mark.parametrize("at_once", [2**17, 7])
@pytest.mark.parametrize("seed", few(range(12), 3))
def test_windings_of_all_edges(seed, at_once, monkeypatch):
    monkeypatch.setattr(module, "_PAIRS_AT_ONCE", at_once)
    random = np.random.default_rng(seed)
    rings = [random.integers(0, 9, (size, 2)).astype(float) for size in random.integers(1, 40, 4)]
    places = random.integers(0, 18, (60, 2)) / 2  # on vertices and edges, too
    assert windings(rings, places).tolist() == counted(rings, places)


def test_memory_of_windings_is_linear():
    """A line that goes up and down, whose every tooth is in the row of every other."""
    x = np.arange(40_001.0)
    places = np.column_stack([np.arange(20_000) * 2 + 1.0, np.full(20_000, 0.5)])
    with memory_below(2**26):
        assert (np.abs(windings([np.column_stack([x, x % 2])], places)) == 1).all()
