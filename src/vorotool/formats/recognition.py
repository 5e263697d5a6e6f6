"""The format of an input, and what it holds: told once, by what the caller says, the content and the extension."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from vorotool.errors import InputError, UsageError
from vorotool.formats.images.picture_reader import PICTURES, picture_format
from vorotool.formats.images.pnm_reader import looks_like_pnm
from vorotool.formats.io.npy_arrays import MAGIC, npy_header
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.convertible import refuse_convertible, refuse_geometry_column
from vorotool.formats.parsing.geojson import holds_shapes, parse_json
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.parsing.reference_systems import with_crs
from vorotool.formats.points.delimited import header_fields
from vorotool.formats.points.tables import NPZ_MAGIC, is_table
from vorotool.formats.polygons.json import is_list_of_shells
from vorotool.formats.polygons.wkt import holds_shapes as wkt_holds_shapes
from vorotool.products.formats import resolved
from vorotool.products.inputs import IMAGE_NAMES, INPUTS, Holds

_IMAGE_SUFFIXES = {f".{name}": kind for name, kind in IMAGE_NAMES.items() if kind != "zarr"}
_SUFFIXES = {f".{name}": each.name for each in INPUTS.values() for name in each.names if name not in ("json", "txt")}
"""Extensions that tell the format; JSON is of one of several kinds, and text of any."""
_IMAGE_HEADS = (
    (b"\x89PNG", "png"),
    (b"II*\x00", "tiff"),
    (b"MM\x00*", "tiff"),
    (b"II+\x00", "tiff"),
    (b"MM\x00+", "tiff"),
    (MAGIC, "npy"),
)
_RESULTS: dict[bytes, Holds] = {b'"vorotool.skeleton"': "skeleton", b'"vorotool.offsets"': "offsets"}
_WKT = re.compile(
    rb"\s*(SRID\s*=\s*\d+\s*;\s*)?(MULTI)?(POINT|LINESTRING|POLYGON|GEOMETRYCOLLECTION)\s*(Z|M|ZM)?\s*(\(|EMPTY)",
    re.IGNORECASE,
)
_UTF8_MARK = b"\xef\xbb\xbf"
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_WITH_COLUMNS = ("csv", "json", "npz")


def recognised(
    source: Source, geometry: str | None = None, said: str | None = None, columns: str | None = None
) -> tuple[Holds, Source]:
    """Tell what a source holds, and give it with its format; what was parsed to tell comes with it.

    Where geometry is not said, a plain JSON list of pairs is taken for points, and so is what cannot be told.

    Parameters
    ----------
    source : Source
        What was read.
    geometry : {"points", "polygons"}, optional
        What must be in it, if it is no image.
    said : str, optional
        The format, as the caller says.
    columns : str, optional
        Those of a list of points, which NPY files may hold as well as images.

    Raises
    ------
    InputError
        If it is in a format that is not read, or cannot be what it is said to be; the message says what to do.
    UsageError
        If columns are chosen in what has none.

    Examples
    --------
    >>> recognised(Source("a.csv", b"1,2"))[0], recognised(Source("standard input", b"LINESTRING (1 2, 3 4)"))[0]
    ('points', 'polygons')
    >>> holds, source = recognised(Source("-", b"P5 1 1 255 x"))
    >>> holds, source.format
    ('image', 'pnm')
    """
    if geometry is None and said in (None, "json"):
        result = _result(source.data)
        if result is not None:
            return result, _text(source, "json")
    may_be_points = columns is not None and source.data.startswith(MAGIC)
    image = None if may_be_points else image_format(source, said)
    if image is not None:
        return "image", replace(source, format=image)
    if geometry == "points" or (geometry is None and columns is not None):
        return "points", _points(source, said or point_format(source), columns)
    if geometry == "polygons":
        holds: Holds = "polygons"
        source = _text(source, said or polygon_format(source))
    else:
        holds, source = _either(source, said)
    if holds == "polygons" and columns is not None:
        raise UsageError("--columns is for lists of points: leave it out for polygons")
    return holds, source


def read_recognised(holds: Holds, source: Source, options: ReadOptions) -> Any:
    r"""Read what a source was recognised as: points, polygons, an image, a skeleton or offset curves.

    Raises
    ------
    InputError, LimitError, UsageError
        As `vorotool.read`.

    Examples
    --------
    >>> read_recognised(*recognised(Source("seeds.csv", b"x,y,label\n2,1,7\n5.5,3,9\n")), ReadOptions()).labels
    array([7, 9])
    """
    if holds == "image":
        refuse_crs(options.crs)
    reader: Callable[[Source, ReadOptions], Any] = resolved(INPUTS[source.format].readers[holds])
    value = reader(source, options)
    return with_crs(value, source.name, options.crs, options.note) if holds in ("points", "polygons") else value


def refuse_crs(crs: Any) -> None:
    """Refuse a coordinate reference system that an image is declared to be in."""
    if crs is not None:
        raise UsageError("--input-crs is for points, polygons and lines, but the input is an image: leave it out")


def image_source(source: Source, said: str | None = None) -> Source:
    """Give a source, which must be an image, with its format; an NPY file of two columns is one, too.

    Raises
    ------
    InputError
        If it is none.
    """
    said = "npy" if said is None and source.data.startswith(MAGIC) else said
    found = said if said == "npy" and source.data.startswith(MAGIC) else image_format(source, said)
    if found is None:
        raise InputError(
            f"{source.name} is no image that is read (PNG, TIFF, PGM, PBM, NPY, {', '.join(PICTURES.values())}): "
            "name it with --input-format, or convert it to PNG"
        )
    return replace(source, format=found)


def image_format(source: Source, said: str | None = None) -> str | None:
    """Give the format of an image: what is said, else the extension, else the content; None if it is no image.

    An NPY file of shape (n, 2) is a list of points, and no image.

    Raises
    ------
    InputError
        If what is said or the extension is an image, and the content plainly another.

    Examples
    --------
    >>> image_format(Source("-", b"GIF89a")), image_format(Source("a.csv", b"1,2"))
    ('gif', None)
    """
    if said is not None and "image" not in INPUTS[said].readers:
        return None
    found, by_name = _image_by_content(source.data), _IMAGE_SUFFIXES.get(source.suffix)
    kind = found or by_name
    if said in (None, "npy") and (kind is None or (kind == "npy" and not _is_npy_image(source))):
        return None
    chosen = said or by_name or found
    if chosen == "zarr":
        raise InputError(f"{source.name} is a file, but a Zarr store is a folder: leave out --input-format")
    if not source.data:
        raise InputError(f"{source.name} is empty: an image was expected")
    if found and found != chosen:
        raise InputError(f"{source.name} is no {chosen} file, it begins as {found}: use --input-format {found}")
    return chosen


def _is_npy_image(source: Source) -> bool:
    try:
        shape = npy_header(source).shape
    except InputError:
        return False
    return len(shape) in (2, 3) and shape[1] != 2


def _image_by_content(data: bytes) -> str | None:
    for head, name in _IMAGE_HEADS:
        if data.startswith(head):
            return name
    return "pnm" if looks_like_pnm(data) else picture_format(data)


def _result(data: bytes) -> Holds | None:
    """What of ours text looks like the JSON of, which is not parsed to tell."""
    found = next((holds for kind, holds in _RESULTS.items() if kind in data), None)
    return found if found and data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{") else None


def point_format(source: Source) -> str:
    """Tell the format of points, if it is one, by the extension, else by the content.

    Raises
    ------
    InputError
        If it is a format that has to be converted first; the message gives the command.

    Examples
    --------
    >>> point_format(Source("standard input", b"POINT (1 2)"))
    'wkt'
    """
    refuse_convertible(source)
    by_suffix = _SUFFIXES.get(source.suffix)
    if by_suffix is not None and "points" in INPUTS[by_suffix].readers:
        return by_suffix
    head = source.data[:4096].removeprefix(_UTF8_MARK).lstrip()
    for start, name in ((MAGIC, "npy"), (NPZ_MAGIC, "npz"), (b"{", "geojson"), (b"[", "json")):
        if head.startswith(start):
            return name
    return "wkt" if _WKT.match(head) else "csv"


def polygon_format(source: Source) -> str:
    """Tell the format of polygons by the extension, else by the content.

    Raises
    ------
    InputError
        If it is a format that holds none, or has to be converted first; the message gives the command.

    Examples
    --------
    >>> polygon_format(Source("standard input", b"LINESTRING (1 2, 3 4)"))
    'wkt'
    """
    if source.suffix in (".poly", ".json"):
        return source.suffix.removeprefix(".")
    found = point_format(source)
    if found == "geojson" and source.suffix != ".geojson":  # an object: of either kind
        return "json"
    if "polygons" in INPUTS[found].readers:
        return found
    if not source.data.strip():
        raise InputError(
            f"{source.name} is empty: polygons, lines or an image were expected; check what was to write it"
        )
    if found != "npy":
        refuse_geometry_column(source.name, header_fields(_text(source, found).data))
    raise InputError(
        f"{source.name} holds no polygons or lines that are read (it looks like {found}): use JSON, GeoJSON, WKT or "
        ".poly, or say which with --input-format; of points alphashape makes polygons"
    )


def _either(source: Source, said: str | None) -> tuple[Holds, Source]:
    """Tell whether what is no image holds polygons or lines; JSON is parsed for it."""
    if said == "poly" or (said is None and source.suffix == ".poly"):
        return "polygons", _text(source, "poly")
    chosen = said or point_format(source)
    if "polygons" not in INPUTS[chosen].readers:
        return "points", _points(source, chosen, None)
    source = _text(source, chosen)
    if chosen == "wkt":
        return ("polygons" if wkt_holds_shapes(source.data) else "points"), source
    if _is_flat(source.data):
        return "points", source
    document = parse_json(source)
    if isinstance(document, list):
        has_shapes = not is_table(document) and is_list_of_shells(document)
    else:
        has_shapes = isinstance(document, dict) and ("polygons" in document or holds_shapes(document))
    source = replace(source, document=document)
    if not has_shapes:
        return "points", source
    # an object without an extension may be of either kind: our own JSON, or GeoJSON
    return "polygons", source if said or source.suffix == ".geojson" else replace(source, format="json")


def _is_flat(data: bytes) -> bool:
    """Whether JSON is at most a list of lists: points by the million are not parsed to tell that they are points."""
    return b"{" not in data and not data.lstrip().removeprefix(b"[").lstrip().removeprefix(b"[").lstrip().startswith(
        b"["
    )


def _points(source: Source, chosen: str, columns: str | None) -> Source:
    if columns is not None and chosen not in _WITH_COLUMNS:
        raise UsageError(f"--columns is for delimited text, but {source.name} is read as {chosen}: leave it out")
    return replace(source, format=chosen) if chosen in ("npy", "npz") else _text(source, chosen)


def _text(source: Source, chosen: str) -> Source:
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
    return replace(source, data=source.data.removeprefix(_UTF8_MARK), format=chosen)
