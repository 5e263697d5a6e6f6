"""Writing any value: its rows as a table, its features as GeoJSON or WKT, or its numbers as an array."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.formats.io.npy_arrays import write_array
from vorotool.formats.polygons.geojson import feature_columns
from vorotool.formats.polygons.wkt import write_wkt
from vorotool.formats.polygons.writer import write_polygons
from vorotool.formats.text.feature_collection import write_collection
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.formats.text.tables import json_column, json_text, object_shape, placed_column, write_table
from vorotool.formats.written.polygons import written_polygons
from vorotool.formats.written.report import report_emptied
from vorotool.formats.written.rings import written_rings
from vorotool.numeric.coordinate_grid import current_decimals, on_grid
from vorotool.numeric.ragged import Nesting
from vorotool.products.formats import TABLES
from vorotool.types.features import Areas, Corners, Lines, Mixture, Rows, features_of, matrix_of, parts_of, rows_of
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.table import Computed, Lookup


def write_value(
    out: BinaryIO,
    value: Any,
    fmt: str,
    *,
    what: str | None = None,
    flatten: float | None = None,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a value; the bytes depend on nothing but the value and the options that concern numbers."""
    if fmt == "npy":
        write_array(out, matrix_of(value, what))
    elif fmt in TABLES:
        rows = rows_of(value, what, flatten=flatten)
        table = rows.table() if not isinstance(rows.geometry, Areas) else _with_shapes(rows).table()
        write_table(out, table, fmt, precision=precision, threads=threads)
    elif fmt == "wkt":
        for rows in parts_of(features_of(value, what, flatten=flatten)):
            _write_wkt(out, rows, threads)
    else:
        features = features_of(value, what, flatten=flatten)
        _write_geojson(out, value, features, precision, threads)


def write_shapes(out: BinaryIO, value: Any, fmt: str, *, what: str, flatten: float | None = None) -> None:
    """Write the features of a value, which are polygons, as these."""
    features = features_of(value, what, flatten=flatten)
    assert isinstance(features, Rows)
    assert isinstance(features.geometry, PolygonSet)
    write_polygons(out, features.geometry, fmt)


# ---- geometry as text ----------------------------------------------------------------------------
class _Text(NamedTuple):
    """The columns that geometry is made of, what stands around them, and what stands for none."""

    columns: list[Column]
    around: tuple[str, ...]
    missing: str


_KINDS = {1: "Point", 2: "LineString", 3: "Polygon"}
"""By the number of corners."""


def _of_corners(geometry: Corners, style: str) -> _Text:
    x, y = _placed(geometry.xy)
    index = geometry.corners.astype(np.int32, copy=False)
    corners = [*index.T, *([index[:, 0]] if index.shape[1] == 3 else [])]
    columns = [Column("", Lookup(values, corner), is_place=True) for corner in corners for values in (x, y)]
    kind, depth = _KINDS[index.shape[1]], index.shape[1]
    if style == "wkt":
        opening, between, point, closing = (
            f"{kind.upper()} {'(' * max(depth - 1, 1)}",
            " ",
            ", ",
            ")" * max(depth - 1, 1),
        )
    else:
        opening, between, point = f'{{"type":"{kind}","coordinates":{"[" * depth}', ",", "],["
        closing = "]" * depth + "}"
    betweens = [point if k % 2 else between for k in range(len(columns) - 1)]
    return _Text(columns, (opening, *betweens, closing), "")


