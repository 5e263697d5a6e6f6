"""The page of alpha shapes in space: its data are the library's, and a browser shows them, where there is one."""

import io
import json
import re
from base64 import b64decode

import numpy as np
import pytest
from PIL import Image

from support.few import few
from support.processes.browser import browse, needs_browser
from vorotool import LimitError, alpha_complex, alpha_curves, alpha_shape, delaunay
from vorotool.render.canvas.styles import CELLS, SEED, SINGULAR
from vorotool.render.pages import html
from vorotool.types.alpha.radii import checked_radius

pytestmark = pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")  # of duplicates, and of too few points
CLOUD = np.random.default_rng(5).integers(0, 9, (150, 3))  # with duplicates, and equal radii
FEW = {
    "nothing": np.empty((0, 3)),
    "one": [[1, 2, 3]],
    "same": [[1, 2, 3], [1, 2, 3]],
    "a pair": [[1, 2, 3], [1, 2, 7]],
    "on a line": [[0, 0, 0], [1, 1, 1], [3, 3, 3]],
    "in a plane": [[0, 0, 1], [4, 0, 1], [0, 3, 1], [9, 9, 1]],
    "large": [[0, 0, 0], [1e308, 0, 0], [0, 1e308, 0], [0, 0, 1e308]],
    "small": [[0, 0, 0], [1e-300, 0, 0], [0, 1e-300, 0], [0, 0, 1e-300]],
}
KINDS = ("surface", "faces", "singular", "isolated")


def page_of(family, **options):
    out = io.BytesIO()
    html.write_alpha_html(out, family, alpha_curves(family), **options)
    return out.getvalue().decode()


def data_of(page):
    """Data as the script of the page decodes them."""
    found = json.loads(re.search(r"const data = (.*);\n", page)[1])

    def decoded(name, kind, size=1):
        values = np.frombuffer(b64decode(found[name]), kind)
        return values if size == 1 else values.reshape(-1, size)

    arrays = {"places": decoded("places", "<f4", 3), "spectrum": decoded("spectrum", "<f8")}
    for name, size in (("edge", 2), ("triangle", 3)):
        arrays[f"{name}s"] = decoded(f"{name}s", "<u4", size)
        arrays |= {f"{name}_{rank}": decoded(f"{name}_{rank}", "<i4") for rank in ("min", "mid", "max")}
    return found | arrays | {"point_min": decoded("point_min", "<i4")}


def test_a_triangulation_has_a_page_without_a_radius():
    mesh = delaunay(CLOUD)
    out = io.BytesIO()
    html.write_space_html(out, mesh)
    data = data_of(out.getvalue().decode())
    assert (data["title"], data["curves"], len(data["spectrum"])) == ("Delaunay triangulation", {}, 0)
    assert corners(between(("mid", "max"), data, "triangle", 0)) == corners(mesh.hull)
    outer = corners(between(("mid", "max"), data, "edge", 0))
    assert outer == sorted(set(corners(mesh.hull[:, [0, 1, 0, 2, 1, 2]].reshape(-1, 2))))
    assert sorted(outer + corners(between(("min", "mid"), data, "edge", 0))) == corners(mesh.edges)


@needs_browser
@pytest.mark.parametrize("name", few([*FEW, "cloud"], 1))
def test_a_triangulation_is_shown(name, tmp_path):
    mesh = delaunay(CLOUD if name == "cloud" else FEW[name])
    path = tmp_path / "page.html"
    with path.open("wb") as out:
        html.write_space_html(out, mesh)
    document = browse("--dump-dom", path.as_uri())
    counts = [int(shown(document, layer)) for layer in ("surface", "edges", "interior", "dots", "points")]
    faces = mesh.hull if len(mesh) else mesh.planar
    assert (counts[0], counts[1] + counts[2]) == (len(faces), len(mesh.edges))
    assert counts[3:] == [len(mesh.points)] * 2
    assert 'id="radius" hidden' in document


