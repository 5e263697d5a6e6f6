"""Writing how far two shapes are apart."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, BinaryIO

from vorotool.formats.text.feature_collection import write_collection
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.formats.text.tables import json_text, write_table
from vorotool.geometry.distances.distances import Distances
from vorotool.products.formats import TABLES


def write_distances(
    out: BinaryIO,
    found: Distances,
    fmt: str,
    *,
    what: str = "distances",
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a row a distance, or the line between its two places."""
    if what == "hausdorff":
        found = replace(found, smallest=None)
    elif what == "smallest":
        found = replace(found, from_a=None, from_b=None)
    if fmt in TABLES:
        write_table(out, found.table(), fmt, precision=precision, threads=threads)
        return
    coordinates = [Column.of_places(values) for values in found.places.reshape(-1, 4).T]
    if fmt == "wkt":
        shape = RowShape(("LINESTRING (", " ", ", ", " ", ")\n"))
        write_rows(out, coordinates, shape, precision=precision, threads=threads)
        return
    opening = '{"type":"Feature","properties":{"what":'
    between = ',"distance":', '},"geometry":{"type":"LineString","coordinates":[[', ",", "],[", ","
    table: Any = found.table()
    names = [json_text(name) for name in found.rows]
    columns = [Column.of("", names), Column("", table["distance"]), *coordinates]
    shape = RowShape((opening, *between, "]]}}"), ",\n", "null")
    write_collection(out, columns, shape, crs=found.crs, y_axis=found.y_axis, precision=precision, threads=threads)
