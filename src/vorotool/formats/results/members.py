"""Lists of objects of one shape: as JSON, one object a line, and as arrays, one for each member."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.text.row_writer import Column, RowShape, write_list_rows
from vorotool.formats.text.tables import json_text
from vorotool.types.skeleton.skeleton import SiteTable
from vorotool.types.table import Lookup

SITE_KINDS = ("vertex", "edge")


class Member(NamedTuple):
    """A member that all objects of a list have."""

    name: str
    columns: Sequence[tuple[str, Column]]
    """The values in JSON, with the text before each."""
    after: str
    """The text behind the last one."""
    arrays: dict[str, NDArray[Any]]
    """The same as arrays, by their names."""


def numbers(name: str, values: NDArray[np.floating]) -> Member:
    """Make a member of numbers; NaN is null."""
    values = np.ascontiguousarray(values)
    missing = np.isnan(values)
    columns = [("", Column("", values))]
    if missing.any():
        columns = [("", _texts(["", "null"], missing)), ("", Column("", values, missing))]
    return Member(name, columns, "", {name: values})


def indices(name: str, values: NDArray[np.integer], none_of: int | None = None) -> Member:
    """Make a member of integers; of indices below a count, -1 is null."""
    return Member(name, [("", _index_column(values, none_of))], "", {name: values})


def choices(name: str, names: Sequence[str | bool], values: NDArray[Any]) -> Member:
    """Make a member of names, or of truth values, by their numbers; -1 is null."""
    texts = [*map(json_text, names), "null"]
    chosen = np.where(values < 0, len(names), values)
    return Member(name, [("", _texts(texts, chosen))], "", {name: values.astype(np.int8)})


def truths(name: str, values: NDArray[np.bool_]) -> Member:
    """Make a member of truth values."""
    return Member(name, [("", _texts(["false", "true"], values))], "", {name: values})


def places(name: str, xy: NDArray[np.floating], exists: NDArray[np.bool_] | None = None) -> Member:
    """Make a member of pairs ``[x, y]``, null where they do not exist."""
    pair = [np.ascontiguousarray(values) for values in xy.T]
    made = {f"{name}_{axis}": values for axis, values in zip("xy", pair, strict=True)}
    return _pair(name, [Column("", values) for values in pair], exists, made)


def index_pairs(
    name: str,
    pair: NDArray[np.integer],
    parts: tuple[str, str],
    exists: NDArray[np.bool_] | None = None,
    none_of: int | None = None,
) -> Member:
    """Make a member of pairs of integers, whose arrays are named; null where they do not exist."""
    columns = [_index_column(values, none_of) for values in pair.T]
    return _pair(name, columns, exists, dict(zip(parts, pair.T, strict=True)))


def _pair(
    name: str, pair: Sequence[Column], exists: NDArray[np.bool_] | None, arrays: dict[str, NDArray[Any]]
) -> Member:
    first, second = pair
    if exists is None:
        return Member(name, [("[", first), (",", second)], "]", arrays)
    given = (Column("", column.values, ~exists) for column in pair)
    parts = [_texts(["null", "["], exists), next(given), _texts(["", ","], exists), next(given)]
    return Member(name, [("", column) for column in (*parts, _texts(["", "]"], exists))], "", arrays)


def _index_column(values: NDArray[np.integer], none_of: int | None) -> Column:
    if none_of is None:
        return Column("", np.ascontiguousarray(values, dtype=np.int64))
    return _texts([*map(str, range(none_of)), "null"], values % (none_of + 1))


def _texts(names: list[str], index: NDArray[Any]) -> Column:
    """Make a column of texts by their numbers."""
    return Column("", Lookup(names, np.ascontiguousarray(index, dtype=np.int32)))


def write_list(
    out: BinaryIO, name: str, members: Sequence[Member], *, precision: int | None = None, threads: int = 0
) -> None:
    """Write a comma and a member of a document that is a list of objects."""
    around, columns, text = [], [], "{"
    for number, member in enumerate(members):
        text += f'{"," if number else ""}"{member.name}":'
        for before, column in member.columns:
            around.append(text + before)
            columns.append(column)
            text = ""
        text = member.after
    shape = RowShape((*around, f"{text}}}"), ",\n", "")
    out.write(f',\n"{name}":['.encode())
    write_list_rows(out, columns, shape, precision=precision, threads=threads)
    out.write(b"]")


def arrays_of(prefix: str, members: Sequence[Member]) -> dict[str, NDArray[Any]]:
    """Return the arrays of all members."""
    return {f"{prefix}_{name}": values for member in members for name, values in member.arrays.items()}


def site_members(table: SiteTable) -> list[Member]:
    """Return the members of sites; outside of features that overlap they have the ends ``from`` and ``to``."""
    source = np.stack([table.source_ring, table.source_index], axis=1)
    made = [
        choices("kind", SITE_KINDS, table.kind),
        *(indices(name, getattr(table, name)) for name in ("polygon", "ring", "index")),
        index_pairs("source", source, ("source_ring", "source_index"), table.source_ring >= 0),
    ]
    if table.ends is not None:
        exists = ~np.isnan(table.ends[:, 0, 0])
        made += [places(name, table.ends[:, end], exists) for end, name in enumerate(("from", "to"))]
    return made
