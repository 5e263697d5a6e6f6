"""Columns to text, streamed: slices of rows are formatted in parallel while earlier ones are written."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, BinaryIO, NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.frozen import frozen
from vorotool.numeric.checks import is_masked_array
from vorotool.numeric.coordinates import current_written, on_grid
from vorotool.numeric.parallel import in_order
from vorotool.types.table import Computed, Lookup

SLICE_ROWS = 1 << 14
"""Rows whose text is made at a time: some 2 MB."""

_ENDS = ("", "0", "1", "_a", "_b", "_1", "_2", "_3")
PLACES = frozenset(["z", "cx", "cy", "bbox_x", "bbox_y", *(f"{axis}{end}" for axis in "xy" for end in _ENDS)])
"""Columns of coordinates, which are rounded to the decimals of the file."""

_WIDE = {"b": np.bool_, "i": np.int64, "u": np.uint64, "f": np.float64}


class RowShape(NamedTuple):
    """The text of a row: ``around`` its fields (one more than there are), ``separator`` between rows."""

    around: tuple[str, ...]
    separator: str = ""
    missing: str = ""


@frozen
class Column:
    """Values (an array of bool, int64, uint64 or float64, or a list; or lazy), and which of them are missing."""

    name: str
    values: NDArray[Any] | list[Any] | Lookup | Computed
    missing: NDArray[np.bool_] | None = None
    is_place: bool = False
    """Of coordinates: they have decimals, and not digits."""

    @staticmethod
    def of_places(values: NDArray[np.float64], index: NDArray[np.int32] | None = None, name: str = "") -> Column:
        """Make a column of coordinates, those at an index of each row if there is one."""
        on = on_grid(np.ascontiguousarray(values))
        return Column(name, on if index is None else Lookup(on, index), is_place=True)

    @staticmethod
    def of(name: str, column: Any) -> Column:
        """Widen an array, find out what is missing, and round coordinates; what no array holds is a list."""
        is_place = name.removeprefix("voro_") in PLACES
        if is_place:
            current_written().has_places = True
        if isinstance(column, Computed) or (isinstance(column, Lookup) and isinstance(column.values, list)):
            return Column(name, column)
        if isinstance(column, Lookup):
            found: NDArray[Any] = column.values  # type: ignore[assignment]  # lists are gone
            wide: NDArray[Any] = np.ascontiguousarray(found, dtype=_WIDE[found.dtype.kind])
            is_place = is_place and wide.dtype.kind == "f"
            return Column(name, Lookup(on_grid(wide) if is_place else wide, column.index), is_place=is_place)
        mask = np.ma.getmaskarray(column) if is_masked_array(column) else None
        array = _as_array(np.ma.getdata(column) if mask is not None else column)
        values: NDArray[Any] | list[Any]
        if array is None or array.dtype.kind not in "biuf":
            values = column.tolist() if isinstance(column, np.ndarray) else list(column)
            absent = np.array([_is_absent(value) for value in values], dtype=bool)
            is_place = False
        else:
            wide = np.ascontiguousarray(array, dtype=_WIDE[array.dtype.kind])
            is_number = wide.dtype.kind == "f"
            absent = ~np.isfinite(wide) if is_number else np.zeros(len(wide), dtype=bool)
            is_place = is_place and is_number
            values = on_grid(wide) if is_place else wide
        absent = absent if mask is None else absent | mask
        return Column(name, values, absent if absent.any() else None, is_place)

    def mapped(self, text: Callable[[Any], str]) -> Column:
        """Make texts of the values of a list; arrays stay."""
        values = self.values
        if isinstance(values, Lookup) and isinstance(values.values, list):
            return Column(self.name, Lookup([text(value) for value in values.values], values.index))
        return Column(self.name, [text(value) for value in values], self.missing) if isinstance(values, list) else self

    def part(self, rows: slice, texts: Mapping[int, _core.text.NumberTexts]) -> tuple[Any, NDArray[np.bool_] | None]:
        """Give some of the rows, and what is missing of them, as the core takes them; others are computed now."""
        values, missing = self.values, None if self.missing is None else self.missing[rows]
        if isinstance(values, Lookup):
            return (texts.get(id(values.values), values.values), values.index[rows]), None
        part = values[rows]
        return part.astype(np.int64) if isinstance(part, np.ndarray) and part.dtype.kind == "b" else part, missing


def _as_array(column: Any) -> NDArray[Any] | None:
    """Give the column as a 1-D array, or None when only a list can hold it."""
    if isinstance(column, np.ndarray):
        return column if column.ndim == 1 else None
    values = list(column)
    kinds = {type(value) for value in values}
    if kinds <= {bool} or kinds <= {float} or (kinds == {int} and -(2**63) <= min(values) <= max(values) < 2**63):
        return np.array(values)
    return None


def _is_absent(value: Any) -> bool:
    return value is None or (isinstance(value, float | np.floating) and not np.isfinite(value))


@runtime_checkable
class TypedOutput(Protocol):
    """A file that takes text and is told of which types its columns are."""

    def announce(self, columns: Sequence[Column]) -> None:
        """Learn of the columns that are about to be written."""


def write_rows(
    out: BinaryIO,
    columns: Sequence[Column],
    shape: RowShape | None = None,
    *,
    by_tabs: bool = False,
) -> None:
    """Write the text of rows; the bytes do not depend on the number of threads."""
    if not columns:
        return
    threads, digits = current_written().how.threads, current_written().how.precision
    each_digits = [0 if column.is_place else digits for column in columns]
    looked_up = {  # by the identity of what lookups show: each array once
        id(column.values.values): (column.values.values, n)
        for column, n in zip(columns, each_digits, strict=True)
        if isinstance(column.values, Lookup)
    }
    texts = {
        key: _core.text.NumberTexts(values, n, threads)
        for key, (values, n) in looked_up.items()
        if isinstance(values, np.ndarray) and values.dtype.kind == "f"
    }
    rows = len(columns[0].values)

    def formatted(begin: int) -> list[bytes]:
        part = slice(begin, min(begin + SLICE_ROWS, rows))
        values, missing = zip(*(column.part(part, texts) for column in columns), strict=True)
        return _core.text.format_rows(list(values), list(missing), each_digits, 1, shape, by_tabs)

    between = b"" if shape is None else shape.separator.encode()
    parts = in_order(formatted, range(0, rows, SLICE_ROWS), threads if rows > SLICE_ROWS else 1)
    for number, blocks in enumerate(parts):
        if number and between:
            out.write(between)
        for block in blocks:
            out.write(block)


def write_list_rows(out: BinaryIO, columns: Sequence[Column], shape: RowShape) -> None:
    """Write the rows of a list between its brackets: on lines of their own, if there are any; see `write_rows`."""
    if isinstance(out, TypedOutput):
        out.announce(columns)
    if columns and len(columns[0].values):
        out.write(b"\n")
        write_rows(out, columns, shape)
        out.write(b"\n")


def coordinate_text(value: float) -> str:
    """Return the text of a coordinate."""
    return repr(value).removesuffix(".0")
