"""``--scale``, ``--unit``, ``--background``, ``--color``, ``--line-width``: what they do, and what is refused."""

import re

import pytest

PICTURES = {
    "skeleton-exact": ["shapes.json"],
    "delaunay": ["dots.csv"],
    "alphashape": ["dots.csv", "-r", "9"],
    "draw": ["shapes.json"],
}
LAYER = {"delaunay": "edges", "alphashape": "boundary", "draw": "shape"}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "shapes.json").write_text("[[[0, 0], [40, 0], [40, 30], [0, 30]]]")
    (tmp_path / "dots.csv").write_text("0,0\n9,0\n9,7\n2,8\n5,3\n")
    logo = '<svg xmlns="http://www.w3.org/2000/svg" width="50mm" viewBox="0 0 50 40"><path d="M2 2h40v30h-40z"/></svg>'
    (tmp_path / "logo.svg").write_text(logo)
    return tmp_path


@pytest.mark.parametrize("command", PICTURES)
def test_looks(run, folder, command):
    layer = LAYER.get(command, "skeleton")
    plain = run(command, *PICTURES[command], "-f", "svg")
    style = ["--color", f"{layer}=navy", "--line-width", f"{layer}=0.25", "--background", "none"]
    done = run(command, *PICTURES[command], "-f", "svg", *style)
    assert 'stroke="#000080"' in done.out or 'fill="#000080"' in done.out
    assert 'stroke-width="0.25"' in done.out
    assert "<rect" in plain.out
    assert "<rect" not in done.out
    paths = [re.findall(r' d="([^"]*)"', text) for text in (plain.out, done.out)]
    assert paths[0] == paths[1]
