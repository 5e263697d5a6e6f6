import itertools

import numpy as np
import pytest

from support.refusals import refused
from vorotool.formats.io.arrays import blocks, checked


@pytest.mark.parametrize(
    ("heights", "message"), [((2, 2), "4 rows, not 5"), ((3, 3), "more than 5 rows"), ((), "0 rows")]
)
def test_checked_counts_rows(heights: tuple[int, ...], message: str) -> None:
    refused(ValueError, message, list, checked([np.zeros((h, 3)) for h in heights], (5, 3)))


def test_blocks_carry_the_row_before() -> None:
    width = 300_000
    image = np.random.default_rng(1).integers(0, 256, (11, width), dtype=np.uint8)

    def encode(rows: np.ndarray, out: np.ndarray) -> None:
        out[...] = rows

    bands = [image[:1], image[1:6], image[6:6], image[6:]]
    found = list(blocks(bands, image.shape, columns=width, dtype=np.uint8, encode=encode))
    assert [len(block) - 1 for block in found] == [3, 3, 3, 2]
    assert not found[0][0].any()
    np.testing.assert_array_equal(np.concatenate([block[1:] for block in found]), image)
    for before, after in itertools.pairwise(found):
        np.testing.assert_array_equal(before[-1], after[0])
