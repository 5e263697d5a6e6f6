"""Which sources are drawings, and of which format."""

from __future__ import annotations

import re
import zlib

from vorotool.errors import OTSU, InputError, option
from vorotool.formats.io.sources import Source

_TAKERS = option("skeleton-exact, skeleton-approx or draw", "skeleton_exact or skeleton_approx")

SUFFIXES = {".svg": "svg", ".svgz": "svg", ".dxf": "dxf"}
_HEAD = 4096
_SVG = re.compile(
    rb"(\xef\xbb\xbf)?(<\?xml[^>]*>|<!--.*?-->|<!DOCTYPE[^>\[]*(\[.*?\]\s*)?>|\s++)*+<([\w-]+:)?svg[\s>]", re.DOTALL
)
_DXF = re.compile(rb"(\xef\xbb\xbf)?\s*(999[ \t]*\r?\n[^\n]*\n\s*)*0[ \t]*\r?\n[ \t]*SECTION[ \t]*\r?\n")
BINARY_DXF = b"AutoCAD Binary DXF\r\n\x1a\0"


def drawing_format(source: Source) -> str | None:
    """Tell the format of a drawing by the extension, else by the content; None if it is none."""
    by_suffix = SUFFIXES.get(source.suffix)
    if by_suffix is not None and source.data.strip():
        return by_suffix
    head = source.data[:_HEAD]
    if head.startswith(b"\x1f\x8b"):
        head = _unpacked_head(head)
    if _SVG.match(head):
        return "svg"
    return "dxf" if head.startswith(BINARY_DXF) or _DXF.match(head) else None


def _unpacked_head(head: bytes) -> bytes:
    try:
        return zlib.decompressobj(16 + zlib.MAX_WBITS).decompress(head, _HEAD)
    except zlib.error:
        return b""


def refuse_drawing(source: Source) -> None:
    """Refuse a drawing where points are due."""
    if drawing_format(source) is not None:
        raise InputError(
            f"{source.name} is a drawing (polygons and lines), but points or an image are expected: use {_TAKERS}, or "
            f"convert the drawing to an image and use {OTSU}"
        )
