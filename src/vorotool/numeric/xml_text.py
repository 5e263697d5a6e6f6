"""Text in SVG, GraphML and HTML that every parser takes, whatever the names of the input hold."""

from __future__ import annotations

import re

_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
"""Characters that XML 1.0 has no place for, not even by number (section 2.2, production 2)."""

REPLACEMENT = "\ufffd"
"""Stands for each of them: the replacement character of Unicode."""


def xml_characters(text: str) -> str:
    """Replace each character that XML cannot hold by U+FFFD; what has a meaning in XML is still to be escaped."""
    return _FORBIDDEN.sub(REPLACEMENT, text)
