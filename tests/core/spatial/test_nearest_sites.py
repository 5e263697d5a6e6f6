import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from vorotool import _core


def nearest_other(x, y, labels, threads=1):
    x, y = (np.ascontiguousarray(v, dtype=np.float64) for v in (x, y))
    return _core.spatial.nearest_other_sites(x, y, np.ascontiguousarray(labels, dtype=np.uint32), threads, None)


@given(
    st.lists(st.tuples(st.integers(-6, 6), st.integers(-6, 6)), min_size=2, max_size=60),
    st.sampled_from([1.0, 0.25, 2.0**20]),
    st.randoms(use_true_random=False),
)
@settings(max_examples=40, deadline=None)
def test_nearest_other_site_with_ties(points, unit, random):
    xy = np.array(points) * unit
    labels = list(range(1, len(points) + 1))
    random.shuffle(labels)
    labels = np.array(labels)
    index, distance = nearest_other(xy[:, 0], xy[:, 1], labels, threads=2)
    d2 = ((xy[:, None] - xy[None]) ** 2).sum(axis=2)
    for k in range(len(points)):
        others = [j for j in range(len(points)) if j != k]
        best = min(others, key=lambda j, k=k: (d2[k, j], labels[j]))
        assert index[k] == best
        assert distance[k] == np.sqrt(d2[k, best])


def test_nearest_other_site_in_a_heap_of_duplicates():
    count = 20_000
    labels = np.random.default_rng(0).permutation(count) + 1
    index, distance = nearest_other(np.full(count, 3.5), np.full(count, -1.0), labels)
    assert not distance.any()
    assert (labels[index] == np.where(labels == 1, 2, 1)).all()