def shown(document, name):
    return re.search(rf'id="{name}"[^>]*>([^<]*)<', document)[1]


def corners(rows):
    return sorted(tuple(sorted(row)) for row in np.asarray(rows).tolist())


def between(ranks, data, name, count):
    low, high = (data[f"{name}_{rank}"] for rank in ranks)
    return data[f"{name}s"][(low < count) & (count <= high)]


def check_data(points, r):
    family = alpha_complex(points, allow_empty=True)
    data, shape = data_of(page_of(family)), alpha_shape(family, r=r)
    count = family.reached(checked_radius(r))
    assert corners(between(("mid", "max"), data, "triangle", count)) == corners(shape.surface)
    assert corners(between(("min", "mid"), data, "triangle", count)) == corners(shape.singular)
    assert corners(between(("min", "mid"), data, "edge", count)) == corners(shape.singular_edges)
    assert np.flatnonzero(count <= data["point_min"]).tolist() == shape.isolated.tolist()
    on = np.concatenate([shape.surface, shape.singular])[:, [0, 1, 0, 2, 1, 2]].reshape(-1, 2)
    drawn = set(corners(between(("mid", "max"), data, "edge", count)))
    assert set(corners(on)) <= drawn <= set(corners(shape.edges))
    return family, data


@pytest.mark.parametrize("r", few([0.4, 0.5, 1.0, 1.5, 2.0, 3.0, 30.0], 3))
def test_data_are_those_of_the_library(r):
    family, data = check_data(CLOUD, r)
    np.testing.assert_array_equal(data["spectrum"], family.spectrum)
    middle = (CLOUD.min(axis=0) + CLOUD.max(axis=0)) / 2
    away = CLOUD - middle
    np.testing.assert_allclose(data["places"], away / np.sqrt((away**2).sum(axis=1).max()), atol=1e-7)
    curves = alpha_curves(family)
    for name, text in data["curves"].items():
        kind = "<f8" if name in ("volume", "area") else "<i4"
        np.testing.assert_array_equal(np.frombuffer(b64decode(text), kind), curves[name])


@pytest.mark.parametrize("name", FEW)
def test_few_points_have_a_page(name):
    _, data = check_data(FEW[name], 1.75)
    assert np.isfinite(data["places"]).all()
    assert np.abs(data["places"]).max(initial=0) <= 1


def test_pages_are_deterministic_and_load_nothing():
    page = page_of(alpha_complex(CLOUD), r=1.5, unit="µm")
    assert page == page_of(alpha_complex(CLOUD), r=1.5, unit="µm")
    assert '"unit":"\\u00b5m"' in page
    assert not re.search(r"(src|href)\s*=|https?:|@import|url\(|/\*VIEW", page)


def test_too_many_simplices(monkeypatch):
    family = alpha_complex(CLOUD)
    count = len(family.edges) + len(family.triangles)
    monkeypatch.setattr(html, "MOST_SIMPLICES", count)
    html.check_family_size(family)
    monkeypatch.setattr(html, "MOST_SIMPLICES", count - 1)
    with pytest.raises(LimitError, match=f"{count} edges and triangles are too many for a page, at most {count - 1}"):
        html.check_family_size(family)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    family = alpha_complex(CLOUD)
    path = tmp_path_factory.mktemp("page") / "page.html"
    path.write_text(page_of(family, r=1.25, unit="mm"), encoding="utf-8")
    return family, path


