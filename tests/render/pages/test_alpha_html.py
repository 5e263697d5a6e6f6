"""The page with a slider, in a real browser where there is one."""

from __future__ import annotations

import re
from html import unescape

import numpy as np
import pytest
from PIL import Image

from support.families.point_families import draw
from support.few import few
from support.processes.browser import browse, needs_browser
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool import LimitError, alpha_complex, alpha_curves, alpha_shape
from vorotool.render.canvas.styles import BOUNDARY, CELLS, SEED, SINGULAR
from vorotool.render.pages.html import MOST_POINTS, check_family_size, write_alpha_html
from vorotool.types.alpha.complex import CLASSES
from vorotool.types.fields import with_y_axis


def page_of(family, **options):
    return bytes_of(write_alpha_html, family, alpha_curves(family), **options).decode()


def shown(document, name):
    return unescape(re.search(rf'id="{name}"[^>]*>([^<]*)<', document)[1])


def test_nothing_is_loaded_from_elsewhere():
    page = page_of(alpha_complex(draw("uniform", 40, 0)))
    assert "<!DOCTYPE html>" in page
    assert not re.search(r"(src|href)\s*=|https?:|@import|url\(", page)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    family = alpha_complex(np.unique(draw("small_lattice", 120, 3), axis=0))
    path = tmp_path_factory.mktemp("page") / "page.html"
    path.write_text(page_of(family, r=1.25), encoding="utf-8")
    return family, path


@needs_browser
@pytest.mark.parametrize("r", few([None, 0.8, 50.0], 1))
def test_the_page_counts_what_the_library_does(page, r):
    family, path = page
    document = browse("--dump-dom", f"{path.as_uri()}{'' if r is None else f'#r={r}'}")
    shape = alpha_shape(family, r=r or 1.25)
    assert f'data-drawn="{r or 1.25:g}"' in document
    counts = np.bincount(shape.edge_classes, minlength=4)
    for name, count in zip(CLASSES, counts.tolist(), strict=True):
        assert shown(document, name) == str(count)
    assert shown(document, "points") == str(len(family.points))
    assert shown(document, "triangles") == str(int(shape.inside.sum()))
    assert shown(document, "regions") == str(shape.region_count)
    assert shown(document, "cavities") == str(shape.cavity_count)
    assert float(shown(document, "area")) == pytest.approx(shape.area, rel=1e-6)
    assert float(shown(document, "perimeter")) == pytest.approx(shape.perimeter, rel=1e-6)
    reached = family.reached(r or 1.25)
    assert f"{reached} of {len(family.spectrum)} critical radii" in shown(document, "alpha")


@needs_browser
def test_the_page_is_drawn(page, tmp_path):
    _, path = page
    browse("--window-size=1000,700", f"--screenshot={tmp_path / 'shot.png'}", f"{path.as_uri()}#r=1.2")
    with Image.open(tmp_path / "shot.png") as image:
        pixels = np.asarray(image.convert("RGB")).reshape(-1, 3)
    colors = {name: bytes.fromhex(value[1:]) for name, value in
               {"triangles": CELLS[4], "boundary": BOUNDARY, "singular": SINGULAR, "points": SEED}.items()}  # fmt: skip
    for name, color in colors.items():
        assert (pixels == np.frombuffer(color, np.uint8)).all(axis=1).sum() > 20, name


@needs_browser
def test_the_buttons_and_the_slider_move_r(page, tmp_path):
    """The page is told to press them, and says what it shows then."""
    family, path = page
    script = (
        "<script>element('forward').click(); const a = r; element('back').click(); const b = r;"
        "element('slider').value = 1900; element('slider').dispatchEvent(new Event('input')); const c = r;"
        "element('r').value = '0.75'; element('r').dispatchEvent(new Event('input'));"
        "document.title = [a, b, c, r].join(' ');</script>"
    )
    changed = tmp_path / "pressed.html"
    changed.write_text(path.read_text(encoding="utf-8").replace("</body>", script + "</body>"), encoding="utf-8")
    document = browse("--dump-dom", f"{changed.as_uri()}#r=1.2")
    after, before, far, typed = map(float, re.search(r"<title>([^<]*)</title>", document)[1].split())
    at = family.reached(1.2)
    assert after == family.spectrum[at]
    assert before == family.spectrum[at - 1]
    assert far > family.spectrum[len(family.spectrum) // 2]
    assert typed == 0.75
    shape = alpha_shape(family, r=0.75)
    assert shown(document, "boundary") == str(int((shape.kind == 2).sum()))


def test_y_upwards():
    family = alpha_complex([[0, 0], [4, 0], [0, 3]])
    assert page_of(with_y_axis(family, "up")) != page_of(with_y_axis(family, "down")) == page_of(family)


def test_too_many_points():
    family = alpha_complex(draw("uniform", MOST_POINTS + 1, 0))
    refused(LimitError, r'100001 points are too many for a page, .* use fmt="svg" or "png"', check_family_size, family)
