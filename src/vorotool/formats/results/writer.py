"""Writing any value: its rows as a table, its features as GeoJSON or WKT, or its numbers as an array."""

from __future__ import annotations

from typing import Any, BinaryIO

from vorotool.formats.text.tables import write_table
from vorotool.products.formats import TABLES, resolved
from vorotool.types.features import Areas, features_of, matrix_of, rows_of


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
        resolved("formats.io.arrays:write_array")(out, matrix_of(value, what))
    elif fmt in TABLES:
        rows = rows_of(value, what, flatten=flatten)
        if isinstance(rows.geometry, Areas):
            rows = resolved("formats.results.geometry_text:with_shapes")(rows)
        write_table(out, rows.table(), fmt, precision=precision, threads=threads)
    else:
        features = features_of(value, what, flatten=flatten)
        write = resolved("formats.results.features:write_features")
        write(out, value, features, fmt, precision=precision, threads=threads)
