"""Regular expressions that read what users type and write take no more than linear time: none backtracks at length."""

import re
from importlib import import_module

import pytest

DIGITS = "9" * 300_000
"""Quadratic time would be minutes."""
PATTERNS = {
    "cli.values.lengths:_AREA": f"{DIGITS}!",
    "cli.values.lengths:_LIKE_AREA": f"-{DIGITS}!",
    "cli.values.lengths:_WITH_UNIT": f"{DIGITS}!",
    "formats.points.columns:_NUMBER": f"{DIGITS}!",
    "formats.points.columns:DECIMAL_COMMA": f"{DIGITS},{DIGITS}!",
    "formats.text.tables:_NUMBER": f"{DIGITS}!",
    "batch.inputs:_NUMBER": f"{DIGITS}!",
    "batch.records:_RECORD": DIGITS,
    "formats.recognition:_SVG": "\n" * 300_000,
    "formats.drawing.svg_shapes:_LENGTH": f"{DIGITS}!",
    "formats.drawing.svg_shapes:_NUMBERS": f"{DIGITS}!",
}


@pytest.mark.parametrize(("name", "text"), PATTERNS.items(), ids=PATTERNS)
def test_long_texts_that_do_not_match(name, text):
    module, pattern = name.split(":")
    found = getattr(import_module(f"vorotool.{module}"), pattern)
    source = found.pattern if isinstance(found, re.Pattern) else found
    assert re.fullmatch(found, text if isinstance(source, str) else text.encode()) is None
