"""Pictures and pages of ``vorotool voronoi``."""

import json
import re
import warnings
from pathlib import Path

import pytest

import vorotool
from vorotool import VorotoolWarning

LAKES = Path("data/great-lakes.geojson").resolve()


@pytest.mark.parametrize("options", [("--pixel-size", "0.5um"), ("--clip", LAKES)])
def test_a_page_names_cells(run, folder, options):
    run(f"voronoi {LAKES} -q -o a.html", *options)
    data = json.loads(re.search(r"const data = (.*);\n", (folder / "a.html").read_text())[1])
    assert data["ids"] == ["1", "2", "3"]
    columns = {each["name"]: each["values"] for each in data["columns"]}
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        cells = vorotool.voronoi(vorotool.read(LAKES), clip=vorotool.read(LAKES) if "--clip" in options else None)
    scale = 0.5 if "--pixel-size" in options else 1
    assert columns["own_area"] == pytest.approx(scale**2 * cells.own_areas)
    assert columns["max_distance"] == pytest.approx(scale * cells.reaches, abs=1e-9)
    assert columns["name"] == ["Lake Michigan", "Lake Superior", "Lake Huron"]
