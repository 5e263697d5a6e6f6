"""Writing places along skeletons, and the segments between their feet."""

from __future__ import annotations

from typing import BinaryIO

from vorotool.formats.io.npy_arrays import write_array
from vorotool.formats.text.feature_collection import write_collection
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.formats.text.tables import json_column, json_text, object_shape, write_table
from vorotool.geometry.identity import names_of, part_table
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.geometry.table import Lookup
from vorotool.products.formats import TABLES


def write_skeleton_points(
    out: BinaryIO,
    points: SkeletonPoints,
    fmt: str,
    *,
    what: str = "points",
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a row or a feature a point, or a transect: the segment between its two feet, none in a corner."""
    points = (points.transects() if what == "transects" else points).as_given
    if fmt == "npy":
        write_array(out, points.xy)
        return
    if fmt in TABLES:
        write_table(out, points.table(), fmt, precision=precision, threads=threads)
        return
    places = points.xy if what == "points" else points.feet.reshape(-1, 4)
    coordinates = [Column.of_places(values) for values in places.T]
    if fmt == "wkt":
        around = ("POINT (", " ", ")\n") if what == "points" else ("LINESTRING (", " ", ", ", " ", ")\n")
        write_rows(out, coordinates, RowShape(around), precision=precision, threads=threads)
    else:
        _write_geojson(out, points, coordinates, precision, threads)


def _write_geojson(
    out: BinaryIO, points: SkeletonPoints, coordinates: list[Column], precision: int | None, threads: int
) -> None:
    polygons = points.skeleton.polygons
    ids = names_of(polygons, points.polygon)["id"]
    table = {name: column for name, column in points.columns().items() if name not in _LEFT_OUT}
    described = part_table(table, polygons, points.polygon).stored()
    columns = [json_column(Column.of(name, values), precision) for name, values in described.items()]
    texts = ["" if value is None else f'"id":{json_text(value)},' for value in ids.values]
    between: tuple[str, ...] = (",",)
    kind, after = "Point", "]}}"
    if len(coordinates) > 2:
        kind, between, after = "LineString", (",", "],[", ","), "]]}}"
    opening = f',"geometry":{{"type":"{kind}","coordinates":{"[" * (len(coordinates) // 2)}'
    around = object_shape([column.name for column in columns], '"properties":', opening).around
    shape = RowShape(('{"type":"Feature",', *around, *between, after), ",\n", "null")
    rows = [Column("id", Lookup(texts, ids.index)), *columns, *coordinates]
    write_collection(out, rows, shape, crs=polygons.crs, y_axis=polygons.y_axis, precision=precision, threads=threads)


_LEFT_OUT = frozenset(["id", "arc", "x", "y", "x_a", "y_a", "x_b", "y_b"])
"""Columns of the table that features do not have: the id is a member of its own, and geometry has the places."""
