"""The format of points, polygons, lines and drawings, which of them a source holds, and its text."""

from __future__ import annotations

import re
import zlib
from dataclasses import replace

from vorotool.convert.tables import coordinate_columns
from vorotool.errors import INPUT_FORMAT, OTSU, InputError, UsageError, option
from vorotool.formats.io.arrays import MAGIC, NPZ_MAGIC, npz_holds
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.json import RECORD_MARK, holds_shapes, is_json_lines, parse_json
from vorotool.formats.points.delimited import geometry_column, header_fields
from vorotool.products.formats import resolved
from vorotool.products.inputs import INPUTS, Holds

_ALPHA = option("alphashape", "alpha_shape")

_SUFFIXES = {f".{name}": each.name for each in INPUTS.values() for name in each.names if name not in ("json", "txt")}
"""Extensions that tell the format; JSON is of one of several kinds, and text of any."""
_OF_ROWS = frozenset({"", ".csv", ".tsv", ".txt", ".wkt"})
"""Extensions of texts that need nothing but rows; other formats are damaged without a document or a header."""
_WKT = (
    rb"(?i)\s*(SRID\s*=\s*\d+\s*;\s*)?((MULTI)?(POINT|LINESTRING|POLYGON|CURVE|SURFACE)|GEOMETRYCOLLECTION|LINEARRING|"
    rb"CIRCULARSTRING|COMPOUNDCURVE|CURVEPOLYGON|POLYHEDRALSURFACE|TIN|TRIANGLE)\s*(Z|M|ZM)?\s*(\(|EMPTY)"
)
_UTF8_MARK = b"\xef\xbb\xbf"
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_WITH_COLUMNS = ("csv", "json", "jsonl", "npz", "parquet", "gpkg", "ply", "xyz", "las")
_HEADS = (
    *((MAGIC, "npy"), (NPZ_MAGIC, "npz"), (b"SQLite format 3\0", "gpkg"), (b"fgb\x03fgb", "fgb")),
    *((b"\0\0\x27\x0a", "shp"), (b"PAR1", "parquet"), (b"{", "geojson"), (b"[", "json"), (RECORD_MARK, "jsonl")),
    *((b"ply\n", "ply"), (b"ply\r", "ply"), (b"LASF", "las")),
)
_MARKUP = rb"<(kml|gpx)[\s>]"


def recognized_geometry(
    source: Source, geometry: str | None, said: str | None, columns: str | None
) -> tuple[Holds, Source]:
    """Tell what a source holds that is no image, and give it with its format."""
    if geometry == "points" or (geometry in (None, "sites") and columns is not None):
        return "points", _points(source, _by_header(source, said or point_format(source), columns), columns)
    if geometry == "sites":
        return _sites(*_either(source, said))
    if geometry == "polygons":
        holds: Holds = "polygons"
        source = _with_format(source, said or polygon_format(source))
    else:
        holds, source = _either(source, said)
    if holds == "polygons" and columns is not None:
        raise UsageError(f"{option('--columns')} applies to lists of points: leave it out for polygons")
    return holds, source


def point_format(source: Source) -> str:
    """Tell the format of points, if it is one, by the extension, else by the content."""
    if source.suffix == ".zip" and resolved("formats.gis.vector_files:holds_shapefile")(source.data):
        return "shp"
    refuse_drawing(source)
    refuse_convertible(source)
    found = _SUFFIXES.get(source.suffix)
    return found if found is not None and "points" in INPUTS[found].readers else _by_content(source.data)


def _by_header(source: Source, chosen: str, columns: str | None = None) -> str:
    """Take points from a column of well-known text where the header names such a one, and no coordinates."""
    if chosen != "csv" or columns is not None:
        return chosen
    fields = header_fields(text_source(source, chosen).data)
    return "csv-wkt" if geometry_column(fields) is not None and coordinate_columns(fields) is None else chosen


def _by_content(data: bytes) -> str:
    head = data[:4096].removeprefix(_UTF8_MARK).lstrip()
    found = next((name for start, name in _HEADS if head.startswith(start)), None)
    if found == "npz" and resolved("formats.gis.vector_files:holds_shapefile")(data):
        return "shp"
    if found is not None:
        return found
    markup = re.search(_MARKUP, head) if head.startswith(b"<") else None
    if markup is not None:
        return markup[1].decode()
    return "wkt" if re.match(_WKT, head) else "csv"


def has_no_rows(source: Source) -> bool:
    """Return whether a text of rows (CSV, WKT, or without an extension) has none, not even a header."""
    return source.suffix in _OF_ROWS and not source.data.strip()


