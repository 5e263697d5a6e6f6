"""All that takes long reports in one way, and a terminal shows it by the names of the phases."""

import json
from pathlib import Path

import pytest

from vorotool.cli.run import progress_bar
from vorotool.jobs.run_log import Run

DATA = Path(__file__).parents[3] / "data"
RUNS = [
    ("tessellate", DATA / "dots.csv", "--what", "table"),
    ("delaunay", DATA / "dots.csv", "--method", "digital"),
    ("alphashape", DATA / "dots.csv"),
    ("skeleton-exact", DATA / "two-shapes.json", "--side", "both", "--what", "centerline"),
    ("skeleton-exact", DATA / "two-shapes.json", "--what", "offset", "-d", "3"),
    ("skeleton-approx", DATA / "two-shapes.json", "--step", "4"),
]


@pytest.mark.parametrize("arguments", RUNS)
def test_what_is_shown_is_called_as_phases_are(run, folder, monkeypatch, arguments):
    shown = {}
    monkeypatch.setattr(Run, "progress", lambda _, label: shown.setdefault(label, []).append)
    run(*arguments, "--verify", "--stats", "s.json", "-o", "out.csv")
    assert set(shown) <= set(json.loads((folder / "s.json").read_text())["seconds"])
    assert {"read", "verify"} < set(shown)
    assert all(0 <= fraction <= 1 for fractions in shown.values() for fraction in fractions)


def test_a_bar_shows_the_fraction_that_is_done(capfd):
    with progress_bar("sweep") as show:
        show(0.25)
        show(1)
    assert "sweep" in capfd.readouterr().err
