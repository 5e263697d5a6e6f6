"""Skeletons as GraphML: names and texts of every kind."""

import io
import xml.etree.ElementTree as ET
from dataclasses import replace

import vorotool
from vorotool.formats.results.graphml import write_graphml
from vorotool.numeric.coordinates import writing

SPACE = "{http://graphml.graphdrawing.org/xmlns}"
CONTROLS = [*map(chr, range(0x20)), *"\x7f\x85\ud800\udfff\ufffe\uffff\U0001f600", "]]>", "&<>\"'"]


def written(name, value):
    skeleton = vorotool.skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])
    polygons = replace(skeleton.polygons, properties={name: [value]})
    out = io.BytesIO()
    with writing(columns=[name]):
        write_graphml(out, replace(skeleton, polygons=polygons))
    return ET.fromstring(out.getvalue().decode())


def test_every_character_gives_xml_that_says_it_or_its_replacement():
    for text in CONTROLS:
        root = written(f"n{text}n", f"v{text}v")
        kept = text if text.isprintable() or text in "\t\n\r\x7f\x85" else "\ufffd"
        key = next(each for each in root.iter(f"{SPACE}key") if each.get("attr.name") == f"n{kept}n")
        values = {each.text for each in root.iter(f"{SPACE}data") if each.get("key") == key.get("id")}
        assert values == {f"v{kept}v"}, ascii(text)