def polygon_format(source: Source) -> str:
    """Tell the format of polygons by the extension, else by the content."""
    if source.suffix in (".poly", ".json"):
        return source.suffix.removeprefix(".")
    drawn = drawing_format(source)
    if drawn is not None:
        return drawn
    found = point_format(source)
    if found == "geojson" and source.suffix != ".geojson":  # an object: of either kind
        return "json"
    if has_no_rows(source):
        return "wkt"
    if not source.data.strip() and found == "csv":
        raise InputError(
            f"{source.name} is empty, but polygons, lines or an image are expected; check the program that wrote it"
        )
    is_table = found == "csv" and geometry_column(header_fields(text_source(source, found).data)) is None
    if "polygons" in INPUTS[found].readers and not is_table:
        return found
    raise InputError(
        f"{source.name} holds no polygons or lines in a supported format (it looks like {found}): use JSON, GeoJSON, "
        f"WKT, .poly, SVG or DXF, or name the format with {INPUT_FORMAT}; for polygons around points use {_ALPHA}"
    )


def _either(source: Source, said: str | None) -> tuple[Holds, Source]:
    """Tell whether what is no image holds polygons or lines; JSON is parsed for it."""
    if said == "poly" or (said is None and source.suffix == ".poly"):
        return "polygons", text_source(source, "poly")
    chosen = _by_header(source, said or drawing_format(source) or point_format(source))
    if chosen == "csv" or "polygons" not in INPUTS[chosen].readers:
        return "points", _points(source, chosen, None)
    source = _with_format(source, chosen)
    if INPUTS[chosen].features and chosen != "wkt":
        source = replace(source, document=resolved("formats.gis.feature_table:features_of")(source))
        return ("polygons" if source.document.holds_shapes else "points"), source
    if chosen == "npz":
        return npz_holds(source.data), source
    if "curves" in INPUTS[chosen].has or chosen == "wkt":
        has_shapes = chosen != "wkt" or resolved("formats.gis.feature_table:names_shapes")(source.data)
        return ("polygons" if has_shapes else "points"), source
    return _in_json(source, said)


def _sites(holds: Holds, source: Source) -> tuple[Holds, Source]:
    """Take features for sites, whatever they are of; lists and tables of points stay points."""
    if source.document is not None and INPUTS[source.format].features:
        return ("points" if source.document.is_table else "sites"), source
    is_object = isinstance(source.document, dict) or source.format == "wkt"
    return ("sites" if is_object or holds != "points" else "points"), source


def _in_json(source: Source, said: str | None) -> tuple[Holds, Source]:
    """Tell whether JSON holds polygons or lines."""
    if _is_flat(source.data):
        return "points", source
    document = parse_json(source)
    if isinstance(document, list):
        is_table = resolved("formats.points.tables:is_table")(document)
        has_shapes = not is_table and resolved("formats.polygons.json:is_list_of_shells")(document)
    else:
        has_shapes = isinstance(document, dict) and ("polygons" in document or holds_shapes(document))
    source = replace(source, document=document)
    if not has_shapes:
        return "points", source
    # an object without an extension may be of either kind: our own JSON, or GeoJSON
    is_told = said or source.suffix == ".geojson" or source.format == "jsonl"
    return "polygons", source if is_told else replace(source, format="json")


def _is_flat(data: bytes) -> bool:
    """Whether JSON is at most a list of lists: points by the million are not parsed to tell that they are points."""
    return b"{" not in data and not data.lstrip().removeprefix(b"[").lstrip().removeprefix(b"[").lstrip().startswith(
        b"["
    )


def _points(source: Source, chosen: str, columns: str | None) -> Source:
    source = _with_format(source, chosen)
    if columns is not None and source.format not in _WITH_COLUMNS:
        raise UsageError(
            f"{option('--columns')} applies to delimited text, but {source.name} is read as {chosen}: leave it out"
        )
    return source


def _with_format(source: Source, chosen: str) -> Source:
    """Give a source with its format; of text, as `text_source` does."""
    return replace(source, format=chosen) if "bytes" in INPUTS[chosen].has else text_source(source, chosen)


def text_source(source: Source, chosen: str) -> Source:
    """Take the byte order mark off, and refuse what is no text in an encoding that is read; tell JSON from lines."""
    if source.data.startswith(_UTF16_MARKS):
        raise InputError(f"{source.name} is UTF-16 text; save it as UTF-8 (iconv -f UTF-16 -t UTF-8)")
    if source.data.startswith(NPZ_MAGIC):
        raise InputError(
            f"{source.name} is an NPZ or ZIP archive: for NPZ leave out {INPUT_FORMAT}, or name the file .npz; unpack "
            "a ZIP archive"
        )
    if b"\0" in source.data[:4096]:
        raise InputError(
            f"{source.name} is binary, not points or polygons; use CSV, .node, NPY, .poly, GeoJSON, WKT or JSON, or "
            f"name the format with {INPUT_FORMAT}"
        )
    data = source.data.removeprefix(_UTF8_MARK)
    is_lines = chosen in ("json", "geojson") and is_json_lines(data)
    return replace(source, data=data, format="jsonl" if is_lines else chosen)


