"""Letters as cells: ink, and a halo of one cell around it."""

import numpy as np
import pytest
from scipy import ndimage

from vorotool.render.canvas.glyphs import text_cells


def picture(text):
    owner, cells, is_ink = text_cells([text])
    assert not owner.any()
    made = np.zeros((15, 6 * len(text) + 15), np.uint8)
    x, y = (cells + np.array([made.shape[1] // 2, 7])).T
    made[y, x] = np.where(is_ink, 2, 1)
    return made


@pytest.mark.parametrize("text", ["0", "8", "17", "lake 5", "ÄÖ", "~"])
def test_the_halo_is_what_touches_the_ink(text):
    made = picture(text)
    np.testing.assert_array_equal(made > 0, ndimage.binary_dilation(made == 2, np.ones((3, 3))))


def test_all_digits_and_letters_differ():
    letters = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
    assert len({picture(letter).tobytes() for letter in letters}) == len(letters)
