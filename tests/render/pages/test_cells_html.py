"""The page of cells and labels: its data, and what a real browser shows of it where there is one."""

import json
import re
from base64 import b64decode
from html import unescape
from pathlib import Path

import numpy as np
import pytest
import shapely
from PIL import Image

import vorotool
from support.few import few
from support.processes.browser import browse, needs_browser
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool import LimitError, voronoi_cells
from vorotool.cli.main import main
from vorotool.render.canvas.styles import CELLS
from vorotool.render.pages.html import (
    MOST_CELLS,
    check_cells_size,
    shapes_of_cells,
    shapes_of_labels,
    shapes_of_map,
    write_cells_html,
)
from vorotool.types.fields import with_y_axis

LABELS = np.array([[1, 1, 2, 2], [1, 0, 3, 2], [3, 3, 3, 12]])


def page_of(shapes, classes, columns):
    return bytes_of(write_cells_html, shapes, classes, columns).decode()


def data_of(page):
    return json.loads(re.search(r"const data = (.*);\n", page)[1])


def unpacked(text, dtype):
    return np.frombuffer(b64decode(text), dtype)


def polygons_of(data):
    """The shapes of a page as shapely sees them, by id."""
    xy = unpacked(data["xy"], "<f4").reshape(-1, 2).astype(float)
    rings, shapes = unpacked(data["rings"], "<i4"), unpacked(data["shapes"], "<i4")
    found = {}
    for number, name in enumerate(data["ids"]):
        own = [xy[rings[k] : rings[k + 1]] for k in range(shapes[number], shapes[number + 1])]
        area = shapely.Polygon()
        for ring in own:
            area = area.symmetric_difference(shapely.Polygon(ring))
        found[name] = area
    return found


def test_cells_of_a_map_are_its_shapes():
    sites = [shapely.box(0, 0, 6, 6), shapely.box(2, 2, 3, 3), shapely.Point(9, 1)]
    cells = vorotool.voronoi([*sites, shapely.LineString([(8, 4), (9, 6)])], frame=(0, 0, 16, 8), max_distance=2)
    data = data_of(page_of(shapes_of_map(cells), np.ones(4, int), {"area": cells.areas}))
    found = polygons_of(data)
    assert list(found) == ["1", "2", "3", "4"]
    lines = unpacked(data["lines"], "<i4")
    drawn = np.split(16 * unpacked(data["sites"], "<f4").reshape(-1, 2), lines[1:-1])
    expected = [cells.polygons.ring(k) for k in range(4)]
    expected[:2] = [np.append(ring, ring[:1], axis=0) for ring in expected[:2]]  # polygons are closed
    for one, other in zip(drawn, expected, strict=True):
        np.testing.assert_allclose(one, np.column_stack([other[:, 0], 8 - other[:, 1]]))
    np.testing.assert_allclose([16 * 16 * found[name].area for name in found], cells.areas, rtol=2e-3)


@pytest.mark.parametrize("y_up", [False, True])
def test_cells_are_outlined(y_up):
    points = np.random.default_rng(3).uniform(0, 50, (30, 2))
    cells = voronoi_cells(points, frame=(0, 0, 50, 30))
    data = data_of(page_of(shapes_of_cells(with_y_axis(cells, "up" if y_up else "down")), np.ones(30, int), {}))
    found = polygons_of(data)
    assert unpacked(data["lines"], "<i4").tolist() == list(range(31))
    places = 50 * unpacked(data["sites"], "<f4").reshape(-1, 2)
    np.testing.assert_allclose(
        places, np.column_stack([points[:, 0], (30 - points[:, 1]) if y_up else points[:, 1]]), 1e-5
    )
    for cell, area in zip(cells.to_shapely(), found.values(), strict=True):
        assert area.area * 2500 == pytest.approx(cell.area, abs=1e-3)
    site = next(k for k, cell in enumerate(cells.to_shapely()) if cell.area > 0)
    x, y = cells.to_shapely()[site].centroid.coords[0]
    assert found[str(site + 1)].contains(shapely.Point(x / 50, ((30 - y) if y_up else y) / 50))


def test_too_many():
    refused(LimitError, "100001 cells are too many for a page", check_cells_size, MOST_CELLS + 1)


