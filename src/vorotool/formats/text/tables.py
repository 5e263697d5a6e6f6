"""Writing tables as CSV, TSV, JSON or NPZ, collections of GeoJSON features, and any value as one of these."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from datetime import date
from functools import partial
from types import TracebackType
from typing import TYPE_CHECKING, Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.text.row_writer import (
    Column,
    RowShape,
    TypedOutput,
    write_list_rows,
    write_rows,
)
from vorotool.numeric.coordinates import current_written
from vorotool.numeric.length_units import is_known
from vorotool.numeric.numbers import NumberText
from vorotool.numeric.parallel import in_order
from vorotool.products.formats import TABLES, resolved
from vorotool.types.features import Areas, features_of, matrix_of, rows_of
from vorotool.types.fields import MEMBER, UP, YAxis
from vorotool.types.table import Computed, Lookup, Table

if TYPE_CHECKING:
    import zipfile

_SLICE_VALUES = 1 << 16  # numbers of an array that are gathered and written at a time


def write_table(out: BinaryIO, table: Table, fmt: str) -> None:
    """Write a table; the bytes depend on nothing but the table, the format and the precision."""
    unit, stored = current_written().how.unit, table.stored()
    if unit is not None and stored:
        stored |= _unit_column(table, unit)
    if fmt == "npz":
        write_npz(out, stored)
        return
    columns = [Column.of(name, values) for name, values in stored.items()]
    if fmt == "json":
        out.write(b"[")
        texts = [json_column(column) for column in columns]
        write_list_rows(out, texts, object_shape([*stored]))
        out.write(b"]\n")
    else:
        text = partial(_text_of, precision=current_written().how.precision, is_safe=current_written().how.is_safe)
        write_rows(out, [Column(name, [text(name)]) for name in stored], by_tabs=fmt == "tsv")
        texts = [column.mapped(text) for column in columns]
        write_rows(out, texts, by_tabs=fmt == "tsv")


# ---- units ---------------------------------------------------------------------------------------
def _unit_column(table: Table, unit: str) -> dict[str, Any]:
    """Give the column that names the unit of each row, by its name."""
    column: Lookup | list[str | None] = Lookup([unit], np.zeros(table.rows, dtype=np.int32))
    if next(iter(table)) == "measure":  # a row is a measure: lengths, areas, and numbers without a unit
        from vorotool.types.mesh.tables import unit_of_measure

        column = [unit_of_measure(name, unit) for name in table["measure"]]
    return {"voro_unit" if "unit" in table else "unit": column}


# ---- CSV and TSV ---------------------------------------------------------------------------------
_FORMULA = r"[=+\-@\t\r]"
_NUMBER = r"[+-]?(\d++(?:\.\d*+)?|\.\d++)([eE][+-]?\d+)?"


def safe_text(text: str) -> str:
    """Put an apostrophe before a text that begins with =, +, -, @, a tab or a carriage return and is no number."""
    return f"'{text}" if re.match(_FORMULA, text) and not re.fullmatch(_NUMBER, text) else text


def _text_of(value: Any, precision: int, *, is_safe: bool = False) -> str:
    """Text of a mixed column: numbers as in other columns, lists and objects as JSON."""
    if isinstance(value, str):
        return safe_text(value) if is_safe else value
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.{precision}g}" if precision else repr(value).removesuffix(".0")
    if isinstance(value, date):
        return value.isoformat()
    return str(value) if type(value) is int else json_text(value)


# ---- JSON ----------------------------------------------------------------------------------------
def object_shape(names: list[str], before: str = "", after: str = "") -> RowShape:
    """Shape of rows that are JSON objects with these members, within further text."""
    around = [*(f"{',' if number else ''}{json_text(name)}:" for number, name in enumerate(names)), f"}}{after}"]
    return RowShape((f"{before}{{{around[0]}", *around[1:]), ",\n", "null")


def json_column(column: Column) -> Column:
    """The column with what is no number as JSON text."""
    digits = 0 if isinstance(column.values, Lookup) else current_written().how.precision
    if isinstance(column.values, np.ndarray) and column.values.dtype.kind == "b":
        column = replace(column, values=column.values.tolist())
    return column.mapped(lambda v: json_text(float(f"{v:.{digits}g}") if digits and type(v) is float else v))


def json_text(value: Any) -> str:
    """JSON of anything; what JSON does not know becomes text."""
    return json_bytes(value).decode()


def json_bytes(value: Any) -> bytes:
    """JSON of anything, as `json_text`."""
    import orjson

    options = orjson.OPT_SERIALIZE_NUMPY | orjson.OPT_NON_STR_KEYS | orjson.OPT_PASSTHROUGH_SUBCLASS
    return orjson.dumps(value, default=_known_to_json, option=options)


def _known_to_json(value: Any) -> Any:
    """Numbers in text are numbers; of a type that is derived from a plain one, that one."""
    if type(value) is NumberText:
        import orjson

        return orjson.Fragment(value.encode())
    plain: tuple[Callable[[Any], Any], ...] = (str, int, float, list, tuple, dict)
    return next((kind(value) for kind in plain if isinstance(value, kind)), str(value))  # type: ignore[arg-type]


# ---- NPZ -----------------------------------------------------------------------------------------
class _Stream:
    """A file without a position: the archive is then the same for pipes and for files."""

    def __init__(self, out: BinaryIO) -> None:
        self._out = out

    def write(self, data: bytes) -> int:
        return self._out.write(data)

    def flush(self) -> None:
        self._out.flush()


def _archive(out: BinaryIO) -> zipfile.ZipFile:
    import zipfile

    return zipfile.ZipFile(_Stream(out), "w", zipfile.ZIP_STORED)  # type: ignore[call-overload]


def write_npz(out: BinaryIO, columns: Mapping[str, Any]) -> None:
    """Write one array a column, of any lengths."""
    with _archive(out) as archive:
        for column in [Column.of(name, values) for name, values in columns.items()]:
            _write_array(archive, column.name, _npz_values(column))
            if column.missing is not None:
                _write_array(archive, f"{column.name}_missing", column.missing)


def write_arrays(out: BinaryIO, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Write 1-D arrays of any lengths as NPZ: the same bytes for the same arrays."""
    with _archive(out) as archive:
        for name, values in arrays.items():
            _write_array(archive, name, values)


