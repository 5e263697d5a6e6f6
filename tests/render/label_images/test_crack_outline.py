import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from vorotool.render.label_images.crack_outline import crack_loops


def filled(shape: tuple[int, int], loops: list[list[tuple[int, int]]]) -> np.ndarray:
    """Even-odd filling: each vertical step turns all pixels to its right."""
    mask = np.zeros(shape, bool)
    for loop in loops:
        assert len(loop) % 2 == 0
        for (x0, y0), (x1, y1) in zip(loop, loop[1:] + loop[:1], strict=True):
            assert (x0 == x1) != (y0 == y1)
            if x0 == x1:
                mask[min(y0, y1) : max(y0, y1), x0:] ^= True
    return mask


@given(hnp.arrays(np.uint16, hnp.array_shapes(min_dims=2, max_dims=2, max_side=9), elements=st.integers(0, 3)))
def test_filled_outlines_are_the_labels(labels: np.ndarray) -> None:
    found = dict(crack_loops(labels))
    assert list(found) == sorted(set(labels.ravel().tolist()) - {0})
    for label, loops in found.items():
        np.testing.assert_array_equal(filled(labels.shape, loops), labels == label)
        for loop in loops:
            assert loop[0][1] == loop[1][1]
