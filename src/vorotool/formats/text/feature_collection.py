"""Collections of GeoJSON features."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, BinaryIO

from vorotool.formats.text.row_writer import Column, RowShape, write_list_rows
from vorotool.formats.text.tables import json_text


def collection_opening(crs: Any) -> bytes:
    """The text before the features of a collection, whose ``crs`` member may be None."""
    member = "" if crs is None else f'"crs":{json_text(crs)},'
    return f'{{"type":"FeatureCollection",{member}"features":['.encode()


def write_collection(
    out: BinaryIO,
    columns: Sequence[Column],
    shape: RowShape,
    *,
    crs: Any = None,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a collection, streamed: one feature a row."""
    out.write(collection_opening(crs))
    write_list_rows(out, columns, shape, precision=precision, threads=threads)
    out.write(b"]}\n")