def _placed(xy: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Round x and y to the decimals of the file."""
    return [on_grid(np.ascontiguousarray(values)) for values in xy.T]


def _of_lines(geometry: Lines, style: str) -> _Text:
    return _Text([line_column(geometry, style)], ("", ""), "LINESTRING EMPTY")


def line_column(geometry: Lines, style: str) -> Column:
    """Give the column of the text of lines."""
    xy, starts = np.stack(_placed(geometry.xy), axis=1), geometry.starts.astype(np.int64)
    every = np.arange(len(starts), dtype=np.int64)
    return Column("", _texts(xy, Nesting(starts, every, every), f"{style}_lines"))


def _of_areas(geometry: Areas, style: str) -> _Text:
    return _Text([Column("", written_areas(geometry).texts(style))], ("", ""), "POLYGON EMPTY")


class WrittenAreas(NamedTuple):
    """Areas as they are written: rounded to the decimals of the file, where they still share their borders."""

    points: NDArray[np.float64]
    nesting: Nesting

    def texts(self, style: str, rows: NDArray[np.int64] | None = None) -> Computed:
        """The column of their text, or that of other rows of polygons."""
        return _texts(self.points, self.nesting if rows is None else self.nesting._replace(cells=rows), style)


def written_areas(geometry: Areas) -> WrittenAreas:
    """Round areas, and say which have become empty."""
    made = written_rings(
        geometry.xy, geometry.nesting, decimals=current_decimals(), is_coverage=True, in_box=geometry.in_box
    )
    report_emptied(made.emptied, "cell")
    return WrittenAreas(made.points, made.nesting)


def _texts(xy: NDArray[np.float64], nesting: Nesting, style: str) -> Computed:
    """Give a column of the text of rows of rings."""
    rings, polygons, rows = nesting

    def texts(part: slice) -> Any:
        begin, end, _ = part.indices(len(rows) - 1)
        return _core.text.PolygonTexts(xy, rings, polygons, rows[begin : end + 1], _core.text.PolygonStyle[style])

    return Computed(texts, len(rows) - 1)


def _geometry_text(rows: Rows, style: str) -> _Text:
    if isinstance(rows.geometry, Corners):
        return _of_corners(rows.geometry, style)
    if isinstance(rows.geometry, Lines):
        return _of_lines(rows.geometry, style)
    assert isinstance(rows.geometry, Areas)
    return _of_areas(rows.geometry, style)


def _with_shapes(rows: Rows) -> Rows:
    """Add a column with the geometry as well-known text."""
    (shapes,) = _geometry_text(rows, "wkt").columns
    return rows.with_columns(wkt=shapes.values)


# ---- formats -------------------------------------------------------------------------------------
def _write_wkt(out: BinaryIO, rows: Rows, threads: int) -> None:
    if isinstance(rows.geometry, PolygonSet):
        write_wkt(out, written_polygons(rows.geometry))
        return
    columns, (opening, *between, closing), missing = _geometry_text(rows, "wkt")
    write_rows(out, columns, RowShape((opening, *between, f"{closing}\n"), "", missing), threads=threads)


def _write_geojson(out: BinaryIO, value: Any, features: Rows | Mixture, precision: int | None, threads: int) -> None:
    """Write one feature a row."""
    blocks = [_features(rows, precision) for rows in parts_of(features)]
    write_collection(out, blocks, crs=value.crs, y_axis=value.y_axis, precision=precision, threads=threads)


def _features(rows: Rows, precision: int | None) -> tuple[Sequence[Column], RowShape]:
    if isinstance(rows.geometry, PolygonSet):
        return feature_columns(written_polygons(rows.geometry))
    table = rows.table(is_file=True, has_ids=False).stored()
    columns = [json_column(placed_column(Column.of(name, column)), precision) for name, column in table.items()]
    geometry, (before, *between, closing), _ = _geometry_text(rows, "geojson")
    ids, opening, after = _ids(rows)
    first, *others = object_shape([column.name for column in columns], "", f',"geometry":{before}').around
    properties = f'{after}"properties":{first}', *others
    around = (opening, *properties) if ids else (opening + properties[0], *others)
    return [*ids, *columns, *geometry], RowShape((*around, *between, f"{closing}}}"), ",\n", "null")


def _ids(rows: Rows) -> tuple[list[Column], str, str]:
    """Give the column with the member ``id`` of features, if there is one, and what stands before and after it."""
    names, opening = rows.names, '{"type":"Feature",'
    if names is None:
        return [], opening, ""
    if isinstance(names, Lookup) and isinstance(names.values, list):
        return [Column("id", Lookup([_id(value) for value in names.values], names.index))], opening, ""
    column = Column.of("id", names)
    if isinstance(column.values, np.ndarray) and column.missing is None:
        return [column], f'{opening}"id":', ","
    return [Column("id", [_id(value) for value in names])], opening, ""


def _id(value: Any) -> str:
    return "" if value is None else f'"id":{json_text(value)},'