def _npz_values(column: Column) -> NDArray[Any] | Lookup | Computed:
    """Give values without objects; what is missing is zero or empty."""
    values, missing = column.values, column.missing
    if isinstance(values, Lookup) and isinstance(values.values, list):
        return np.array([_text_of(value, 0) for value in values.values], dtype=np.str_)[values.index]
    if not isinstance(values, list):
        if missing is None or isinstance(values, Lookup | Computed):
            return values
        return np.where(missing, np.zeros((), values.dtype), values)
    absent = [False] * len(values) if missing is None else missing.tolist()
    present = [(None if none else value) for value, none in zip(values, absent, strict=True)]
    numbers = _numbers(present)
    if numbers is not None:
        return numbers
    return np.array(["" if value is None else _text_of(value, 0) for value in present], dtype=np.str_)


def _numbers(values: Sequence[Any]) -> NDArray[Any] | None:
    """Give values as integers, numbers or truth values, if all are, with 0 for what is missing; else None."""
    plain = [value.number if type(value) is NumberText else value for value in values]
    kinds = {type(value) for value in plain if value is not None}
    if kinds == {int} and not all(value is None or -(2**63) <= value < 2**63 for value in plain):
        return None
    for kind, dtype in ((bool, np.bool_), (int, np.int64), (float, np.float64)):
        if kinds == {kind} or (kind is float and kinds == {int, float}):
            return np.array([value or 0 for value in plain], dtype=dtype)
    return None


