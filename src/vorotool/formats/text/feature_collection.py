"""Collections of GeoJSON features."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, BinaryIO

from vorotool.formats.text.row_writer import Column, RowShape, TypedOutput, write_rows
from vorotool.formats.text.tables import json_text
from vorotool.numeric.length_units import ascii_unit, is_known
from vorotool.types.axis import MEMBER, UP, YAxis

_UNIT: ContextVar[str | None] = ContextVar("unit of coordinates", default=None)


@contextmanager
def unit_member(unit: str | None) -> Iterator[None]:
    """State the unit of coordinates in collections that are written within, in ASCII, where no system states it."""
    token = _UNIT.set(None if unit is None else ascii_unit(unit))
    try:
        yield
    finally:
        _UNIT.reset(token)


def collection_opening(crs: Any, y_axis: YAxis) -> bytes:
    """Return the text before the features of a collection, whose ``crs`` member may be None."""
    unit = _UNIT.get() if crs is None else None
    member = "" if crs is None else f'"crs":{json_text(crs)},'
    member += "" if unit is None else f'"unit":{json_text(unit)},'
    member += "" if y_axis == UP else f'"{MEMBER}":"{y_axis}",'
    return f'{{"type":"FeatureCollection",{member}"features":['.encode()


def stated_unit(document: Mapping[str, Any]) -> str | None:
    """Return the unit of length that the ``unit`` member of a collection states, if it is one."""
    unit = document.get("unit")
    return unit if isinstance(unit, str) and is_known(unit) else None


def write_collection(
    out: BinaryIO,
    blocks: Sequence[tuple[Sequence[Column], RowShape]],
    *,
    crs: Any,
    y_axis: YAxis,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a collection, streamed: one feature a row, of blocks of rows with the same members each."""
    out.write(collection_opening(crs, y_axis))
    is_first = True
    for columns, shape in blocks:
        has_rows = len(columns[0].values) > 0
        if isinstance(out, TypedOutput) and (has_rows or len(blocks) == 1):
            out.announce(columns)
        if has_rows:
            out.write(b"\n" if is_first else b",\n")
            is_first = False
            write_rows(out, columns, shape, precision=precision, threads=threads)
    out.write(b"]}\n" if is_first else b"\n]}\n")