def test_nothing_is_loaded_from_elsewhere():
    page = page_of(shapes_of_labels(LABELS), [1, 2, 3, 4], {})
    assert not re.search(r"(src|href)\s*=|https?:|@import|url\(", page)


@needs_browser
def test_the_browser_names_a_cell(tmp_path):
    path = tmp_path / "page.html"
    columns = {"area": [3, 3, 4, 1], "name": ["a", "b", "<c>", ""]}
    path.write_text(page_of(shapes_of_labels(LABELS), [1, 2, 3, 4], columns))
    document = browse("--dump-dom", f"{path.as_uri()}#id=3")
    cells = [unescape(text) for text in re.findall("<td>([^<]*)</td>", document)]
    assert cells == ["id", "3", "area", "4", "name", "<c>"]
    assert 'data-shown="3"' in document
    assert "4 cells" in document


@needs_browser
@pytest.mark.parametrize(("scheme", "ground"), few([(1, 255), (0, 0x16)], 1))
def test_the_browser_draws_on_light_and_dark_ground(tmp_path, scheme, ground):
    path, picture = tmp_path / "page.html", tmp_path / "page.png"
    path.write_text(page_of(shapes_of_labels(LABELS), [1, 2, 3, 4], {}))
    options = (f"--screenshot={picture}", "--window-size=1000,600", f"--blink-settings=preferredColorScheme={scheme}")
    browse(*options, path.as_uri())
    with Image.open(picture) as image:
        pixels = np.asarray(image.convert("RGB"))
    assert pixels[2, 2, 0] == ground
    # the canvas is 1000 - 320 wide; the image is 4 : 3 with a margin of 20
    side = (680 - 40) / 4
    top = (600 - 3 * side) / 2
    for (y, x), label in np.ndenumerate(LABELS):
        seen = pixels[round(top + (y + 0.5) * side), round(20 + (x + 0.5) * side)]
        number = {0: None, 1: 0, 2: 1, 3: 2, 12: 3}[int(label)]
        if number is None:
            assert seen[0] == ground
        else:
            assert "#" + bytes(seen.tolist()).hex() == CELLS[number]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Image.fromarray(LABELS.astype(np.uint8)).save("labels.png")
    (tmp_path / "dots.csv").write_text("x,y,town\n2,2,Ulm\n9,3,\n5,8,Bern\n")
    return tmp_path


def command(line):
    with pytest.raises(SystemExit) as end:
        main(line.split())
    return end.value.code


def shown_by(line):
    """Ids and columns of the page of a command."""
    assert command(f"{line} -q -o a.html") == 0
    data = data_of(Path("a.html").read_text(encoding="utf-8"))
    return data["ids"], {each["name"]: each["values"] for each in data["columns"]}


def test_pages_of_commands(folder, capsys):
    ids, columns = shown_by("draw labels.png")
    assert (ids, columns["area"]) == (["1", "2", "3", "12"], [3, 3, 4, 1])
    points = vorotool.read("dots.csv", geometry="points")
    ids, columns = shown_by("tessellate dots.csv --size 12x10 --y-up")
    labels = vorotool.tessellate(points, shape=(10, 12)).labels
    assert columns["area"] == [int((labels == int(name)).sum()) for name in ids]
    assert columns["town"] == ["Ulm", "", "Bern"]
    ids, columns = shown_by("delaunay dots.csv --what cells --pixel-size 2mm")
    np.testing.assert_allclose(columns["area"], [4 * cell.area for cell in voronoi_cells(points).to_shapely()])
    assert columns["unit"] == ["mm"] * 3
    ids, columns = shown_by("voronoi dots.csv --pixel-size 0.5um")
    np.testing.assert_allclose(columns["area"], vorotool.voronoi(points).areas / 4)
    assert columns["town"] == ["Ulm", "", "Bern"]
    (folder / "box.json").write_text("[[[0, 0], [4, 0], [0, 3]]]")
    assert command("draw box.json -o box.html") == 2
    assert "a page shows cells or labels, but the input is polygons or lines" in capsys.readouterr().err
    assert command("draw labels.png -o no.html --legend") == 2
    assert "--legend" in capsys.readouterr().err
