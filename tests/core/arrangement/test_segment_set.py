"""Lattice points at one place."""

import numpy as np
import pytest

from vorotool import _core


@pytest.mark.parametrize("count", [0, 1, 2, 70, 5000])
@pytest.mark.parametrize(("size", "step"), [(1, 7), (3, 2**20), (40, 12), (2**30 - 1, 1)])
def test_first_at_place(count, size, step):
    random = np.random.default_rng([count, size])
    points = (random.integers(-size, size + 1, (count, 2)) * step).astype(np.int32)
    points[count // 2 :] = points[: count - count // 2][::-1]
    first = {}
    expected = [first.setdefault(tuple(point), k) for k, point in enumerate(points.tolist())]
    assert _core.arrangement.first_at_place(points, None).tolist() == expected
