"""Drawings in SVG: shapes, curves, transforms, units, styles, against svgelements and windings by brute force."""

import io
import math
import random

import numpy as np
import pytest
import shapely
import svgelements

from support.few import few
from support.readers.svg_reading import read, shape_of, svg
from support.refusals import refused
from vorotool import skeleton_exact, write
from vorotool.errors import InputError
from vorotool.formats.drawing.fill_rules import filled_polygons
from vorotool.types.polygons.shapely_geometry import to_shapely


# ---- shapes --------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("body", "area"),
    [
        ('<rect x="1" y="2" width="4" height="3"/>', 12),
        ('<rect width="10" height="6" rx="2"/>', 60 - (4 - math.pi) * 4),
        ('<rect width="10" height="6" rx="9" ry="1"/>', 60 - (4 - math.pi) * 5),
        ('<circle cx="3" r="2"/>', 4 * math.pi),
        ('<ellipse rx="2" ry="5"/>', 10 * math.pi),
        ('<polygon points="0,0 4,0 4,3"/>', 6),
        ('<polyline points="0 0 4 0 4 3"/>', 6),
        ('<path d="M0 0H4V3z"/>', 6),
        ('<path d="M0 0H4V3"/>', 6),
        ('<path d="M-1 0A1 1 0 0 1 1 0z"/>', math.pi / 2),
        ('<path d="M1 0A1 1 0 1 1 0 -1L0 0z"/>', 0.75 * math.pi),
        ('<path d="M0 0Q1 2 2 0z"/>', 4 / 3),
        ('<path d="M0 0C0 1 1 1 1 0z"/>', 0.6),
        ('<path d="M0 0q1 2 2 0t2 0V-9H0z"/>', 36),
        ('<g transform="scale(2,3)"><circle r="1"/></g>', 6 * math.pi),
        ('<g transform="skewX(40) rotate(10)"><circle r="1"/></g>', math.pi),
        ('<svg x="5" width="20" height="10" viewBox="0 0 2 2"><rect width="2" height="2"/></svg>', 100),
        ('<svg width="20" height="5" viewBox="0 0 2 2" preserveAspectRatio="none"><path d="M0 0h2v2h-2z"/></svg>', 100),
    ],
)
def test_areas(body, area):
    found = shape_of(body, flatten=1e-6)
    assert found.area == pytest.approx(area, rel=1e-5)


def random_body(rng, depth=0):
    """Elements in groups, all with fills of their own."""

    def number(scale=50):
        return f"{rng.uniform(-scale, scale):.3f}"

    def points(count):
        return " ".join(number() for _ in range(2 * count))

    def path():
        text = f"M{points(1)}"
        lower = "m"
        for _ in range(rng.randint(1, 6)):
            # svgelements goes on smoothly behind curves of another degree, too, which SVG does not
            command = rng.choice("lLhHvVcCqQaAmM" + {"c": "sS" * 3, "s": "sS", "q": "tT" * 3, "t": "tT"}.get(lower, ""))
            counts = {"l": 1, "c": 3, "s": 2, "q": 2, "t": 1, "m": 1}
            lower = command.lower()
            if lower in "hv":
                text += command + number()
            elif lower == "a":
                text += f"{command}{rng.uniform(1, 40):.2f} {rng.uniform(1, 40):.2f} {number(180)} "
                text += f"{rng.randint(0, 1)} {rng.randint(0, 1)} {points(1)}"
            else:
                text += command + points(counts[lower])
            if rng.random() < 0.15:
                text += "z"
        return f'<path d="{text}"/>'

    def transform():
        each = [
            f"rotate({number(180)})",
            f"rotate({number(180)}, {number()}, {number()})",
            f"translate({number()} {number()})",
            f"scale({rng.uniform(0.5, 2):.2f})",
            f"skewX({number(40)})",
            f"skewY({number(40)})",
            "matrix(1 .2 -.3 1 4 5)",
        ]
        return " ".join(rng.sample(each, rng.randint(1, 2)))

    made = []
    for _ in range(rng.randint(1, 3)):
        kind = rng.randint(0, 6)
        if kind == 0 and depth < 3:
            made.append(f'<g transform="{transform()}">{random_body(rng, depth + 1)}</g>')
        elif kind == 1:
            place = f'x="{number()}" y="{number()}"'
            made.append(f'<rect {place} width="{rng.uniform(1, 50)}" height="30" rx="{rng.randint(0, 9)}"/>')
        elif kind == 2:
            place = f'cx="{number()}" cy="{number()}"'
            made.append(f'<ellipse {place} rx="{rng.uniform(1, 30)}" ry="7" transform="{transform()}"/>')
        elif kind == 3:
            made.append(f'<polygon points="{points(4)}"/>')
        elif kind == 4:
            made.append(f'<use href="#a" x="{number()}" y="{number()}" transform="{transform()}"/>')
        else:
            made.append(path())
    return "".join(made)