# ---- drawings ------------------------------------------------------------------------------------
_TAKERS = option("skeleton-exact, skeleton-approx or draw", "skeleton_exact or skeleton_approx")

SUFFIXES = {".svg": "svg", ".svgz": "svg", ".dxf": "dxf"}
_HEAD = 4096
_SVG = rb"(?s)(\xef\xbb\xbf)?(<\?xml[^>]*>|<!--.*?-->|<!DOCTYPE[^>\[]*(\[.*?\]\s*)?>|\s++)*+<([\w-]+:)?svg[\s>]"
_DXF = rb"(\xef\xbb\xbf)?\s*(999[ \t]*\r?\n[^\n]*\n\s*)*0[ \t]*\r?\n[ \t]*SECTION[ \t]*\r?\n"
BINARY_DXF = b"AutoCAD Binary DXF\r\n\x1a\0"


def drawing_format(source: Source) -> str | None:
    """Tell the format of a drawing by the extension, else by the content; None if it is none."""
    by_suffix = SUFFIXES.get(source.suffix)
    if by_suffix is not None and source.data.strip():
        return by_suffix
    head = source.data[:_HEAD]
    if head.startswith(b"\x1f\x8b"):
        head = _unpacked_head(head)
    if b"svg" in head and re.match(_SVG, head):
        return "svg"
    return "dxf" if head.startswith(BINARY_DXF) or (b"SECTION" in head and re.match(_DXF, head)) else None


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


_MAPS = (".gml", ".gdb", ".tab", ".mif")
_SHAPEFILE_PARTS = (".shx", ".dbf", ".prj", ".cpg")
_DRAWINGS = (".pdf", ".eps", ".ps", ".ai")
_FONTS = (".ttf", ".otf", ".ttc", ".woff", ".woff2")
_OTHERS = (".dwg", ".zip", ".qgz", ".qgs", ".roi", *_FONTS, *_SHAPEFILE_PARTS)
_KNOWN_HEADS = (
    *((b"%PDF-", ".pdf"), (b"%!PS", ".ps"), (b"\xc5\xd0\xd3\xc6", ".eps"), (b"OTTO\0", ".otf")),
    *((b"\0\1\0\0\0", ".ttf"), (b"wOFF", ".woff"), (b"wOF2", ".woff2"), (b"ttcf", ".ttc")),
)
_DWG = rb"AC10\d\d\0"


def refuse_convertible(source: Source) -> None:
    """Refuse the formats of maps and drawings that are not read, by extension or content."""
    heads = (suffix for head, suffix in _KNOWN_HEADS if source.data.startswith(head))
    found = source.suffix if source.suffix in _MAPS + _DRAWINGS + _OTHERS else next(heads, None)
    if found is None and source.data.startswith(b"AC10") and re.match(_DWG, source.data):
        found = ".dwg"
    if found == ".zip" and b".roi" in source.data:
        found = ".roi"
    if found is not None:
        from pathlib import Path

        file = source.name if source.suffix == found else f"FILE{found}"
        advice = _CONVERSIONS.get(found, _MAP).format(file=file, stem=Path(file).with_suffix(""))
        raise InputError(f"{source.name}: {found} files are not supported; {advice}")


_DRAWING = (
    f"convert it to an image and use {OTSU}, for example: {{}}; or, for its outlines, an SVG: inkscape {{{{file}}}} "
    "--export-text-to-path --export-plain-svg --export-filename={{stem}}.svg"
)
_POSTSCRIPT = _DRAWING.format("gs -o {stem}.png -sDEVICE=pnggray -r300 -dEPSCrop {file}")
_MAP = "convert it: ogr2ogr -f GeoJSON {stem}.geojson {file}"
_CONVERSIONS = {
    **dict.fromkeys((".eps", ".ps", ".ai"), _POSTSCRIPT),
    ".pdf": _DRAWING.format("pdftoppm -r 300 -gray -singlefile {file} {stem}"),
    **dict.fromkeys(
        _FONTS, "it is a font: write the text in a drawing program, convert it to paths, and save these as SVG"
    ),
    **dict.fromkeys(_SHAPEFILE_PARTS, "it is part of a Shapefile: name {stem}.shp"),
    ".dwg": "save it as DXF in the program that made it, or convert it: dwg2dxf -o {stem}.dxf {file}",
    ".zip": "unpack it, and name a file from it: unzip {file}",
    **dict.fromkeys((".qgz", ".qgs"), "it is a project of QGIS: name the files of its layers"),
    ".roi": "make a mask of the regions in ImageJ (Edit, Selection, Create Mask), and use that image",
}
"""What to do with a file, by its extension; with others as with maps."""
