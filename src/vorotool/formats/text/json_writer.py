"""Lists of JSON objects of one shape, streamed from columns: one object a line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.text.row_writer import Column, RowShape, write_list_rows
from vorotool.geometry.skeleton.skeleton import SiteTable
from vorotool.geometry.table import Lookup

SITE_KINDS = ("vertex", "edge")


def write_list(
    out: BinaryIO,
    name: str,
    columns: Sequence[Column],
    around: tuple[str, ...],
    *,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a comma and a member of an object that is a list."""
    out.write(f',\n"{name}":['.encode())
    write_list_rows(out, columns, RowShape(around, ",\n", ""), precision=precision, threads=threads)
    out.write(b"]")


def integers(values: NDArray[Any]) -> Column:
    """Column of integers."""
    return Column("", np.ascontiguousarray(values, dtype=np.int64))


def choice(names: Any, index: NDArray[Any]) -> Column:
    """Column of texts by their number."""
    return Column("", Lookup(list(names), np.ascontiguousarray(index, dtype=np.int32)))


def number_or_null(values: NDArray[np.integer], count: int) -> Column:
    """Column of numbers below a count; -1 is null."""
    return choice([*map(str, range(count)), "null"], values % (count + 1))


def optional_pair(exists: NDArray[np.bool_], pair: Sequence[Any]) -> list[Column]:
    """Columns whose texts together are ``[first,second]``, or ``null``; no text stands between them."""
    first, second = (Column("", values, ~exists) for values in pair)
    return [choice(["null", "["], exists), first, choice(["", ","], exists), second, choice(["", "]"], exists)]


def write_sites(out: BinaryIO, table: SiteTable, *, threads: int = 0) -> None:
    """Write a comma and ``"sites": […]``; outside of features that overlap they tell ``from`` where ``to`` where."""
    source = [integers(values).values for values in (table.source_ring, table.source_index)]
    columns = [
        choice(SITE_KINDS, table.kind),
        *(integers(values) for values in (table.polygon, table.ring, table.index)),
        *optional_pair(table.source_ring >= 0, source),
    ]
    around = ['{"kind":"', '","polygon":', ',"ring":', ',"index":', ',"source":', "", "", "", "", "}"]
    if table.ends is not None:
        exists = ~np.isnan(table.ends[:, 0, 0])
        around.pop()
        for end, name in enumerate(("from", "to")):
            columns += optional_pair(exists, list(np.ascontiguousarray(table.ends[:, end].T)))
            around += [f',"{name}":', "", "", "", ""]
        around.append("}")
    write_list(out, "sites", columns, tuple(around), threads=threads)