@pytest.mark.parametrize("seed", few(range(60), 15))
def test_random_drawings_as_svgelements_has_them(seed):
    rng = random.Random(seed)
    body = '<defs><path id="a" d="M0 0C9 9 20 -9 30 5L3 9z"/></defs>' + random_body(rng)
    body = body.replace("/>", ' fill="none" stroke="red"/>')
    text = f'<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>'
    lines = to_shapely(read(text, flatten=0.001)[0])
    ours = shapely.union_all([line.exterior if line.geom_type == "Polygon" else line for line in lines])
    places = []
    for element in svgelements.SVG.parse(io.StringIO(text), reify=False).elements():
        if isinstance(element, svgelements.Shape):
            for segment in element.segments(transformed=False):
                if not isinstance(segment, svgelements.Move) and segment.length() > 0:
                    places += [tuple(segment.point(t) * element.transform) for t in np.linspace(0, 1, 9)]
    assert places
    apart = shapely.distance(shapely.points(places), ours)
    assert apart.max() < 0.001001


# ---- rules of fills ------------------------------------------------------------------------------
def winding(rings, place):
    """Sum of the angles that rings turn around a place."""
    total = 0.0
    for ring in rings:
        away = ring - place
        angle = np.arctan2(away[:, 1], away[:, 0])
        turn = np.diff(np.append(angle, angle[0]))
        total += ((turn + np.pi) % (2 * np.pi) - np.pi).sum()
    return round(total / (2 * np.pi))


@pytest.mark.parametrize("rule", ["nonzero", "evenodd"])
@pytest.mark.parametrize("seed", few(range(40), 3))
def test_rules_of_fills_by_windings(seed, rule):
    rng = np.random.default_rng(seed)
    rings = []
    for _ in range(rng.integers(1, 5)):
        if seed % 2:  # crossing
            rings.append(rng.uniform(0, 10, (rng.integers(3, 8), 2)))
        else:  # nested squares, some beside each other
            x, y, size = rng.integers(0, 3) * 10, 0, rng.integers(1, 5)
            ring = np.array([[x, y], [x + size, y], [x + size, y + size], [x, y + size]], dtype=float)
            ring += [5 - size / 2, 5 - size / 2]
            rings.append(ring[:: rng.choice([-1, 1])])
    filled = [shapely.Polygon(polygon[0], polygon[1:]) for polygon in filled_polygons(rings, rule)]
    places = rng.uniform(0, 25, (400, 2))
    edges = shapely.union_all([shapely.LinearRing(ring) for ring in rings])
    for place in places:
        point = shapely.Point(place)
        if edges.distance(point) < 1e-9:
            continue
        turns = winding(rings, place)
        wanted = turns % 2 == 1 if rule == "evenodd" else turns != 0
        if len(rings) == 1 and rule == "evenodd":  # one ring, by the rule of `PolygonSet`
            continue
        assert sum(polygon.contains(point) for polygon in map(shapely.make_valid, filled)) == wanted


def test_rings_that_do_not_cross_keep_their_vertices():
    shapes, _ = svg('<path fill-rule="evenodd" d="M0 0h9.1v9h-9.1z M3 3v3h3.3v-3z M4 4h.5v.5z M20 0h1v1z"/>')
    kinds = shapes.ring_kind.tolist()
    assert kinds == [0, 1, 0, 0]
    assert len(shapes) == 3
    assert shapes.feature.tolist() == [0, 0, 0]
    assert shapes.ring(1).tolist() == [[3, 3], [3, 6], [6.3, 6], [6.3, 3]]