@needs_browser
@pytest.mark.parametrize("r", few([1.0, 0.1, 2.0, 50.0], 1))
def test_the_page_counts_what_the_library_does(page, r):
    family, path = page
    document = browse("--dump-dom", f"{path.as_uri()}#r={r}")
    shape = alpha_shape(family, r=r)
    parts = shape.surface, shape.singular, shape.singular_edges, shape.isolated
    counts = {name: len(part) for name, part in zip(KINDS, parts, strict=True)}
    counts |= {"regions": shape.region_count, "parts": shape.part_count, "cavities": shape.cavity_count}
    counts |= {"tunnels": shape.tunnel_count, "points": len(CLOUD), "dots": len(CLOUD)}
    assert {name: int(shown(document, name)) for name in counts} == counts
    for name, exponent in (("volume", "³"), ("area", "²")):
        text = shown(document, name)
        assert float(text.split()[0]) == pytest.approx(getattr(shape, name), rel=1e-6)
        assert text.endswith(f" mm{exponent}") or float(text) == 0
    assert shown(document, "unit") == "mm"
    assert "hidden" in re.search('<p id="missing"[^>]*>', document)[0]


@needs_browser
def test_the_page_is_drawn(page, tmp_path):
    _, path = page
    browse("--window-size=1000,700", f"--screenshot={tmp_path / 'shot.png'}", f"{path.as_uri()}#r=0.9")
    with Image.open(tmp_path / "shot.png") as image:
        pixels = np.asarray(image.convert("RGB"))[:, :640].reshape(-1, 3).astype(int)
    for color in (SINGULAR, SEED):
        assert (pixels == list(bytes.fromhex(color[1:]))).all(axis=1).sum() > 20, color
    for color in CELLS[:2]:  # in some light: a multiple of the color
        light = pixels / list(bytes.fromhex(color[1:]))
        assert ((np.ptp(light, axis=1) < 0.02) & (light.min(axis=1) > 0.33)).sum() > 200, color


@needs_browser
def test_without_webgl_the_page_says_so(page):
    _, path = page
    document = browse("--disable-3d-apis", "--dump-dom", f"{path.as_uri()}#r=2")
    assert "needs WebGL 2" in re.search('<p id="missing">([^<]*)<', document)[1]
    assert int(shown(document, "surface")) == len(alpha_shape(CLOUD, r=2).surface)


@needs_browser
def test_keys_the_wheel_and_fingers_move_the_view(page, tmp_path):
    """The page is told to use them, and says what it shows then."""
    _, path = page
    script = """<script>
      const seen = [], see = () => seen.push({ ...eye });
      const press = (key, shiftKey = false) => canvas.dispatchEvent(new KeyboardEvent("keydown", { key, shiftKey }));
      canvas.setPointerCapture = () => {};
      const point = (kind, pointerId, clientX, clientY) =>
        canvas.dispatchEvent(new PointerEvent(`pointer${kind}`, { pointerId, clientX, clientY }));
      see(); press("ArrowLeft"); see(); press("ArrowUp"); see(); press("+"); see(); press("ArrowRight", true); see();
      press("0"); see();
      point("down", 1, 100, 100); point("move", 1, 160, 100); see();
      point("down", 2, 200, 100); point("move", 2, 240, 100); see(); point("up", 1); point("up", 2);
      button.click(); canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: -100 })); see();
      element("steps").click(); element("slider").value = 7; element("slider").dispatchEvent(new Event("input"));
      document.title = JSON.stringify([seen, r]);
    </script>"""
    changed = tmp_path / "pressed.html"
    changed.write_text(path.read_text(encoding="utf-8").replace("</body>", script + "</body>"), encoding="utf-8")
    document = browse("--dump-dom", changed.as_uri())
    seen, r = json.loads(re.search(r"<title>([^<]*)</title>", document)[1])
    home, left, up, near, moved, reset, dragged, pinched, rolled = seen
    assert left["around"] > home["around"]
    assert left["above"] == home["above"] > up["above"]
    assert near["zoom"] == pytest.approx(1.2)
    assert (moved["x"], moved["y"]) == (30, 0)
    assert reset == home
    assert dragged["around"] < home["around"]
    assert pinched["zoom"] == pytest.approx(2)
    assert rolled["zoom"] > 1
    assert r == np.unique(alpha_complex(CLOUD).spectrum)[7]
