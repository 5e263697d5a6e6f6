"""What files begin with: one ordered list tells the format of an input, of those that are not read, too."""

from __future__ import annotations

import re
from typing import NamedTuple

from vorotool.formats.io.sources import NPY, NPZ

TIFF_MAGIC = (b"II*\x00", b"MM\x00*", b"II+\x00", b"MM\x00+")
RECORD_MARK = b"\x1e"
"""What each text of a GeoJSON text sequence begins with; it may then have several lines."""
BINARY_DXF = b"AutoCAD Binary DXF\r\n\x1a\0"
UTF8_MARK = b"\xef\xbb\xbf"

PICTURES = {"jpeg": "JPEG", "bmp": "BMP", "gif": "GIF", "webp": "WebP", "avif": "AVIF"}
"""Formats and what they are called."""

GAP = rb"(?:\s|#[^\n\r]*[\n\r])+"
"""Between the numbers of a header of PBM, PGM or PPM: space and comments."""
_HEAD = 4096
"""Bytes that tell the format."""


class Sign(NamedTuple):
    """What files of a format begin with."""

    format: str  # of those that are not read the extension, with its dot
    head: bytes = b""  # these bytes, if any
    at: int = 0  # at this place
    pattern: bytes = b""  # and what matches this


_SVG = rb"(?s)(<\?xml[^>]*>|<!--.*?-->|<!DOCTYPE[^>\[]*(\[.*?\]\s*)?>|\s++)*+<([\w-]+:)?svg[\s>]"
_DXF = rb"(999[ \t]*\r?\n[^\n]*\n\s*)*0[ \t]*\r?\n[ \t]*SECTION[ \t]*\r?\n"
_MARKUP = rb"(?:<[?!][^>]*>\s*)*<%b[\s>]"
_WKT = (
    rb"(?i)(SRID\s*=\s*\d+\s*;\s*)?((MULTI)?(POINT|LINESTRING|POLYGON|CURVE|SURFACE)|GEOMETRYCOLLECTION|LINEARRING|"
    rb"CIRCULARSTRING|COMPOUNDCURVE|CURVEPOLYGON|POLYHEDRALSURFACE|TIN|TRIANGLE)\s*(Z|M|ZM)?\s*(\(|EMPTY)"
)
_IMAGES = (
    Sign("png", b"\x89PNG"),
    *(Sign("tiff", head) for head in TIFF_MAGIC),
    Sign("npy", NPY),
    Sign("pnm", b"P", pattern=rb"P([1-6])" + GAP + rb"(?=[0-9])"),
    Sign("jpeg", b"\xff\xd8\xff"),
    *(Sign("gif", b"GIF87a"), Sign("gif", b"GIF89a")),
    Sign("webp", b"WEBP", 8, b"RIFF"),
    *(Sign("avif", b"ftypavif", 4), Sign("avif", b"ftypavis", 4)),
    # the size of its header
    Sign("bmp", b"BM", pattern=rb"(?s:BM.{12})[\x0c\x10\x28\x34\x38\x40\x6c\x7c](\0{3}|\0{0,2}\Z)"),
)
_OTHERS = (
    Sign("dxf", BINARY_DXF),
    Sign("svg", b"<", pattern=_SVG),
    *(Sign("dxf", head, pattern=_DXF) for head in (b"0", b"999")),
    *(Sign(".pdf", b"%PDF-"), Sign(".ps", b"%!PS"), Sign(".eps", b"\xc5\xd0\xd3\xc6"), Sign(".otf", b"OTTO\0")),
    *(Sign(".ttf", b"\0\1\0\0\0"), Sign(".woff", b"wOFF"), Sign(".woff2", b"wOF2"), Sign(".ttc", b"ttcf")),
    Sign(".dwg", b"AC10", pattern=rb"AC10\d\d\0"),
    *(Sign("npy", NPY), Sign("npz", NPZ), Sign("gpkg", b"SQLite format 3\0"), Sign("fgb", b"fgb\x03fgb")),
    *(Sign("shp", b"\0\0\x27\x0a"), Sign("parquet", b"PAR1"), Sign("las", b"LASF")),
    *(Sign("ply", b"ply\n"), Sign("ply", b"ply\r")),
    *(Sign("geojson", b"{"), Sign("json", b"["), Sign("jsonl", RECORD_MARK)),
    *(Sign(name, b"<", pattern=_MARKUP % name.encode()) for name in ("kml", "gpx")),
    *(Sign("wkt", bytes([letter]), pattern=_WKT) for letter in b"SMPLGCTsmplgct"),
)


def image_of(data: bytes) -> str | None:
    """Tell the format of an image by what it begins with; None if it is no image."""
    return _found(_IMAGES, data, data[:65_536])


def format_of(data: bytes) -> str | None:
    """Tell the format of what is no image, byte order mark and blanks left out; None of rows of text, if it is any."""
    head = data[:_HEAD].removeprefix(UTF8_MARK).lstrip()
    return _found(_OTHERS, head, head)


def _found(signs: tuple[Sign, ...], data: bytes, start: bytes) -> str | None:
    is_so = (sign for sign in signs if data.startswith(sign.head, sign.at))
    return next((sign.format for sign in is_so if re.match(sign.pattern, start)), None)
