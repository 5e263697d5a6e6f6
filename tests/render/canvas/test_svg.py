"""Text in SVG: of every kind."""

import io
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from vorotool.render.canvas.layers import Page, Texts
from vorotool.render.canvas.svg import write_layers_svg

CONTROLS = [*map(chr, range(0x20)), "\ud800", "\udfff", "\ufffe", "\uffff", "]]>", "&<>\"'"]


@pytest.mark.parametrize("text", CONTROLS, ids=lambda text: "-".join(f"{ord(each):04x}" for each in text))
def test_every_character_gives_xml(text):
    page = Page((0, 0, 9, 9), width=100, y_up=False)
    out = io.BytesIO()
    write_layers_svg(out, [Texts("labels", np.array([[1.0, 1.0]]), [f"v{text}v"])], page)
    root = ET.fromstring(out.getvalue().decode())
    (found,) = [each.text for each in root.iter("{http://www.w3.org/2000/svg}text")]
    kept = text if text.isprintable() or text in "\t\n\r" else "\ufffd"
    assert found == f"v{kept}v".replace("\r", "\n")
