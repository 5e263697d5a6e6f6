"""`make figures` draws what it drew when the pictures were last looked at."""

import hashlib
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

PIXELS = {
    "figure-03a.png": "eb46790d48b0f8fccd36c7174ee5bf47ae186f83d044c9a3bd2f9f7c477ed1bc",
    "figure-lakes.png": "49de66dec3e29ae31b8a96535d452e66becb0828c52b74ca7c1dd11ea245ddc7",
}
"""SHA-256 of the RGB pixels."""
FIGURES_5_TO_9 = ("05a", "05b", "05c", "05d", "06", "07", "08", "09-20", "09-15", "09-10", "09-5")


@pytest.mark.parametrize(
    "name",
    [
        f"figure-{number}.svg"
        for number in ("01", "02", "03b", "03c", "03d", "04a", "04b", "04c", *FIGURES_5_TO_9, "10", "11b", "11c", "11d")
    ]
    + ["error-vs-h.svg"],
)
def test_svg(figures, name):
    assert (figures / name).read_text() == (Path(__file__).parent / name).read_text()


@pytest.mark.parametrize("name", PIXELS)
def test_png(figures, name):
    pixels = Image.open(figures / name).convert("RGB").tobytes()
    assert hashlib.sha256(pixels).hexdigest() == PIXELS[name]


def test_table_1(figures):
    lines = (figures / "table-1.md").read_text().splitlines()
    assert [re.findall(r"[\d.]+", line)[:2] for line in lines[2:]] == [
        ["64", "0.13"], ["128", "0.49"], ["256", "2.4"], ["512", "18.5"],
    ]  # fmt: skip
    for line in lines[2:]:
        *_, passes, exact, ratio = (cell.strip() for cell in line.strip("|").split("|"))
        assert float(passes) > 0
        assert float(exact) > 0
        assert int(ratio.replace(",", "")) > 0


def test_halving_the_step_quarters_errors_away_from_corners(figures):
    """Columns: shape, step, parabolas, their estimate, straight arcs away from corners and near to them, C."""
    lines = (figures / "error-vs-h.md").read_text().splitlines()[2:]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    orders = {row[0]: [float(row[k].removeprefix("order ") or "nan") for k in (2, 4, 5)] for row in rows if not row[1]}
    assert len(orders) == 3
    for parabolas, away, near in orders.values():
        assert 1.9 <= parabolas <= 2.1
        assert 1.8 <= away <= 2.2
        assert np.isnan(near) or 0.8 <= near <= 1.2
    for row in rows:
        for cell in (row[2], row[4], row[5]):
            if "," in cell:
                measured, bound = map(float, cell.split(","))
                assert measured <= bound
        if row[1] and row[5]:
            assert float(row[6]) <= 0.37
