"""Features of any value as GeoJSON and as well-known text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, BinaryIO

import numpy as np

from vorotool.formats.polygons.geojson import feature_columns
from vorotool.formats.polygons.wkt import write_wkt
from vorotool.formats.polygons.writer import write_polygons
from vorotool.formats.results.geometry_text import geometry_text
from vorotool.formats.text.feature_collection import write_collection
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.formats.text.tables import json_column, json_text, object_shape, placed_column
from vorotool.formats.written.polygons import written_polygons
from vorotool.types.features import Mixture, Rows, features_of, parts_of
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.table import Lookup


def write_shapes(out: BinaryIO, value: Any, fmt: str, *, what: str, flatten: float | None = None) -> None:
    """Write the features of a value, which are polygons, as these."""
    features = features_of(value, what, flatten=flatten)
    assert isinstance(features, Rows)
    assert isinstance(features.geometry, PolygonSet)
    write_polygons(out, features.geometry, fmt)


def write_features(
    out: BinaryIO,
    value: Any,
    features: Rows | Mixture,
    fmt: str,
    *,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write features as GeoJSON, or their geometry as well-known text, one a line."""
    if fmt == "wkt":
        for rows in parts_of(features):
            _write_wkt(out, rows, threads)
    else:
        blocks = [_features(rows, precision) for rows in parts_of(features)]
        write_collection(out, blocks, crs=value.crs, y_axis=value.y_axis, precision=precision, threads=threads)


def _write_wkt(out: BinaryIO, rows: Rows, threads: int) -> None:
    if isinstance(rows.geometry, PolygonSet):
        write_wkt(out, written_polygons(rows.geometry))
        return
    columns, (opening, *between, closing), missing = geometry_text(rows, "wkt")
    write_rows(out, columns, RowShape((opening, *between, f"{closing}\n"), "", missing), threads=threads)


def _features(rows: Rows, precision: int | None) -> tuple[Sequence[Column], RowShape]:
    if isinstance(rows.geometry, PolygonSet):
        return feature_columns(written_polygons(rows.geometry))
    table = rows.table(is_file=True, has_ids=False).stored()
    columns = [json_column(placed_column(Column.of(name, column)), precision) for name, column in table.items()]
    geometry, (before, *between, closing), _ = geometry_text(rows, "geojson")
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
