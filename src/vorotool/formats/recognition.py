"""What an input is: its format, told by what is said of it, its name or its first bytes, and what it holds."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import NamedTuple

from vorotool.errors import INPUT_FORMAT, OTSU, InputError, UsageError, option
from vorotool.formats.io.sources import NPY, NPZ, Source
from vorotool.products.formats import resolved
from vorotool.products.inputs import IMAGE_NAMES, INPUTS, Holds

_IMAGES = frozenset(IMAGE_NAMES.values())
_IMAGE_SUFFIXES = {f".{name}": kind for name, kind in IMAGE_NAMES.items() if kind != "zarr"}
DRAWN = frozenset(each.name for each in INPUTS.values() if "curves" in each.has)
"""Formats of drawings."""

_SUFFIXES = {f".{name}": each.name for each in INPUTS.values() for name in each.names if name not in ("json", "txt")}
"""Extensions that tell the format; JSON is of one of several kinds, and text of any."""
_OF_ROWS = frozenset({"", ".csv", ".tsv", ".txt", ".wkt"})
"""Extensions of texts that need nothing but rows; other formats are damaged without a document or a header."""

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
"""Bytes that tell the format of what is no image."""
_IMAGE_HEAD = 65_536
"""Those of an image, which may begin with comments."""


class Sign(NamedTuple):
    """What files of a format begin with."""

    format: str  # of those that are not read the extension, with its dot
    head: bytes  # these bytes
    at: int = 0  # at this place
    pattern: bytes = b""  # and what matches this


_SVG = rb"(?s)(<\?xml[^>]*>|<!--.*?-->|<!DOCTYPE[^>\[]*(\[.*?\]\s*)?>|\s++)*+<([\w-]+:)?svg[\s>]"
_DXF = rb"(999[ \t]*\r?\n[^\n]*\n\s*)*0[ \t]*\r?\n[ \t]*SECTION[ \t]*\r?\n"
_MARKUP = rb"(?:<[?!][^>]*>\s*)*<%b[\s>]"
_WKT = (
    rb"(?i)(SRID\s*=\s*\d+\s*;\s*)?((MULTI)?(POINT|LINESTRING|POLYGON|CURVE|SURFACE)|GEOMETRYCOLLECTION|LINEARRING|"
    rb"CIRCULARSTRING|COMPOUNDCURVE|CURVEPOLYGON|POLYHEDRALSURFACE|TIN|TRIANGLE)\s*(Z|M|ZM)?\s*(\(|EMPTY)"
)
_SIGNS = (
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
    Sign("dxf", BINARY_DXF),
    Sign("svg", b"<", pattern=_SVG),
    *(Sign("dxf", head, pattern=_DXF) for head in (b"0", b"999")),
    *(Sign(".pdf", b"%PDF-"), Sign(".ps", b"%!PS"), Sign(".eps", b"\xc5\xd0\xd3\xc6"), Sign(".otf", b"OTTO\0")),
    *(Sign(".ttf", b"\0\1\0\0\0"), Sign(".woff", b"wOFF"), Sign(".woff2", b"wOF2"), Sign(".ttc", b"ttcf")),
    Sign(".dwg", b"AC10", pattern=rb"AC10\d\d\0"),
    *(Sign("npz", NPZ), Sign("gpkg", b"SQLite format 3\0"), Sign("fgb", b"fgb\x03fgb")),
    *(Sign("shp", b"\0\0\x27\x0a"), Sign("parquet", b"PAR1"), Sign("las", b"LASF")),
    *(Sign("ply", b"ply\n"), Sign("ply", b"ply\r")),
    *(Sign("geojson", b"{"), Sign("json", b"["), Sign("jsonl", RECORD_MARK)),
    *(Sign(name, b"<", pattern=_MARKUP % name.encode()) for name in ("kml", "gpx")),
    *(Sign("wkt", bytes([letter]), pattern=_WKT) for letter in b"SMPLGCTsmplgct"),
)


def format_of(data: bytes) -> str | None:
    """Tell the format by what a file begins with, text after its blanks; None of rows of text, if it is any."""
    whole, text = data[:_IMAGE_HEAD], data[:_HEAD].removeprefix(UTF8_MARK).lstrip()
    for sign in _SIGNS:
        start = whole if sign.format in _IMAGES else text
        if start.startswith(sign.head, sign.at) and re.match(sign.pattern, start):
            return sign.format
    return None


_ALPHA = option("alphashape", "alpha_shape")
_TAKERS = option(
    "skeleton-exact, skeleton-approx, voronoi, distance or draw", "skeleton_exact, skeleton_approx or voronoi"
)

_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_WITH_COLUMNS = ("csv", "json", "jsonl", "npz", "parquet", "gpkg", "ply", "xyz", "las")
_RESULTS: dict[bytes, Holds] = {
    b'"vorotool.skeleton"': "skeleton",
    b'"vorotool.offsets"': "offsets",
    b'"vorotool.voronoi"': "voronoi",
}


def recognized(
    source: Source, geometry: str | None = None, said: str | None = None, columns: str | None = None
) -> tuple[Holds, Source]:
    """Tell what a source holds, and give it with its format; what was parsed to tell comes with it."""
    if geometry is None and said in (None, "json", "geojson") and (result := _result(source.data)) is not None:
        return result, text_source(source, "json")
    may_be_points = columns is not None and source.data.startswith(NPY)
    image = None if may_be_points else image_format(source, said)
    if image is not None:
        return "image", replace(source, format=image)
    if geometry == "points" or (geometry in (None, "sites") and columns is not None):
        chosen = said or geometry_format(source)
        if said is None and chosen in DRAWN:
            raise InputError(
                f"{source.name} is a drawing (polygons and lines), but points or an image are expected: use {_TAKERS}, "
                f"or convert the drawing to an image and use {OTSU}"
            )
        source = text_source(source, chosen)
        if columns is not None and source.format not in _WITH_COLUMNS:
            raise UsageError(
                f"{option('--columns')} applies to delimited text, but {source.name} is read as {chosen}: leave it out"
            )
        return "points", source
    if geometry == "sites":
        return _sites(*_either(source, said))
    if geometry == "polygons":
        holds: Holds = "polygons"
        source = text_source(source, said or polygon_format(source))
    else:
        holds, source = _either(source, said)
    if holds == "polygons" and columns is not None:
        raise UsageError(f"{option('--columns')} applies to lists of points: leave it out for polygons")
    return holds, source


def image_format(source: Source, said: str | None = None) -> str | None:
    """Give the format of an image: what is said, else the extension, else the content; None if it is no image."""
    if said is not None and "image" not in INPUTS[said].readers:
        return None
    found, by_name = format_of(source.data), _IMAGE_SUFFIXES.get(source.suffix)
    found = found if found in _IMAGES else None
    kind = found or by_name
    if said in (None, "npy") and (kind is None or (kind == "npy" and not _is_npy_image(source))):
        return None
    chosen = said or by_name or found
    if chosen == "zarr":
        raise InputError(f"{source.name} is a file, but a Zarr store is a folder: leave out {INPUT_FORMAT}")
    if not source.data:
        raise InputError(f"{source.name} is empty, but an image is expected: check the program that wrote it")
    if found and found != chosen:
        said_so = option(f"--input-format {found}", f'input_format="{found}"')
        raise InputError(f"{source.name} is not a {chosen} file, it begins as {found}: use {said_so}")
    return chosen


def _is_npy_image(source: Source) -> bool:
    from vorotool.formats.io.arrays import npy_header

    try:
        shape = npy_header(source).shape
    except InputError:
        return False
    return len(shape) in (2, 3) and shape[1] != 2


def _result(data: bytes) -> Holds | None:
    """What of ours text looks like the JSON of, which is not parsed to tell."""
    found = next((holds for kind, holds in _RESULTS.items() if kind in data), None)
    return found if found and data.lstrip(UTF8_MARK + b" \t\r\n").startswith(b"{") else None


def geometry_format(source: Source) -> str:
    """Tell the format of what is no image: by the extension, else by the content; drawings by either."""
    named, found = _SUFFIXES.get(source.suffix), format_of(source.data)
    is_drawn = named in DRAWN and bool(source.data.strip())
    if is_drawn or found in DRAWN:
        return str(named if is_drawn else found)
    is_told = named is not None and "points" in INPUTS[named].readers
    if found == "npz" and not is_told and resolved("formats.gis.vector_files:holds_shapefile")(source.data):
        return "shp"
    kind = source.suffix if source.suffix in _CONVERSIONS else found
    if kind in _CONVERSIONS:
        raise _not_supported(source, kind)
    return str(named) if is_told else found or "csv"


def has_no_rows(source: Source) -> bool:
    """Return whether a text of rows (CSV, WKT, or without an extension) has none, not even a header."""
    return source.suffix in _OF_ROWS and not source.data.strip()


def polygon_format(source: Source) -> str:
    """Tell the format of polygons by the extension, else by the content."""
    if source.suffix in (".poly", ".json"):
        return source.suffix.removeprefix(".")
    found = geometry_format(source)
    if found in DRAWN:
        return found
    if found == "geojson" and source.suffix != ".geojson":  # an object: of either kind
        return "json"
    if has_no_rows(source):
        return "wkt"
    if not source.data.strip() and found == "csv":
        raise InputError(
            f"{source.name} is empty, but polygons, lines or an image are expected; check the program that wrote it"
        )
    from vorotool.formats.points.delimited import begun, geometry_column

    is_table = found == "csv" and geometry_column(begun(text_source(source, found).data).fields) is None
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
    chosen = said or geometry_format(source)
    source = text_source(source, chosen)
    if chosen == "csv":
        from vorotool.formats.points.delimited import begun, has_geometry

        if has_geometry(begun(source.data).fields):
            chosen, source = "csv-wkt", replace(source, format="csv-wkt")
    if chosen == "csv" or "polygons" not in INPUTS[chosen].readers:
        return "points", source
    if INPUTS[chosen].features and chosen != "wkt":
        source = replace(source, document=resolved("formats.gis.feature_table:features_of")(source))
        return ("polygons" if source.document.holds_shapes else "points"), source
    if chosen == "npz":
        holds = resolved("formats.io.arrays:npz_holds")(source.data)
        return holds, source
    if chosen in DRAWN or chosen == "wkt":
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
    from vorotool.formats.parsing.json import holds_shapes, is_table, parse_json

    document = parse_json(source)
    if isinstance(document, list):
        has_shapes = not is_table(document) and resolved("formats.polygons.json:is_list_of_shells")(document)
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


def text_source(source: Source, chosen: str) -> Source:
    """Give a source with its format.

    The byte order mark of text is taken off, JSON is told from lines of it, and what is no text is refused.
    """
    if "bytes" in INPUTS[chosen].has:
        return replace(source, format=chosen)
    if source.data.startswith(_UTF16_MARKS):
        raise InputError(f"{source.name} is UTF-16 text; save it as UTF-8 (iconv -f UTF-16 -t UTF-8)")
    if source.data.startswith(NPZ):
        raise InputError(
            f"{source.name} is an NPZ or ZIP archive: for NPZ leave out {INPUT_FORMAT}, or name the file .npz; unpack "
            "a ZIP archive"
        )
    if b"\0" in source.data[:4096]:
        raise InputError(
            f"{source.name} is binary, not points or polygons; use CSV, .node, NPY, .poly, GeoJSON, WKT or JSON, or "
            f"name the format with {INPUT_FORMAT}"
        )
    data = source.data.removeprefix(UTF8_MARK)
    is_lines = chosen in ("json", "geojson") and resolved("formats.parsing.json:is_json_lines")(data)
    return replace(source, data=data, format="jsonl" if is_lines else chosen)


# ---- what is not read ----------------------------------------------------------------------------
_FONTS = (".ttf", ".otf", ".ttc", ".woff", ".woff2")
_SHAPEFILE_PARTS = (".shx", ".dbf", ".prj", ".cpg")
_DRAWING = (
    f"convert it to an image and use {OTSU}, for example: {{}}; or, for its outlines, an SVG: inkscape {{{{file}}}} "
    "--export-text-to-path --export-plain-svg --export-filename={{stem}}.svg"
)
_POSTSCRIPT = _DRAWING.format("gs -o {stem}.png -sDEVICE=pnggray -r300 -dEPSCrop {file}")
_CONVERSIONS = {
    **dict.fromkeys((".gml", ".gdb", ".tab", ".mif"), "convert it: ogr2ogr -f GeoJSON {stem}.geojson {file}"),
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
"""What to do with a file that is not read, by its extension."""


def _not_supported(source: Source, kind: str) -> InputError:
    """Say that the format of a map or a drawing is not read, and what to do."""
    if kind == ".zip" and b".roi" in source.data:
        kind = ".roi"
    from pathlib import Path

    file = source.name if source.suffix == kind else f"FILE{kind}"
    advice = _CONVERSIONS[kind].format(file=file, stem=Path(file).with_suffix(""))
    return InputError(f"{source.name}: {kind} files are not supported; {advice}")
