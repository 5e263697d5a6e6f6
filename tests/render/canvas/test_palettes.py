import itertools

import numpy as np
import pytest
from skimage.color import deltaE_ciede2000, rgb2lab

from vorotool.errors import LimitError
from vorotool.render.canvas.styles import CELLS, LINE, SEED, picture_palette

# normal vision, severe protanopia, deuteranopia and tritanopia, on linear RGB (Machado et al. 2009, table 1)
DEFICIENCIES = [
    np.eye(3),
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
]


def as_seen(names: list[str], deficiency: object) -> np.ndarray:
    rgb = np.array([list(bytes.fromhex(name[1:])) for name in names]) / 255
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    seen = np.clip(linear @ np.transpose(deficiency), 0, 1)
    return rgb2lab(np.where(seen <= 0.0031308, seen * 12.92, 1.055 * seen ** (1 / 2.4) - 0.055))


@pytest.mark.parametrize(("count", "least"), [(4, 12.0), (8, 10.0), (12, 8.0)])
@pytest.mark.parametrize("deficiency", DEFICIENCIES)
def test_cells_are_distinct_in_any_color_vision(count: int, least: float, deficiency: object) -> None:
    lab = as_seen(list(CELLS[:count]), deficiency)
    for a, b in itertools.combinations(range(count), 2):
        assert deltaE_ciede2000(lab[a], lab[b]) > least, (CELLS[a], CELLS[b])


@pytest.mark.parametrize("deficiency", DEFICIENCIES)
def test_lines_and_seeds_stand_out(deficiency: object) -> None:
    lab = as_seen([LINE, SEED, *CELLS], deficiency)
    for dark in lab[:2]:
        assert (deltaE_ciede2000(dark[None], lab[2:]) > 25).all()


@pytest.mark.parametrize(
    ("classes", "entries", "bit_depth"), [(0, 15, 4), (12, 15, 4), (13, 16, 4), (14, 17, 8), (253, 256, 8)]
)
def test_palette_fits_its_bits(classes: int, entries: int, bit_depth: int) -> None:
    palette = picture_palette(classes)
    assert palette.colors.shape == (entries, 3)
    assert palette.bit_depth == bit_depth
    assert palette.colors[[0, palette.line]].tolist() == [[255] * 3, [0] * 3]
    assert palette.seed == entries - 1


def test_too_many_classes() -> None:
    with pytest.raises(LimitError, match="254 color classes"):
        picture_palette(254)
