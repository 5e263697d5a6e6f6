"""`make figures` draws what it drew when the pictures were last looked at."""

import hashlib
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from PIL import Image

ROOT = Path(__file__).parents[2]
PIXELS = {
    "figure-03a.png": "eb46790d48b0f8fccd36c7174ee5bf47ae186f83d044c9a3bd2f9f7c477ed1bc",
    "figure-lakes.png": "6b4690140c1d8df6bce1765520df3dc28cff6e9526a5e2112a46f88d711a5db2",
}
"""SHA-256 of the RGB pixels."""
FIGURES_5_TO_9 = ("05a", "05b", "05c", "05d", "06", "07", "08", "09-20", "09-15", "09-10", "09-5")


@pytest.fixture(scope="module")
def figures(tmp_path_factory):
    if not (ROOT / "build" / ".installed").exists() or shutil.which("make") is None:
        pytest.skip("the figures are drawn by make, in an environment made by make")
    folder = tmp_path_factory.mktemp("figures")
    subprocess.run(["make", "figures", f"FIGURES={folder}"], cwd=ROOT, check=True, capture_output=True)
    return folder


@pytest.mark.parametrize(
    "name",
    [
        f"figure-{number}.svg"
        for number in ("01", "02", "03b", "03c", "03d", "04a", "04b", "04c", *FIGURES_5_TO_9, "10", "11b", "11c", "11d")
    ],
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
