"""Drawings in SVG that are refused, and the way of those that are read through the front door."""

import gzip

import pytest

import vorotool
from support.processes.ended import ended_python
from support.readers.svg_reading import read, svg
from support.refusals import refused
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.formats.drawing import svg_document

# ---- what is refused -----------------------------------------------------------------------------
REFUSED = [
    ('<g clip-path="url(#c)"><rect width="1" height="1"/></g>', "g is clipped.*Path > Intersection"),
    ('<rect width="1" height="1" style="mask:url(#m)"/>', "has a mask"),
    ('<pattern id="p"/><rect fill="url(#p)" width="1" height="1"/>', r"painted with a pattern \(#p\).*flat fill"),
    ('<use href="other.svg#a"/>', "'other.svg#a'"),
    ('<use href="http://example.org/a"/>', "never loaded"),
    ('<use href="#none"/>', "#none"),
    ('<use id="u" href="#u"/>', "use #u is used within itself"),
    ('<g id="g"><g><use href="#g"/></g></g>', "g #g is used within itself"),
    ('<g id="g"><use href="#h"/></g><g id="h"><use href="#g"/></g>', "is used within itself"),
    ('<path id="p" d="M0 0L1 1 Q2"/>', r"path #p: the path data are damaged near character 12 "),
    ('<path d="M0 0L1 x"/>', r"damaged near character \d+ .*correct or remove it"),
    ('<path d="L1 1"/>', "damaged"),
    ('<path d="M0 0 A1 1"/>', "damaged"),
    ('<path d="M0 0 h"/>', "damaged"),
    ('<path d="M0 0 L1e999 0"/>', "too large for a double"),
    ('<rect width="1e300" height="1" transform="scale(1e300)"/>', "too large for a double"),
    ('<rect width="-1" height="1"/>', "width is -1; write 0 or more"),
    ('<rect width="1em" height="1"/>', "'1em'"),
    ('<circle r="x"/>', "r is 'x'"),
    ('<polygon points="1 2 3"/>', "points has 3 numbers"),
    ('<polygon points="1 2 a"/>', "'1 2 a'"),
    ('<g transform="rotate(1 2 3"><rect width="1" height="1"/></g>', "transform is 'rotate"),
    ('<g transform="rotate(1e999)"/>', "transform is 'rotate.*too large for a double"),
    ('<g transform="matrix(1 2 3)"/>', "transform is 'matrix"),
    ('<g style="transform-origin:1px 2px"/>', "transform-origin"),
    ('<svg viewBox="0 0 1"/>', "viewBox"),
]  # fmt: skip


@pytest.mark.parametrize(("body", "message"), REFUSED)
def test_what_is_refused(body, message):
    refused(InputError, f"line 1, .*{message}", svg, body)


@pytest.mark.parametrize("tag", ["text", "image", "foreignObject"])
def test_what_is_no_shape_is_skipped_with_a_note(tag):
    shapes, notes = svg(f'<{tag}/><rect width="1" height="1"/>\n<g><{tag}/></g>')
    assert len(shapes) == 1
    assert [f"a.svg: 2 {tag}s skipped, the first in line 1" in note for note in notes] == [True]
    for wrapped in (f"<defs><{tag}/></defs>", f'<g display="none"><{tag}/></g>'):
        assert not any(tag in note for note in svg(wrapped)[1])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<svg", "line 1"),
        ("", "well-formed"),
        ("<html/>", "is not an SVG file: it begins with <html>"),
        ('<!DOCTYPE svg [<!ENTITY a "b">]><svg>&a;</svg>', r"declares an entity \(a\), and entities are not expanded"),
        ('<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]><svg>&a;</svg>', "entities are not expanded"),
        ('<?xml version="1.0" encoding="none"?><svg/>', "a.svg"),
        ("<svg>" * 300 + "</svg>" * 300, "nested more than 200 deep; ungroup"),
        ('<svg viewBox="0 0 0 4" width="4mm"/>', "viewBox"),
        ('<svg viewBox="0 0 4 4" width="0mm"/>', "the drawing is 0 mm by 0 mm"),
        (b"\x1f\x8bxx", "the compressed drawing is damaged"),
        (gzip.compress(b"<svg/>", mtime=0)[:-9], "the compressed drawing is damaged"),
    ],
)
def test_damaged_files(text, message):
    refused(InputError, message, read, text)