def _write_array(archive: zipfile.ZipFile, name: str, values: NDArray[Any] | Lookup | Computed) -> None:
    """Write an array part by part: the next ones are gathered while one is summed and written."""
    import zipfile

    entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
    entry.create_system = 3  # what the file says of the machine that wrote it: always the same
    entry.external_attr = 0o644 << 16
    kind = values[:0].dtype.newbyteorder("<")
    header = {"descr": np.lib.format.dtype_to_descr(kind), "fortran_order": False, "shape": (len(values),)}

    def gathered(begin: int) -> NDArray[np.uint8]:
        rows = slice(begin, min(begin + _SLICE_VALUES, len(values)))
        return np.ascontiguousarray(values[rows], dtype=kind).view(np.uint8)

    parts = range(0, len(values), _SLICE_VALUES)
    with archive.open(entry, "w", force_zip64=True) as member:
        np.lib.format.write_array_header_1_0(member, header)
        for part in in_order(gathered, parts, current_written().how.threads if len(parts) > 1 else 1):
            member.write(part.data)


def collection_opening(crs: Any, y_axis: YAxis) -> bytes:
    """Return the text before the features of a collection, whose ``crs`` member may be None."""
    unit = current_written().how.coordinate_unit if crs is None else None
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
            write_rows(out, columns, shape)
    out.write(b"]}\n" if is_first else b"\n]}\n")


class JsonItems:
    """A file that takes a list in JSON or a collection in GeoJSON, and passes its items on, some at a time."""

    def __init__(self) -> None:
        self._begun: list[bytes] = []  # the parts of a line that has no end yet
        self._last = b""  # a whole line, which may be the closing
        self._opening: bytes | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.finish()

    def write(self, data: bytes) -> int:
        """Take some text; the last line is the closing, which goes nowhere."""
        lines, end, begun = data.rpartition(b"\n")
        if end:
            self._take_lines(b"".join([*self._begun, lines, end]))
            self._begun = []
        self._begun.append(begun)
        return len(data)

    def take(self, items: bytes) -> None:
        """Take whole items, each on a line."""
        raise NotImplementedError

    def finish(self) -> None:
        """Know that there are no more."""

    @property
    def crs(self) -> Any:
        """The ``crs`` member of a collection; None where there is none."""
        return self.members.get("crs")

    @property
    def members(self) -> dict[str, Any]:
        """What a collection says of all its features, beside them."""
        import orjson

        opening = self._opening or b""
        # of an empty list the closing follows the opening at once
        text = opening.removesuffix(b"\n").removesuffix(b"]}") + b"]}" if opening.startswith(b"{") else b"{}"
        opening_members = orjson.loads(text)
        return {
            name: opening_members[name] for name in ("crs", "unit", MEMBER) if opening_members.get(name) is not None
        }

    def _take_lines(self, lines: bytes) -> None:
        """Pass whole lines on but the last, and but the first of all, the opening."""
        if self._opening is None:
            self._opening, _, lines = lines.partition(b"\n")
        lines = self._last + lines
        place = lines.rfind(b"\n", 0, -1) + 1
        self._last = lines[place:]
        if place:
            self.take(lines[:place].replace(b",\n", b"\n"))


_FEATURE = b'{"type":"Feature",'


class JsonLines(JsonItems):
    """A file that takes a list in JSON or a collection in GeoJSON, and passes its items on, one a line."""

    def __init__(self, out: BinaryIO, what: str = "", path: str = "") -> None:
        super().__init__()
        self._out = out

    def take(self, items: bytes) -> None:
        """Write some items."""
        members = self.members
        current_written().system_unread = members.get("crs")
        if members:
            member = json_text(members)[1:-1].encode() + b","
            items = (b"\n" + items).replace(b"\n" + _FEATURE, b"\n" + _FEATURE + member)[1:]
        self._out.write(items)


def write_value(
    out: BinaryIO,
    value: Any,
    fmt: str,
    *,
    what: str | None = None,
    flatten: float | None = None,
) -> None:
    """Write a value; the bytes depend on nothing but the value and the options that concern numbers."""
    if fmt == "npy":
        matrix = matrix_of(value, what)
        resolved("formats.io.arrays:write_npy")(out, [matrix], matrix.shape, dtype=matrix.dtype)
    elif fmt in TABLES:
        rows = rows_of(value, what, flatten=flatten)
        if isinstance(rows.geometry, Areas):
            rows = resolved("formats.results.features:with_shapes")(rows)
        write_table(out, rows.table(), fmt)
    else:
        features = features_of(value, what, flatten=flatten)
        write = resolved("formats.results.features:write_features")
        write(out, value, features, fmt)
