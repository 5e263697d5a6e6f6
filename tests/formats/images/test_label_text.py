import io

import numpy as np
import pytest

from vorotool.errors import LimitError
from vorotool.formats.images.label_images import write_label_text


def test_columns_are_aligned_and_read_back() -> None:
    labels = np.random.default_rng(1).integers(0, 120, (20, 30))
    out = io.BytesIO()
    write_label_text(out, [labels[:7], labels[7:]], (20, 30), largest_label=119)
    text = out.getvalue().decode()
    assert {len(line) for line in text.splitlines()} == {30 * 4 - 1}
    np.testing.assert_array_equal(np.loadtxt(io.StringIO(text), dtype=int), labels)


@pytest.mark.parametrize("shape", [(1, 4097), (1001, 1000)])
def test_large_images_are_refused(shape: tuple[int, int]) -> None:
    with pytest.raises(LimitError, match=r"use the path labels.png, labels.tif or labels.npy"):
        write_label_text(io.BytesIO(), [], shape, largest_label=1)
