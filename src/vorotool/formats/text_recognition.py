"""The format of points, polygons, lines and drawings, which of them a source holds, and its text."""

from __future__ import annotations

from dataclasses import replace

from vorotool.errors import INPUT_FORMAT, OTSU, InputError, UsageError, option
from vorotool.formats.io.sources import NPZ, Source
from vorotool.formats.sniffing import UTF8_MARK, format_of
from vorotool.products.formats import resolved
from vorotool.products.inputs import INPUTS, Holds

_ALPHA = option("alphashape", "alpha_shape")
_TAKERS = option(
    "skeleton-exact, skeleton-approx, voronoi, distance or draw", "skeleton_exact, skeleton_approx or voronoi"
)

DRAWN = frozenset(each.name for each in INPUTS.values() if "curves" in each.has)
"""Formats of drawings."""

_SUFFIXES = {f".{name}": each.name for each in INPUTS.values() for name in each.names if name not in ("json", "txt")}
"""Extensions that tell the format; JSON is of one of several kinds, and text of any."""
_OF_ROWS = frozenset({"", ".csv", ".tsv", ".txt", ".wkt"})
"""Extensions of texts that need nothing but rows; other formats are damaged without a document or a header."""
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_WITH_COLUMNS = ("csv", "json", "jsonl", "npz", "parquet", "gpkg", "ply", "xyz", "las")


def recognized_geometry(
    source: Source, geometry: str | None, said: str | None, columns: str | None
) -> tuple[Holds, Source]:
    """Tell what a source holds that is no image, and give it with its format."""
    if geometry == "points" or (geometry in (None, "sites") and columns is not None):
        chosen = _by_header(source, said or point_format(source), columns)
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


def point_format(source: Source) -> str:
    """Tell the format of points; a drawing has none."""
    found = _format(source)
    if found in DRAWN:
        raise InputError(
            f"{source.name} is a drawing (polygons and lines), but points or an image are expected: use {_TAKERS}, or "
            f"convert the drawing to an image and use {OTSU}"
        )
    return found


def _format(source: Source) -> str:
    """Tell the format of what is no image: by the extension, else by the content; drawings by either."""
    named, found = _SUFFIXES.get(source.suffix), format_of(source.data)
    is_drawn = named in DRAWN and bool(source.data.strip())
    if is_drawn or found in DRAWN:
        return str(named if is_drawn else found)
    is_told = named is not None and "points" in INPUTS[named].readers
    if found == "npz" and not is_told and resolved("formats.gis.vector_files:holds_shapefile")(source.data):
        return "shp"
    _refuse_convertible(source, found)
    return str(named) if is_told else found or "csv"


def _by_header(source: Source, chosen: str, columns: str | None = None) -> str:
    """Take points from a column of well-known text where the header names such a one, and no coordinates."""
    if chosen != "csv" or columns is not None:
        return chosen
    from vorotool.convert.tables import coordinate_columns
    from vorotool.formats.points.delimited import begun, geometry_column

    fields = begun(text_source(source, chosen).data).fields
    return "csv-wkt" if geometry_column(fields) is not None and coordinate_columns(fields) is None else chosen


def has_no_rows(source: Source) -> bool:
    """Return whether a text of rows (CSV, WKT, or without an extension) has none, not even a header."""
    return source.suffix in _OF_ROWS and not source.data.strip()


def polygon_format(source: Source) -> str:
    """Tell the format of polygons by the extension, else by the content."""
    if source.suffix in (".poly", ".json"):
        return source.suffix.removeprefix(".")
    found = _format(source)
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
    chosen = _by_header(source, said or _format(source))
    if chosen == "csv" or "polygons" not in INPUTS[chosen].readers:
        return "points", text_source(source, chosen)
    source = text_source(source, chosen)
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
    from vorotool.formats.parsing.json import holds_shapes, parse_json

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
_MAPS = (".gml", ".gdb", ".tab", ".mif")
_SHAPEFILE_PARTS = (".shx", ".dbf", ".prj", ".cpg")
_DRAWINGS = (".pdf", ".eps", ".ps", ".ai")
_FONTS = (".ttf", ".otf", ".ttc", ".woff", ".woff2")
_OTHERS = (".dwg", ".zip", ".qgz", ".qgs", ".roi", *_FONTS, *_SHAPEFILE_PARTS)


def _refuse_convertible(source: Source, found: str | None) -> None:
    """Refuse the formats of maps and drawings that are not read, by extension or content."""
    kind = source.suffix if source.suffix in _MAPS + _DRAWINGS + _OTHERS else found
    if kind is None or not kind.startswith("."):
        return
    if kind == ".zip" and b".roi" in source.data:
        kind = ".roi"
    from pathlib import Path

    file = source.name if source.suffix == kind else f"FILE{kind}"
    advice = _CONVERSIONS.get(kind, _MAP).format(file=file, stem=Path(file).with_suffix(""))
    raise InputError(f"{source.name}: {kind} files are not supported; {advice}")


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
