import itertools

import numpy as np
import pytest

from vorotool.errors import UsageError
from vorotool.render.canvas.styles import picture_palette
from vorotool.render.label_images.png import disc_radius, picture_bands
from vorotool.types.pixel_frame import Frame
from vorotool.types.points.seed_set import SeedSet

PALETTE = picture_palette(4)
RNG = np.random.default_rng(1)
LABELS = RNG.integers(0, 6, (40, 31)).astype(np.uint16)
DIAGRAM = RNG.integers(0, 5, LABELS.shape) == 0
COLORS = np.array([0, 4, 3, 2, 1, 4])
SEEDS = SeedSet(RNG.integers(-2, 34, 9) * 4 + 1, RNG.integers(-2, 43, 9) * 4 + 3, np.arange(1, 10), scale=4)


def picture(heights: list[int] | None = None, **options: object) -> np.ndarray:
    cuts = [0, *itertools.accumulate(heights or [len(LABELS)])]
    pieces = [slice(a, b) for a, b in itertools.pairwise(cuts)]
    settings = {"diagram": (DIAGRAM[p] for p in pieces), "seeds": SEEDS, **options}
    bands = picture_bands(
        (LABELS[p] for p in pieces), shape=LABELS.shape, palette=PALETTE, color_of_label=COLORS, **settings
    )
    return np.concatenate(list(bands))


def discs(frame: Frame) -> np.ndarray:
    """Brute force: pixel centers within the radius of a seed, and the pixel that a seed lies in."""
    y, x = np.mgrid[: LABELS.shape[0], : LABELS.shape[1]]
    hit = np.zeros(LABELS.shape, bool)
    for sx, sy in zip(SEEDS.x / 4 - frame.x, SEEDS.y / 4 - frame.y, strict=True):
        hit |= (x - sx) ** 2 + (y - sy) ** 2 <= disc_radius(LABELS.shape, len(SEEDS)) ** 2
        hit |= (x == np.floor(sx + 0.5)) & (y == np.floor(sy + 0.5))
    return hit


@pytest.mark.parametrize("frame", [None, Frame(-3, 5, 31, 40)])
def test_layers_lie_on_each_other(frame: Frame | None) -> None:
    expected = COLORS[LABELS]
    expected[DIAGRAM] = PALETTE.line
    expected[discs(frame or Frame(0, 0, 31, 40))] = PALETTE.seed
    np.testing.assert_array_equal(picture(frame=frame), expected)


@pytest.mark.parametrize("heights", [[1] * 40, [39, 1], [3, 17, 0, 20]])
def test_bands_do_not_matter(heights: list[int]) -> None:
    np.testing.assert_array_equal(picture(heights), picture())


def test_layers_are_selectable() -> None:
    np.testing.assert_array_equal(picture(layers=["cells"]), COLORS[LABELS])
    np.testing.assert_array_equal(picture(layers=["diagram"]), DIAGRAM * PALETTE.line)
    np.testing.assert_array_equal(picture(layers=["seeds"]), discs(Frame(0, 0, 31, 40)) * PALETTE.seed)
    np.testing.assert_array_equal(picture(diagram=None, seeds=None), COLORS[LABELS])
    with pytest.raises(UsageError, match="'edges'"):
        picture(layers=["edges"])


@pytest.mark.parametrize(
    ("shape", "count", "radius"), [((10, 10), 1, 1.0), ((8192, 8192), 53, 32.768), ((64, 64), 4096, 0.5)]
)
def test_disc_radius(shape: tuple[int, int], count: int, radius: float) -> None:
    assert disc_radius(shape, count) == pytest.approx(radius)
