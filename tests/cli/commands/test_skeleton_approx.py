"""The command skeleton-approx, and pruning and centerlines on the command line."""

import json
from pathlib import Path

import pytest

DATA = Path(__file__).parents[3] / "data"
SHAPES = str(DATA / "two-shapes.json")


@pytest.mark.parametrize("options", [[], ["--stats", "a.json", "--what", "elements"]])
def test_the_comparison_is_said_with_and_without_statistics(run, options):
    done = run(f"skeleton-approx {SHAPES} --step 5 --compare", *options, "-o", "a.npz")
    assert done.err.splitlines() == [
        "note: from approximate to exact the distance is up to 0.825, near (177.349, 179.301)",
        "note: from exact to approximate the distance is up to 5.77, near (330, 40)",
    ]


@pytest.mark.parametrize(
    ("command", "size"), [(["skeleton-exact"], 1e300), (["skeleton-approx", "--step", "1"], 1e-300)]
)
def test_magnitudes_whose_products_are_no_numbers(run, folder, command, size):
    (folder / "a.json").write_text(json.dumps([[0, 0], [size, 0], [size, size]]))
    run(*command, "a.json", "--verify", "-o", "out.json", code=3, says="a.json")
    assert not (folder / "out.json").exists()


@pytest.mark.parametrize("factor", [1e-70, 1e69])
def test_magnitudes_at_the_limits(run, folder, factor):
    (folder / "a.json").write_text(json.dumps([[0, 0], [10 * factor, 0], [factor, 7 * factor]]))
    options = ["--what", "skeleton,table,centerline,offset", "-d", f"{-factor},{factor}", "--verify", "-o", "out"]
    run("skeleton-exact a.json", *options)
    run(f"skeleton-approx a.json --step {factor} --side both --verify -o b.svg")
