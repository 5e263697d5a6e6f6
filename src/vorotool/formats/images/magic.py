"""How images begin, as far as more than fixed bytes tell."""

from __future__ import annotations

import re

PICTURES = {"jpeg": "JPEG", "bmp": "BMP", "gif": "GIF", "webp": "WebP", "avif": "AVIF"}
"""Formats and what they are called."""
_BMP_HEADERS = (12, 16, 40, 52, 56, 64, 108, 124)

GAP = rb"(?:\s|#[^\n\r]*[\n\r])+"
"""Between the numbers of a header of PBM, PGM or PPM: space and comments."""
_START = re.compile(rb"P([1-6])" + GAP + rb"(?=[0-9])")


def picture_format(data: bytes) -> str | None:
    """Which of `PICTURES` data begins as."""
    if data.startswith(b"\xff\xd8\xff"):
        return "jpeg"
    if data.startswith((b"GIF87a", b"GIF89a")):
        return "gif"
    if data.startswith(b"RIFF") and data[8:12] == b"WEBP":
        return "webp"
    if data[4:12] in (b"ftypavif", b"ftypavis"):
        return "avif"
    if data.startswith(b"BM") and int.from_bytes(data[14:18], "little") in _BMP_HEADERS:
        return "bmp"
    return None


def looks_like_pnm(data: bytes) -> bool:
    """Tell whether data begins as a PBM, PGM or PPM file: P1 to P6, space or comments, a number."""
    return _START.match(data[:65_536]) is not None
