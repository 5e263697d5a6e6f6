"""The paper's two passes (section 2.2): to the letter, wrong pixels included."""

import numpy as np
import pytest

import vorotool
from support.oracles.oracles import nearest_labels, paper_passes
from vorotool.engines.tessellation.tessellate import PropagatedRows, propagate
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet

COUNTEREXAMPLES = [
    # seeds (row, column), frame (width, height), the only wrong pixel (row, column)
    ([(0, 2), (2, 1), (6, 0)], (14, 8), (7, 13)),
    ([(0, 0), (1, 6), (2, 8)], (14, 14), (13, 1)),
]


def seed_set(rows_and_columns):
    rows, columns = np.array(rows_and_columns).T
    return SeedSet(columns, rows, np.arange(1, len(rows) + 1))


@pytest.mark.parametrize(("seeds", "size", "pixel"), COUNTEREXAMPLES)
def test_counterexamples_have_exactly_one_wrong_pixel(seeds, size, pixel):
    rows = PropagatedRows(seed_set(seeds), Frame(0, 0, *size))
    found = rows.compare_with_exact()
    assert found["wrong_pixels"] == 1
    assert (found["first_wrong"]["y"], found["first_wrong"]["x"]) == pixel
    squares = {k: (pixel[0] - r) ** 2 + (pixel[1] - c) ** 2 for k, (r, c) in enumerate(seeds, start=1)}
    assert found["first_wrong"]["exact_label"] == min(squares, key=squares.get)
    assert squares[found["first_wrong"]["label"]] > squares[found["first_wrong"]["exact_label"]]


@pytest.mark.parametrize("passes", [1, 2])
@pytest.mark.parametrize("seed", range(8))
def test_the_passes_are_those_of_the_paper(seed, passes):
    rng = np.random.default_rng(seed)
    for _ in range(6):
        width, height = (int(v) for v in rng.integers(1, 30, 2))
        n = int(min(rng.integers(1, 20), width * height))
        y, x = np.divmod(rng.choice(width * height, n, replace=False), width)
        right = paper_passes({k + 1: (x[k] + 1, y[k] + 1) for k in range(n)}, width, height, passes)
        image = propagate(SeedSet(x, y, np.arange(1, n + 1)), Frame(0, 0, width, height), passes=passes)
        np.testing.assert_array_equal(image.labels, right)


def test_wrong_pixels_are_counted_against_brute_force():
    rng = np.random.default_rng(4)
    angle = rng.random(60) * 2 * np.pi
    x, y = (np.rint(64 + 50 * f(angle)).astype(np.int64) for f in (np.cos, np.sin))
    _, first = np.unique(x * 1000 + y, return_index=True)
    x, y = x[first], y[first]
    labels = np.arange(1, len(x) + 1)
    rows = PropagatedRows(SeedSet(x, y, labels), Frame(0, 0, 128, 128))
    wrong = rows.labels() != nearest_labels(x, y, labels, (0, 0, 128, 128))
    assert wrong.sum() > 0  # a ring of nearly cocircular seeds misleads the passes
    found = rows.compare_with_exact()
    assert found["wrong_pixels"] == wrong.sum()
    assert (found["first_wrong"]["y"], found["first_wrong"]["x"]) == tuple(np.argwhere(wrong)[0])


@pytest.mark.parametrize(
    ("seeds", "options", "error", "message"),
    [
        (SeedSet([1], [1], [1], scale=2), {}, InputError, "starts from pixels"),
        (SeedSet([9], [1], [1]), {}, InputError, r"seed \[0\] at \(9, 1\) is outside the frame"),
        (SeedSet([], [], []), {}, InputError, "no seeds"),
        (SeedSet([1], [1], [1]), {"passes": 3}, UsageError, "passes is 3"),
    ],
)
def test_bad_input_is_named(seeds, options, error, message):
    with pytest.raises(error, match=message):
        propagate(seeds, Frame(0, 0, 4, 4), **options)


def test_limits_of_the_library_function():
    with pytest.raises(UsageError, match="no distance limit"):
        vorotool.tessellate([[0, 0]], shape=(4, 4), method="propagation", max_distance=3)
    with pytest.raises(LimitError, match="max_pixels="):
        vorotool.tessellate([[0, 0]], shape=(4, 4), method="propagation", max_pixels=15)
