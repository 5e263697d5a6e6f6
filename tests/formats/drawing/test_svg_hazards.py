"""Drawings in SVG that are small, and would take long or much memory: none does."""

import pytest

from support.processes.peak_memory import memory_below
from support.readers.svg_reading import read, svg
from support.refusals import refused
from vorotool.errors import InputError, LimitError

RECT = '<rect class="a" width="4" height="3"/>'
MANY = 60_000


@pytest.mark.parametrize("style", ["/*", "/* a */", "a", "a{", "a,{}", "}", ".a{fill:red}", ".a{fill:url("])
def test_styles_take_no_longer(style):
    assert len(svg(f"<style>{style * MANY}/*</style>{RECT}")[0]) == 1


def test_many_rules_and_many_elements():
    rules = "".join(f".a{{stroke:none}}.b{k}{{fill:none}}" for k in range(4000))
    body = '<rect class="a" width="1" height="1"/><rect class="b7" width="1" height="1"/>' * 2000
    drawing, notes = svg(f"<style>{rules}</style>{body}")
    assert len(drawing) == 2000
    assert any("2000" in note for note in notes)


@pytest.mark.parametrize(
    ("style", "is_shown"),
    [
        (".a{display:none}", False),
        (".a{display:none} .a{display:inline}", True),
        ("rect.a{display:none} .a{display:inline}", False),
        ("#r{display:none} rect.a{display:inline}", False),
        ("*{fill:none} rect{fill:red}", True),
        ("@media print {.a{display:none}}", False),
        ("/* .a{display:none} ", True),
        ("/**/.a/* b */{display:none}", False),
        (".a{display:none", True),
        ("{display:none}.b,.a{display:none}", False),
    ],
)
def test_the_rule_that_counts(style, is_shown):
    drawing, _ = svg(f'<style>{style}</style><rect id="r" class="b a" width="4" height="3"/>')
    assert len(drawing) == is_shown


def test_declared_attributes_are_not_given_to_elements():
    declared = f'<!DOCTYPE svg [<!ATTLIST g a CDATA "{"y" * 100_000}"><!ATTLIST rect height CDATA "3">]>'
    text = f'{declared}<svg>{"<g/>" * 1000}<rect width="4"/></svg>'
    with memory_below(2**24):
        assert len(read(text)[0]) == 0


@pytest.mark.parametrize("prefix", ["xmlns", "xmlns:p"])
def test_long_namespaces_are_refused(prefix):
    refused(InputError, r"line 2.*'uuuuuu", read, f'<svg>\n<g {prefix}="{"u" * 1000}"/></svg>')


def tens_of_tens(inner):
    """Definitions in which each of four groups uses the one before ten times."""
    groups = "".join(f"<g id='a{k + 1}'>" + f"<use href='#a{k}'/>" * 10 + "</g>" for k in range(4))
    return f"<defs>{inner}{groups}</defs>"


def test_long_paths_are_not_repeated_without_end():
    defined = tens_of_tens(f"<path id='a0' d='M0 0{'l1 1' * 2000}V0z'/>")
    refused(LimitError, r"path #a0.*split the drawing", svg, f"{defined}<use href='#a4'/>")
    assert len(svg(f"{defined}<use href='#a1'/>")[0]) == 10


def test_shapes_are_counted_before_their_vertices():
    refused(LimitError, "1000", svg, tens_of_tens(f"<g id='a0'>{RECT}</g>") + "<use href='#a4'/>", max_sites=1000)


@pytest.mark.parametrize("rule", ["nonzero", "evenodd"])
@pytest.mark.parametrize("far", [10**12, 18446744073709551615])
def test_faces_that_rounding_moves_over_one_another(far, rule):
    path = f'd="M1 2L9 2q3 4 0 {far}zm1 1c1 2 3 4 5 6s1 2 0-3A4 3 20 1 0 2 2Z" transform="rotate(20 3 4)"'
    drawing, _ = svg(f'<path fill-rule="{rule}" {path}/>', 'width="90mm" height="5cm" viewBox="0 0 30 20"')
    assert len(drawing) > 0


THIN = [
    [
        "M-10000000000000004-3000000000000001L19999999999999996 5999999999999999L9999999999999996 2999999999999998.5"
        "L-20000000000000004-6000000000000001z M-3-3L-1 0L0-1L1-2L0-1z",
        "nonzero",
    ],
    ["M-2e-16 3e-16L3e-16 0L1e-16 2e-16z M0 1e-17L-3-.8999999999999999L-1-.3L-2-.6L3 .8999999999999999z", "evenodd"],
    ["M0 0L5 5L2 2z", "nonzero"],
    ["M0 0h5h-3z M1 1h3h-2z", "evenodd"],
]


@pytest.mark.parametrize(("path", "rule"), THIN)
def test_fills_without_area_are_left_out(path, rule):
    drawing, notes = svg(f'<path fill-rule="{rule}" d="{path}"/>{RECT}')
    assert drawing.xy.tolist() == [[0, 0], [4, 0], [4, 3], [0, 3]]
    assert any("1 filled shape" in note for note in notes)


def test_crossings_that_rounding_makes_anew():
    path = "M-1-.3L-3-.8999999999999999L3 .8999999999999999L-1-.3z"
    path += "M1e16 0L-3e16 2e16L3e16-3e16L-1e16-1e16L1e16 1e16z"
    assert len(svg(f'<path d="{path}"/>')[0]) > 0
