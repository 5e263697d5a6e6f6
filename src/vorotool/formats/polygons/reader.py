"""Reading and writing polygons and open lines, whatever the format."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, BinaryIO

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.convertible import refuse_geometry_column
from vorotool.formats.parsing.format_names import POLYGON_NAMES, known_input_format
from vorotool.formats.parsing.geojson import JsonSource, holds_shapes, parse_json
from vorotool.formats.parsing.reader_options import no_note
from vorotool.formats.parsing.reference_systems import with_crs
from vorotool.formats.points.delimited import header_fields
from vorotool.formats.points.reader import detect_point_format, text_source
from vorotool.formats.points.tables import is_table
from vorotool.formats.polygons.geojson import read_geojson, write_geojson
from vorotool.formats.polygons.json import is_list_of_shells, read_json, write_json
from vorotool.formats.polygons.poly import read_poly, write_poly
from vorotool.formats.polygons.ring_collector import PolygonOptions
from vorotool.formats.polygons.wkt import holds_shapes as wkt_holds_shapes
from vorotool.formats.polygons.wkt import read_wkt, write_wkt
from vorotool.geometry.polygons.polygon_set import PolygonSet

_READERS: dict[str, Callable[[Source, PolygonOptions], PolygonSet]] = {
    "json": read_json,
    "geojson": read_geojson,
    "wkt": read_wkt,
    "poly": read_poly,
}
_WRITERS: dict[str, Callable[[BinaryIO, PolygonSet, int | None], None]] = {
    "json": write_json,
    "geojson": write_geojson,
    "wkt": write_wkt,
    "poly": write_poly,
}
POLYGON_FORMATS = tuple(_READERS)
"""Formats of polygons and lines that are read and written."""


def detect_polygon_format(source: Source) -> str:
    """Tell the format of polygons by the extension, else by the content.

    Raises
    ------
    InputError
        If it is a format that holds none, or has to be converted first; the message gives the command.

    Examples
    --------
    >>> detect_polygon_format(Source("standard input", b"LINESTRING (1 2, 3 4)"))
    'wkt'
    """
    if source.suffix == ".poly":
        return "poly"
    if source.suffix == ".json":
        return "json"
    found = detect_point_format(source)
    if found == "geojson" and source.suffix != ".geojson":  # an object: of either kind
        return "json"
    if found in POLYGON_FORMATS:
        return found
    if not source.data.strip():
        raise InputError(
            f"{source.name} is empty: polygons, lines or an image were expected; check what was to write it"
        )
    if found != "npy":
        refuse_geometry_column(source.name, header_fields(text_source(source).data))
    raise InputError(
        f"{source.name} holds no polygons or lines that are read (it looks like {found}): use JSON, GeoJSON, WKT or "
        ".poly, or say which with --input-format; of points alphashape makes polygons"
    )


def recognise(source: Source, input_format: str | None = None) -> tuple[Source, bool]:
    """Tell whether a source that is no image holds polygons or lines; JSON comes back parsed.

    A plain JSON list of pairs is taken for points, and so is what cannot be told.

    Raises
    ------
    InputError
        If the format has to be converted first, or it is not JSON.

    Examples
    --------
    >>> recognise(Source("standard input", b"POINT (1 2)"))[1]
    False
    """
    if input_format == "poly" or (input_format is None and source.suffix == ".poly"):
        return source, True
    chosen = input_format or detect_point_format(source)
    if chosen not in POLYGON_FORMATS:
        return source, False
    source = text_source(source)
    if chosen == "wkt":
        return source, wkt_holds_shapes(source.data)
    if _is_flat(source.data):
        return source, False
    parsed = JsonSource(source.name, source.data, parse_json(source))
    document = parsed.document
    if isinstance(document, list):
        return parsed, not is_table(document) and is_list_of_shells(document)
    return parsed, isinstance(document, dict) and ("polygons" in document or holds_shapes(document))


def _is_flat(data: bytes) -> bool:
    """Whether JSON is at most a list of lists: points by the million are not parsed to tell that they are points."""
    return b"{" not in data and not data.lstrip().removeprefix(b"[").lstrip().removeprefix(b"[").lstrip().startswith(
        b"["
    )


def read_polygons(
    source: Source,
    *,
    input_format: str | None = None,
    properties: bool = True,
    max_sites: int | None = None,
    note: Callable[[str], None] | None = None,
    crs: Any = None,
) -> PolygonSet:
    """Read polygons and open lines, in the order of the input.

    JSON is ``[[x, y], …]`` (one shell), a list of such, or ``{"polygons": […]}`` whose items are shells,
    ``{"shell": […], "holes": […]}`` or ``{"line": […]}``, with ``id``, ``part`` and ``properties`` if wanted. In
    GeoJSON and WKT the parts of a multi-part geometry are polygons of one feature. Rings may repeat their first vertex
    at their end or not (in WKT they must). Geometry without coordinates is left out with a note.

    Coordinates are longitude and latitude where the ``crs`` member of GeoJSON or the SRID of WKT says so, and then a
    note tells that lengths are in degrees. GeoJSON without it is planar, with a note where all fit in ±180 and ±90 and
    not all are whole numbers. Nothing is reprojected.

    Parameters
    ----------
    source : Source
        What was read.
    input_format : str, optional
        A name in `POLYGON_NAMES`; by default the extension decides, else the content.
    properties : bool
        Keep ``id`` and properties.
    max_sites : int, optional
        The most vertices that are accepted.
    note : callable, optional
        Called with a line for each thing that was guessed or left out.
    crs : object, optional
        The ``crs`` member of GeoJSON for an input that names none.

    Returns
    -------
    PolygonSet
        Without polygons when the input has none.

    Raises
    ------
    InputError
        If the input cannot be used; the line or place, the value and what to do are named.
    LimitError
        If there are more than ``max_sites`` vertices.
    UsageError
        If the format is unknown.

    Examples
    --------
    >>> read_polygons(Source("shape.wkt", b"POLYGON ((0 0, 4 0, 0 3, 0 0))")).xy.tolist()
    [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]
    """
    chosen = known_input_format(input_format, POLYGON_NAMES) or detect_polygon_format(source)
    options = PolygonOptions(properties, max_sites, note or no_note, crs)
    return with_crs(_READERS[chosen](text_source(source), options), source.name, crs, options.note)


def write_polygons(out: BinaryIO, polygons: PolygonSet, fmt: str, *, precision: int | None = None) -> None:
    r"""Write polygons and lines; the bytes depend on nothing but these, the format and the precision.

    The parts of a feature become one multi-part geometry, but in JSON, which numbers them. WKT and ``.poly`` have no
    place for ids and properties; ``.poly`` has none for features either.

    Parameters
    ----------
    out, precision
        As of `vorotool.formats.text.tables.write_table`.
    polygons : PolygonSet
        What to write.
    fmt : {"json", "geojson", "wkt", "poly"}
        The format.

    Examples
    --------
    >>> import io
    >>> out = io.BytesIO()
    >>> write_polygons(out, read_polygons(Source("a.json", b"[[0, 0], [4, 0.5], [0, 3]]")), "wkt")
    >>> out.getvalue()
    b'POLYGON ((0 0, 4 0.5, 0 3, 0 0))\n'
    """
    _WRITERS[fmt](out, polygons, precision)
