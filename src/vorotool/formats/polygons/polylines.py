"""Polylines of polygons as GeoJSON and WKT."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.text.feature_collection import collection_opening
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.formats.text.tables import json_text
from vorotool.geometry.arguments.tables import listed
from vorotool.geometry.identity import names_of, with_columns_of
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.ragged import with_length
from vorotool.geometry.table import Lookup


class Wording(NamedTuple):
    """The text around the coordinates of polylines."""

    before: bytes
    openings: Sequence[str]
    """Of each polyline."""
    comma: str
    space: str
    """Between points, and between x and y."""
    closing: str
    """Of a polyline, with what parts it from the next one."""
    after: bytes
    begin: str
    """With what openings end."""
    empty: str
    """What stands for that and for the closing where all points of a line are one place."""


GEOJSON_LINE = ',"geometry":{"type":"LineString","coordinates":[[', ',"geometry":null},\n'
WKT_LINE = "LINESTRING (", "LINESTRING EMPTY\n"


def geojson_wording(
    polygons: PolygonSet, polygon: NDArray[np.integer], own: Mapping[str, Any], *, is_part: bool = False
) -> Wording:
    """One feature a polyline, with the id and the columns of its polygon; see `with_columns_of`."""
    names = names_of(polygons, polygon)
    ids = names.pop("id")[:].tolist()
    table = with_columns_of({**names, **own}, polygons, polygon, is_part=is_part)
    openings = []
    for name, *values in zip(ids, *(listed(column) for column in table.values()), strict=True):
        named = "" if name is None else f'"id":{json_text(name)},'
        described = dict(zip(table, values, strict=True))
        openings.append(f'{{"type":"Feature",{named}"properties":{json_text(described)}{GEOJSON_LINE[0]}')
    opening = collection_opening(polygons.crs, polygons.y_axis) + b"\n"
    return Wording(opening, openings, "],[", ",", "]]}},\n", b"]}\n", *GEOJSON_LINE)


def wkt_wording(count: int) -> Wording:
    """One LINESTRING a line of text."""
    return Wording(b"", ["LINESTRING ("] * count, ", ", " ", ")\n", b"", *WKT_LINE)


def write_polylines(
    out: BinaryIO,
    points: NDArray[np.float64],
    start: NDArray[np.int64],
    wording: Wording,
    *,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write polylines; one whose points all are one place has no geometry."""
    points, start, has_length = with_length(points, np.append(start, len(points)))
    texts, waiting = [wording.comma], ""
    for opening, is_line in zip(wording.openings, has_length.tolist(), strict=True):
        if is_line:
            texts.append((wording.closing if len(texts) > 1 else "") + waiting + opening)
            waiting = ""
        else:
            waiting += opening.removesuffix(wording.begin) + wording.empty
    token = np.zeros(len(points), dtype=np.int32)  # what stands before each point
    token[start[:-1]] = np.arange(1, len(start))
    out.write(wording.before)
    if len(points):
        columns = [Column("", Lookup(texts, token)), *map(Column.of_places, points.T)]
        write_rows(out, columns, RowShape(("", "", wording.space, "")), precision=precision, threads=threads)
    last = (wording.closing if len(points) else "") + waiting
    if last:
        out.write(last.rstrip(",\n").encode() + b"\n")
    out.write(wording.after)