def test_a_doctype_without_entities_is_read():
    old = '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">'
    assert len(read(f'<?xml version="1.0"?>{old}<svg><rect width="1" height="1"/></svg>')[0]) == 1


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_encodings(encoding):
    name = encoding.removesuffix("-sig")
    text = f'<?xml version="1.0" encoding="{name}"?><svg><rect id="é" width="1" height="1"/></svg>'
    assert read(text.encode(encoding))[0].ids == ["é"]


def test_long_chains_of_uses_are_refused():
    chain = [f'<g id="g{k + 1}"><use href="#g{k}"/></g>' for k in range(5000)]
    for body in ('<g id="g0"/>' + "".join(chain), "".join(chain[::-1]) + '<g id="g0"/>'):
        refused(InputError, "nested more than 250 deep by what they use", svg, body)


def test_a_bomb_is_not_unpacked():
    bomb = gzip.compress(b"<svg>" + b" " * 2**28, 1)
    assert len(bomb) < 2**21
    refused(LimitError, "unpacks to more than 134217728 bytes: split the drawing", read, bomb)


def test_many_elements_are_refused(monkeypatch):
    monkeypatch.setattr(svg_document, "MOST_ELEMENTS", 100)
    refused(LimitError, "100", svg, "<g/>" * 100)
    monkeypatch.setattr(svg_document, "MOST_REPEATED", 10)
    assert len(svg('<rect width="1" height="1"/>' * 12)[0]) == 12  # which are in the file
    with pytest.raises(LimitError, match="more than 14 elements are drawn"):
        svg('<g id="a">' + "<g/>" * 6 + "</g>" + '<use href="#a"/>' * 6)


def test_vertices_are_counted():
    refused(LimitError, "vertices, more than the limit of 10", svg, '<circle r="1"/>', max_sites=10)


@pytest.mark.parametrize("text", ["1", "1.5", "1.2 ", "(", " ", "1e", ",", "-"])
def test_hostile_attributes_take_no_longer(text):
    text *= 50000
    for body in (
        f'<g transform="translate({text}x)"/>',
        f'<polygon points="{text}x"/>',
        f'<path d="M0 0L{text}x"/>',
        f'<rect width="{text}x" height="1"/>',
        f'<svg viewBox="{text}x"/>',
    ):
        refused(InputError, "", svg, body)


# ---- through the front door ----------------------------------------------------------------------
LOGO = '<svg xmlns="http://www.w3.org/2000/svg" width="20mm" viewBox="0 0 40 40"><path d="M0 0h40v20h-40z"/></svg>'


@pytest.mark.parametrize("name", ["a.svg", "a.svgz", "a", "b"])
@pytest.mark.parametrize("geometry", [None, "polygons"])
def test_files_and_contents(tmp_path, name, geometry):
    path = tmp_path / name
    path.write_bytes(gzip.compress(LOGO.encode()) if name in ("a.svgz", "b") else LOGO.encode())
    shapes = vorotool.read(path, geometry=geometry)
    assert shapes.xy.tolist() == [[0, 0], [20, 0], [20, 10], [0, 10]]
    assert shapes.unit == "mm"
    assert len(vorotool.read(path, input_format="svg", flatten=0.5)) == 1
    refused(InputError, r"is a drawing .*, but points or an image", vorotool.read, path, geometry="points")
    refused(UsageError, "the tolerance is 0", vorotool.read, path, flatten=0)


def test_nothing_is_loaded_or_fetched(tmp_path):
    """No module that opens files or connections is asked by a drawing that names some."""
    hostile = (
        '<?xml-stylesheet href="http://localhost:9/a.css"?><!DOCTYPE svg SYSTEM "http://localhost:9/a.dtd">'
        '<svg xmlns="http://www.w3.org/2000/svg"><style>@import url(http://localhost:9/b.css);</style>'
        '<script href="http://localhost:9/c.js"/><rect width="1" height="1"/></svg>'
    )
    (tmp_path / "a.svg").write_text(hostile)
    script = (
        "import sys, vorotool\nevents = []\nvalue = vorotool.read('a.svg')\n"
        "names = 'open', 'socket.connect'\n"
        "sys.addaudithook(lambda name, args: events.append((name, args)) if name in names else None)\n"
        "vorotool.read('a.svg')\nprint([args[0] for name, args in events], len(value))"
    )
    assert ended_python("-c", script, cwd=tmp_path, check=True).stdout == "['a.svg'] 1\n"