# ---- units, styles, structure --------------------------------------------------------------------
@pytest.mark.parametrize(
    ("attributes", "scale", "unit"),
    [
        ("", 1, None),
        ('width="300" height="100"', 1, None),
        ('width="300px" height="100" viewBox="0 0 30 10"', 1, None),
        ('width="100%" viewBox="0 0 30 10"', 1, None),
        ('width="100mm" height="50mm" viewBox="0 0 200 100"', 0.5, "mm"),
        ('width="100mm" viewBox="0 0 200 100"', 0.5, "mm"),
        ('height="5cm" viewBox="0 0 200 100"', 0.5, "mm"),
        ('width="1in" height="1in" viewBox="0 0 254 254"', 0.1, "mm"),
        ('width="1in" height="1in"', 25.4 / 96, "mm"),
        ('width="72pt" height="6pc" viewBox="0 0 254 254"', 0.1, "mm"),
        ('width="100mm" height="100mm" viewBox="0 0 200 100" preserveAspectRatio="xMinYMin"', 0.5, "mm"),
    ],
)
def test_units(attributes, scale, unit):
    shapes, _ = svg('<rect width="10" height="20"/>', attributes)
    assert shapes.unit == unit
    assert shapes.y_axis != "up"
    assert shapes.xy.max(axis=0) == pytest.approx([10 * scale, 20 * scale])


@pytest.mark.parametrize(
    ("style", "expected"),
    [
        ('fill="none" stroke="red"', "line"),
        ('style="fill:none;stroke:#000"', "line"),
        ('class="b"', "line"),
        ('class="a b c"', "line"),
        ('id="i" fill="blue"', "line"),
        ('fill="none"', None),
        ('style="fill: none !important"', None),
        ("", "polygon"),
        ('style="fill:red;stroke:none"', "polygon"),
        ('fill="url(#gradient)"', "polygon"),
        ('style="display:none"', None),
        ('visibility="hidden"', None),
        ('opacity="0"', None),
        ('style="opacity:0.0"', None),
        ('opacity="0.01"', "polygon"),
        ('class="hidden"', None),
    ],
)
def test_styles(style, expected):
    sheet = "<style>/* a */ .b,#i{fill:none;stroke:red} .hidden{display:none} g rect:hover{fill:none}</style>"
    shapes, notes = svg(f'{sheet}<linearGradient id="gradient"/><path {style} d="M0 0L4 0 4 3"/>')
    found = None if not len(shapes) else "line" if shapes.is_line[0] else "polygon"
    assert found == expected
    assert any("style rule" in note and "g rect:hover" in note for note in notes)
    assert expected or any("skipped" in note and "style" not in note for note in notes)


def test_the_outermost_element_has_a_style_too():
    icon = '<path d="M0 0l4 4"/><circle r="3"/><path fill="red" d="M0 0h4v3z"/>'
    for own in ('fill="none" stroke="currentColor"', 'style="fill:none;stroke:red"', 'class="icon"'):
        shapes, _ = svg(f"<style>.icon{{fill:none;stroke:red}}</style>{icon}", own)
        assert shapes.is_line.tolist() == [True, False, False]
    assert len(svg(icon, 'display="none"')[0]) == 0
    assert svg('<path d="M0 0h4v3z"/>', 'transform="scale(2)"')[0].xy.max() == 8
    refused(InputError, "line 1", svg, icon, 'clip-path="url(#a)"')


def test_ids_and_uses():
    shapes, _ = svg(
        '<defs><g id="g"><rect id="r" width="1" height="1"/><rect width="2" height="2"/></g></defs>'
        '<symbol id="s" viewBox="0 0 2 2"><circle id="c" cx="1" cy="1" r="1"/></symbol>'
        '<use href="#g" id="u"/><use x:href="#g" x="5" xmlns:x="http://www.w3.org/1999/xlink"/>'
        '<use href="#s" x="10" width="20" height="20" id="v"/>'
        '<switch><rect requiredExtensions="x" width="9" height="9"/>'
        '<g><rect id="last" width="3" height="3"/></g></switch>'
    )
    assert list(shapes.ids) == ["u", "u", "r", None, "v", "last"]
    assert shapely.bounds(to_shapely(shapes)[4]).tolist() == pytest.approx([10, 0, 30, 20])


