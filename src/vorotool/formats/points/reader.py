"""Reading points, whatever the format."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from vorotool.errors import InputError, UsageError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.convertible import refuse_convertible
from vorotool.formats.parsing.format_names import POINT_NAMES, known_input_format
from vorotool.formats.parsing.reader_options import PointOptions, no_note
from vorotool.formats.parsing.reference_systems import with_crs
from vorotool.formats.points.delimited import read_text
from vorotool.formats.points.json import read_geojson, read_json
from vorotool.formats.points.node import read_node
from vorotool.formats.points.npy import read_npy
from vorotool.formats.points.tables import NPZ_MAGIC, read_npz
from vorotool.formats.points.wkt import read_wkt
from vorotool.geometry.points.point_set import PointSet

_READERS: dict[str, Callable[[Source, PointOptions], PointSet]] = {
    "csv": read_text,
    "node": read_node,
    "npy": read_npy,
    "npz": read_npz,
    "geojson": read_geojson,
    "wkt": read_wkt,
    "json": read_json,
}
POINT_FORMATS = tuple(_READERS)
"""Formats that have a reader; ``csv`` stands for all delimited text."""

_BY_SUFFIX = {
    ".csv": "csv",
    ".tsv": "csv",
    ".node": "node",
    ".npy": "npy",
    ".npz": "npz",
    ".geojson": "geojson",
    ".wkt": "wkt",
}
_WKT = re.compile(
    rb"\s*(SRID\s*=\s*\d+\s*;\s*)?(MULTI)?(POINT|LINESTRING|POLYGON|GEOMETRYCOLLECTION)\s*(Z|M|ZM)?\s*(\(|EMPTY)",
    re.IGNORECASE,
)
_UTF8_MARK = b"\xef\xbb\xbf"
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")


def detect_point_format(source: Source) -> str:
    """Tell the format of points by the extension, else by the content.

    Raises
    ------
    InputError
        If it is a format that has to be converted first; the message gives the command.

    Examples
    --------
    >>> detect_point_format(Source("standard input", b"POINT (1 2)"))
    'wkt'
    """
    refuse_convertible(source)
    if source.suffix in _BY_SUFFIX:
        return _BY_SUFFIX[source.suffix]
    head = source.data[:4096].removeprefix(_UTF8_MARK).lstrip()
    if head.startswith(b"\x93NUMPY"):
        return "npy"
    if head.startswith(NPZ_MAGIC):
        return "npz"
    if head.startswith(b"{"):
        return "geojson"
    if head.startswith(b"["):
        return "json"
    return "wkt" if _WKT.match(head) else "csv"


def read_points(
    source: Source,
    *,
    input_format: str | None = None,
    columns: str | None = None,
    properties: bool = True,
    max_sites: int | None = None,
    threads: int = 0,
    note: Callable[[str], None] | None = None,
    crs: Any = None,
) -> PointSet:
    r"""Read points, in the order of the input.

    Delimited text may have a byte order mark, ``#`` comments, blank lines, quoted fields, and commas,
    semicolons, tabs or blanks between fields. A header with x,y, lon,lat, longitude,latitude,
    centroid-1,centroid-0 or axis-1,axis-0 (in any case) says which columns are the coordinates; without a
    header two columns are x, y; all else needs ``columns``. A column ``label`` is used when ``columns`` names
    it, or when the header is x, y and label alone. GeoJSON, WKT, and longitude and latitude by the header are points
    with y upwards.

    Parameters
    ----------
    source : Source
        What was read.
    input_format : str, optional
        A name in `POINT_NAMES`; by default the extension decides, else the content.
    columns : str, optional
        ``X,Y`` or ``X,Y,LABEL``, each by name or by number from 1; for delimited text and tables.
    properties : bool
        Keep the other columns, and ``id`` and properties of GeoJSON. Fields of text stay text.
    max_sites : int, optional
        The most points that are accepted.
    threads : int
        Threads for text; 0 for all.
    note : callable, optional
        Called with a line for each thing that was guessed or left out.
    crs : object, optional
        The ``crs`` member of GeoJSON for an input that names none.

    Returns
    -------
    PointSet
        Without points when the input has none.

    Raises
    ------
    InputError
        If the input cannot be used; the line or index, the value and what to do are named.
    LimitError
        If there are more than ``max_sites`` points; found before memory is taken for them.
    UsageError
        If an option is malformed or does not fit the format.

    Examples
    --------
    >>> read_points(Source("seeds.csv", b"x,y,label\n2,1,7\n5.5,3,9\n")).labels
    array([7, 9])
    """
    chosen = known_input_format(input_format, POINT_NAMES) or detect_point_format(source)
    if columns is not None and chosen not in ("csv", "json", "npz"):
        raise UsageError(f"--columns is for delimited text, but {source.name} is read as {chosen}: leave it out")
    if chosen not in ("npy", "npz"):
        source = text_source(source)
    options = PointOptions(columns, properties, max_sites, threads, note or no_note, crs)
    return with_crs(_READERS[chosen](source, options), source.name, crs, options.note)


def text_source(source: Source) -> Source:
    """Take the byte order mark off, and refuse what is no text in an encoding that is read."""
    if source.data.startswith(_UTF16_MARKS):
        raise InputError(f"{source.name} is UTF-16 text; save it as UTF-8 (iconv -f UTF-16 -t UTF-8)")
    if source.data.startswith(NPZ_MAGIC):
        raise InputError(
            f"{source.name} is an NPZ or ZIP archive, which is read as a table of points only: of polygons, skeletons "
            "and offset curves give the JSON (-f json), unpack others"
        )
    if b"\0" in source.data[:4096]:
        raise InputError(
            f"{source.name} is binary, not points or polygons; use CSV, .node, NPY, .poly, GeoJSON, WKT or JSON, or "
            "say which with --input-format"
        )
    if source.data.startswith(_UTF8_MARK):
        return Source(source.name, source.data.removeprefix(_UTF8_MARK))
    return source
