"""Writing tables as CSV, JSON or NPZ."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import UsageError
from vorotool.geometry.table import Table

TABLE_FORMATS = ("csv", "json", "npz")
_SLICE_ROWS = 1 << 17  # text of so many rows is held in memory at a time


def write_table(out: BinaryIO, table: Table, fmt: str, *, precision: int | None = None, threads: int = 0) -> None:
    r"""Write a table; the bytes depend on nothing but the table, the format and the precision.

    What does not exist (masked, ``None``, or a number that is not finite) is an empty field in CSV, ``null``
    in JSON, and marked in a further array ``<name>_missing`` in NPZ. Truth values are 0 and 1 in CSV.

    Parameters
    ----------
    out : binary file object
        Need not be seekable.
    table : Table
        Columns of numbers, truth values, text, or mixed objects.
    fmt : {"csv", "json", "npz"}
        CSV always has a header; JSON is a list of one object a row; NPZ has one array a column.
    precision : int, optional
        Significant digits of floating-point numbers in text; by default the shortest that
        reads back the same.
    threads : int
        Threads for CSV; 0 for all.

    Raises
    ------
    UsageError
        If the format is unknown or ``precision`` is not from 1 to 17.

    Examples
    --------
    >>> import io
    >>> out = io.BytesIO()
    >>> write_table(out, Table({"label": [1, 2], "x": np.ma.array([0.5, 0], mask=[False, True])}), "csv")
    >>> out.getvalue()
    b'label,x\n1,0.5\n2,\n'
    """
    if precision is not None and not 1 <= precision <= 17:
        raise UsageError(f"--precision is {precision}: use 1 to 17 significant digits, or leave it out")
    columns = [_Column.of(name, values) for name, values in table.items()]
    if fmt == "csv":
        _write_csv(out, columns, table.rows, precision, threads)
    elif fmt == "json":
        _write_json(out, columns, table.rows, precision)
    elif fmt == "npz":
        _write_npz(out, columns)
    else:
        raise UsageError(f"-f {fmt!r} is no format of tables: use {', '.join(TABLE_FORMATS)}")


@dataclass(frozen=True)
class _Column:
    """Values (an array of bool, int64, uint64 or float64, or a list); ``missing`` marks those without one."""

    name: str
    values: NDArray[Any] | list[Any]
    missing: NDArray[np.bool_]

    @staticmethod
    def of(name: str, column: Any) -> _Column:
        mask = np.ma.getmaskarray(column) if isinstance(column, np.ma.MaskedArray) else None
        array = _as_array(np.ma.getdata(column) if mask is not None else column)
        if array is None or array.dtype.kind not in "biuf":
            values = column.tolist() if isinstance(column, np.ndarray) else list(column)
            absent = np.array([_is_absent(value) for value in values], dtype=bool)
            return _Column(name, values, absent if mask is None else absent | mask)
        array = np.ascontiguousarray(array, dtype=_WIDE.get(array.dtype.kind))
        absent = ~np.isfinite(array) if array.dtype.kind == "f" else np.zeros(len(array), dtype=bool)
        return _Column(name, array, absent if mask is None else absent | mask)

    def part(self, rows: slice) -> _Column:
        return _Column(self.name, self.values[rows], self.missing[rows])


_WIDE = {"b": np.bool_, "i": np.int64, "u": np.uint64, "f": np.float64}


def _as_array(column: Any) -> NDArray[Any] | None:
    """Give the column as a 1-D array, or None when only a list can hold it."""
    if isinstance(column, np.ndarray):
        return column if column.ndim == 1 else None
    values = list(column)
    kinds = {type(value) for value in values}
    if kinds <= {bool} or kinds <= {float} or (kinds <= {int, float} and _all_short(values)):
        return np.array(values)
    return None


def _all_short(values: list[int | float]) -> bool:
    """Whether integers survive in an array: all in int64, and none beside a float."""
    return all(type(v) is int and -(2**63) <= v < 2**63 for v in values)


def _is_absent(value: Any) -> bool:
    return value is None or (isinstance(value, float | np.floating) and not np.isfinite(value))


def _slices(rows: int) -> Iterator[slice]:
    return (slice(begin, begin + _SLICE_ROWS) for begin in range(0, rows, _SLICE_ROWS))


# ---- CSV -----------------------------------------------------------------------------------------
def _write_csv(out: BinaryIO, columns: list[_Column], rows: int, precision: int | None, threads: int) -> None:
    if not columns:
        return
    _write_csv_part(out, [_Column(c.name, [c.name], np.zeros(1, dtype=bool)) for c in columns], 0, 1)
    for rows_of_part in _slices(rows):
        _write_csv_part(out, [column.part(rows_of_part) for column in columns], precision or 0, threads)


def _write_csv_part(out: BinaryIO, columns: list[_Column], precision: int, threads: int) -> None:
    values = [_csv_values(column, precision) for column in columns]
    missing = [column.missing if column.missing.any() else None for column in columns]
    for block in _core.format_columns(values, missing, precision, threads):
        out.write(block)


def _csv_values(column: _Column, precision: int) -> NDArray[Any] | list[str]:
    if isinstance(column.values, list):
        return [_text_of(value, precision) for value in column.values]
    return column.values.astype(np.int64) if column.values.dtype.kind == "b" else column.values


def _text_of(value: Any, precision: int) -> str:
    """Text of a mixed column: numbers as in other columns, lists and objects as JSON."""
    if isinstance(value, str):
        return value
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.{precision}g}" if precision else repr(value).removesuffix(".0")
    return str(value) if type(value) is int else _json_of(value).decode()


# ---- JSON ----------------------------------------------------------------------------------------
def _write_json(out: BinaryIO, columns: list[_Column], rows: int, precision: int | None) -> None:
    names = [column.name for column in columns]
    out.write(b"[")
    separator = b"\n"
    for rows_of_part in _slices(rows):
        parts = [_json_values(column.part(rows_of_part), precision) for column in columns]
        lines = [_json_of(dict(zip(names, row, strict=True))) for row in zip(*parts, strict=True)]
        out.write(separator + b",\n".join(lines))
        separator = b",\n"
    out.write(b"\n]\n" if rows else b"]\n")


def _json_values(column: _Column, precision: int | None) -> list[Any]:
    values: list[Any] = column.values if isinstance(column.values, list) else column.values.tolist()
    if precision is not None:
        values = [float(f"{v:.{precision}g}") if type(v) is float else v for v in values]
    if column.missing.any():
        values = [None if absent else v for v, absent in zip(values, column.missing.tolist(), strict=True)]
    return values


def _json_of(value: Any) -> bytes:
    import orjson

    return orjson.dumps(value, default=str, option=orjson.OPT_SERIALIZE_NUMPY | orjson.OPT_NON_STR_KEYS)


# ---- NPZ -----------------------------------------------------------------------------------------
class _Stream:
    """A file without a position: the archive is then the same for pipes and for files."""

    def __init__(self, out: BinaryIO) -> None:
        self._out = out

    def write(self, data: bytes) -> int:
        return self._out.write(data)

    def flush(self) -> None:
        self._out.flush()


def _write_npz(out: BinaryIO, columns: list[_Column]) -> None:
    with zipfile.ZipFile(_Stream(out), "w", zipfile.ZIP_STORED) as archive:  # type: ignore[call-overload]
        for column in columns:
            _write_array(archive, column.name, _npz_values(column))
            if column.missing.any():
                _write_array(archive, f"{column.name}_missing", column.missing)


def _npz_values(column: _Column) -> NDArray[Any]:
    """Give an array without objects; what is missing is zero or empty."""
    if not isinstance(column.values, list):
        return np.where(column.missing, np.zeros((), column.values.dtype), column.values)
    pairs = zip(column.values, column.missing.tolist(), strict=True)
    return np.array(["" if absent else _text_of(value, 0) for value, absent in pairs], dtype=np.str_)


def _write_array(archive: zipfile.ZipFile, name: str, array: NDArray[Any]) -> None:
    entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
    entry.create_system = 3  # what the file says of the machine that wrote it: always the same
    entry.external_attr = 0o644 << 16
    with archive.open(entry, "w", force_zip64=True) as member:
        np.lib.format.write_array(member, array, allow_pickle=False)