def test_layers_of_inkscape():
    name = 'xmlns:i="http://www.inkscape.org/namespaces/inkscape"'
    box = '<path d="M0 0h4v3z"/>'
    layers = f'<g i:groupmode="layer" i:label="Cut out">{box}<g>{box}</g></g>'
    layers += f'<g i:groupmode="layer" id="b">{box}</g>{box}'
    shapes, _ = svg(layers, name)
    assert shapes.properties == {"layer": ["Cut out", "Cut out", "b", None]}
    assert svg(layers, name, properties=False)[0].properties == {}
    assert svg(box)[0].properties == {}


def test_holes_of_stroked_paths():
    """Cutting machines follow strokes: a plate with holes is one path of closed parts, which nothing fills."""
    plate = "M0 0h100v60h-100z M20 20h10v10h-10z M22 22h6v6h-6z"
    shapes, notes = svg(f'<path d="{plate} M200 0h9v9" fill="none" stroke="red"/>')
    assert [geometry.area for geometry in to_shapely(shapes)] == [0, 6000 - 100, 36]
    assert (len(set(shapes.feature.tolist())), shapely.is_valid(to_shapely(shapes)).all()) == (1, True)
    assert notes == ["a.svg: 3 closed lines without a fill read as polygons"]
    crossing, _ = svg('<path d="M0 0h9v9h-9z M5 5h9v9h-9z" fill="none" stroke="red"/>')
    assert [geometry.area for geometry in to_shapely(crossing)] == [81, 81]


@pytest.mark.parametrize(
    ("ground", "page", "is_skipped"),
    [
        ('<rect width="100" height="80" fill="#ffffff"/>', 'width="100" height="80" viewBox="0 0 100 80"', True),
        ('<rect width="100%" height="100%"/>', 'viewBox="0 0 100 80"', True),
        ('<rect x="-5" y="3" width="100" height="80"/>', 'width="10mm" height="8mm" viewBox="-5 3 100 80"', True),
        ('<rect width="90mm" height="40mm"/>', 'width="90mm" height="40mm" viewBox="0 0 340.15748 151.181102"', True),
        ('<rect width="100%" height="100%" id="sheet"/>', 'viewBox="0 0 100 80"', False),
        ('<rect width="100%" height="100%" rx="9"/>', 'viewBox="0 0 100 80"', False),
        ('<rect width="100%" height="100%" stroke="red"/>', 'viewBox="0 0 100 80"', False),
        ('<rect width="100" height="79"/>', 'viewBox="0 0 100 80"', False),
        ('<g><rect width="100" height="80"/></g>', 'viewBox="0 0 100 80"', False),
    ],
)
def test_the_background_of_a_page_is_no_shape(ground, page, is_skipped):
    """A bare rectangle that fills the page, below the shapes: as pictures of this program have it."""
    body = '<path id="p" d="M10 10h4v3z"/>'
    shapes, notes = svg(ground + body, page)
    assert len(shapes) == (1 if is_skipped else 2)
    assert shapes.ids[-1] == "p"
    assert [note for note in notes if "background" in note] == (
        ["a.svg, line 1, rect: the background of the page is skipped; give it an id to keep it as a shape"] * is_skipped
    )
    assert len(svg(ground, page)[0]) == 1  # alone it is all there is
    assert len(svg(body + ground, page)[0]) == 2  # above others it is a shape


def test_the_background_of_a_picture_of_ours(tmp_path):
    square = skeleton_exact([[0, 0], [9, 0], [9, 9], [0, 9]])
    write(square, tmp_path / "p.svg", layers=["polygons"])
    shapes, notes = read((tmp_path / "p.svg").read_bytes())
    assert (len(shapes), len(notes)) == (1, 1)
    write(square, tmp_path / "p.svg", layers=["polygons"], background="none")
    assert read((tmp_path / "p.svg").read_bytes()) == (shapes, [])
