"""Points from delimited text: which columns are the coordinates, and what each bad line says.

A million points take the core as long as pandas (`tests/benchmarks/libraries.py csv`), which would have to be
installed, and does not say what is wrong with a line.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import NO_PROPERTIES, InputError, UsageError, option
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import (
    LARGEST_LABEL,
    ReadOptions,
    no_points,
    shortened,
)
from vorotool.geometry.coordinate_names import coordinate_columns, is_longitude_latitude, is_map, plain_name
from vorotool.geometry.crs import LONGITUDE_LATITUDE, crs_member
from vorotool.geometry.number_text import typed_texts
from vorotool.geometry.points.point_set import PointSet

_COLUMNS, _X_Y = option("--columns"), option("--columns X,Y", 'columns="X,Y"')
_BEGINNINGS = (("x", "y"), ("longitude", "latitude"), ("lon", "lat"), ("lng", "lat"), ("east", "north"))
"""Of names that may be a pair of coordinates, such as x0 and y0."""

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?|[+-]?(nan|inf|infinity)", re.IGNORECASE)
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(e[+-]?\d+)?", re.IGNORECASE)
_QUOTED = re.compile(r'"[^"]*"')
_MOST_LISTED = 12


@dataclass(frozen=True)
class _Layout:
    """How the text of one file is read: columns are 0-based; without a header there are no names."""

    name: str
    data: bytes
    delimiter: str
    first_line: int
    first_record: list[str]
    header: bool
    x: int
    y: int
    label: int | None

    @property
    def header_records(self) -> int:
        return int(self.header)

    def described(self, column: int) -> str:
        shown = f" ({self.first_record[column]})" if self.header and column < len(self.first_record) else ""
        return f"column {column + 1}{shown}"


def read_text(source: Source, options: ReadOptions) -> PointSet:
    """Read delimited text.

    It may have a byte order mark, ``#`` comments, blank lines, quoted fields, and commas, semicolons, tabs or blanks
    between fields. A header with x,y, lon,lat, longitude,latitude, easting,northing, centroid-1,centroid-0 or
    axis-1,axis-0 (in any case) says which columns are the coordinates; without a header two columns are x, y; all else
    needs ``columns``. A column ``label`` is used when ``columns`` names it, or when the header is x, y and label alone.
    Places on a map by the header are points with y upwards.
    """
    data = _plain_lines(source.data)
    wanted = None if options.columns is None else _parse_columns(options.columns)
    delimiter = _guess_delimiter(data)
    first = _core.text.first_record(data, delimiter)
    if first is None:
        return PointSet(no_points())
    layout = _choose_layout(source.name, data, delimiter, first, wanted, options)
    if options.max_sites is not None and data.count(b"\n") >= options.max_sites:
        rows = _core.text.count_rows(data, delimiter, layout.header_records, options.threads)
        options.check_sites(source.name, rows)
    return _read_rows(layout, options)


def header_fields(data: bytes) -> list[str]:
    """Fields of the first record of delimited text.

    Examples
    --------
    >>> header_fields(b"id;WKT\\n1;POINT (1 2)\\n")
    ['id', 'WKT']
    """
    data = _plain_lines(data)
    first = _core.text.first_record(data, _guess_delimiter(data))
    return [] if first is None else first[2]


@dataclass(frozen=True)
class DelimitedText:
    """Delimited text with a header, of which no column is known to hold coordinates."""

    _layout: _Layout

    @property
    def name(self) -> str:
        """The input."""
        return self._layout.name

    @property
    def fields(self) -> list[str]:
        """Those of the header."""
        return self._layout.first_record

    def columns(self, threads: int = 0) -> dict[str, list[str]]:
        """Give the texts of all columns by their names, a name that comes again with a number."""
        try:
            return _properties(self._layout, list(range(len(self.fields))), threads)
        except _core.text.TextError as error:
            raise explain(self.name, error, self._layout.described, _counted_by(self._layout)) from None

    def line_of(self, row: int) -> int:
        """Give the line of a row (0-based)."""
        return int(_core.text.line_of_row(self._layout.data, self._layout.delimiter, 1, row))


def delimited_text(source: Source) -> DelimitedText:
    r"""Take delimited text apart; its first record is a header.

    Examples
    --------
    >>> delimited_text(Source("a.csv", b"id;wkt\n7;POINT (1 2)\n")).columns()
    {'id': ['7'], 'wkt': ['POINT (1 2)']}
    """
    data = _plain_lines(source.data)
    delimiter = _guess_delimiter(data)
    if delimiter == " ":  # there is one column, whose geometry has blanks and commas
        delimiter = "\t"
    line, _, fields = _core.text.first_record(data, delimiter) or (1, "", [])
    return DelimitedText(_Layout(source.name, data, delimiter, line, fields, True, 0, 0, None))


def has_coordinates(fields: Sequence[str]) -> bool:
    """Whether a header names a known pair of coordinates.

    Examples
    --------
    >>> has_coordinates(["id", "Lon", "Lat"]), has_coordinates(["id", "wkt"])
    (True, False)
    """
    return coordinate_columns(fields) is not None


def _plain_lines(data: bytes) -> bytes:
    """Give lines that end with LF: a text without any LF may end them with CR."""
    return data if b"\n" in data or b"\r" not in data else data.replace(b"\r", b"\n")


def _guess_delimiter(data: bytes) -> str:
    first = _core.text.first_record(data, ",")
    text = "" if first is None else _QUOTED.sub("", first[1]).strip()
    return next((delimiter for delimiter in ("\t", ";", ",") if delimiter in text), " ")


# ---- which columns -------------------------------------------------------------------------------
def _parse_columns(columns: str) -> list[str]:
    parts = [part.strip() for part in columns.split(",")]
    is_zero = [_is_number(part) and not part.strip("0") for part in parts]
    if len(parts) not in (2, 3) or not all(parts) or any(is_zero) or len(set(parts)) < len(parts):
        raise UsageError(
            f"{_COLUMNS} is {shortened(columns)}: name two or three different columns as X,Y or X,Y,LABEL, by name or "
            "by number from 1"
        )
    return parts


def _choose_layout(
    name: str,
    data: bytes,
    delimiter: str,
    first: tuple[int, str, list[str]],
    wanted: list[str] | None,
    options: ReadOptions,
) -> _Layout:
    line, _, fields = first
    header, chosen = _choose(name, fields, wanted, options)
    x, y, label = (*chosen, None)[:3] if len(chosen) == 2 else chosen
    assert x is not None
    assert y is not None
    return _Layout(name, data, delimiter, line, fields, header, x, y, label)


def _choose(
    name: str, fields: list[str], wanted: list[str] | None, options: ReadOptions
) -> tuple[bool, Sequence[int | None]]:
    """Whether the first record is a header, and which columns are x, y and, if one is, the label."""
    return _recognise(name, fields, options) if wanted is None else _look_up(name, fields, wanted)


def chosen_columns(name: str, fields: list[str], options: ReadOptions) -> list[int]:
    """Choose the columns of a table that are x, y and, if one is, the label: as in delimited text.

    Raises
    ------
    InputError
        If the names are not known as coordinates, or ``--columns`` names one that is not there.

    Examples
    --------
    >>> chosen_columns("a.json", ["label", "x", "y"], ReadOptions())
    [1, 2, 0]
    """
    wanted = None if options.columns is None else _parse_columns(options.columns)
    return [column for column in _choose(name, fields, wanted, options)[1] if column is not None]


def _recognise(name: str, fields: list[str], options: ReadOptions) -> tuple[bool, Sequence[int | None]]:
    """Find the coordinates by the header; two columns without one are x, y."""
    chosen = coordinate_columns(fields)
    if chosen is not None:
        used = [fields[column] for column in chosen]
        meanings = "x, y, label" if len(chosen) == 3 else "x, y"
        if [plain_name(each) for each in used] != ["x", "y"]:  # plain x, y need no word
            options.note(f"{name}: columns {', '.join(used)} are read as {meanings}")
        return True, chosen
    header = not any(_looks_numeric(field) for field in fields) and any(fields)
    if not header and len(fields) == 2:
        return False, [0, 1]
    raise _unknown_columns(name, fields, header)


def _look_up(name: str, fields: list[str], wanted: list[str]) -> tuple[bool, Sequence[int | None]]:
    """Find the columns that the user named; a name makes the first record a header."""
    chosen = [_find_column(name, fields, column) for column in wanted]
    if len(set(chosen)) < len(chosen):
        raise InputError(f"{name}: {_COLUMNS} {_cut(','.join(wanted))} names one column twice; {_listing(fields)}")
    named = not all(map(_is_number, wanted))
    values = [fields[i] for i in chosen]
    return named or (any(values) and not any(_looks_numeric(value) for value in values)), chosen


def _is_number(column: str) -> bool:
    """Whether a column is named by its number; digits of other scripts may be a name."""
    return column.isascii() and column.isdecimal()


def _find_column(name: str, fields: list[str], wanted: str) -> int:
    if _is_number(wanted):
        digits = wanted.lstrip("0")
        if len(digits) > len(str(len(fields))) or int(digits) > len(fields):
            raise InputError(
                f"{name}: {_COLUMNS} names column {_cut(wanted)}, but there are {len(fields)}; {_listing(fields)}"
            )
        return int(digits) - 1
    for names, key in ((fields, wanted), ([plain_name(field) for field in fields], plain_name(wanted))):
        if names.count(key) == 1:
            return names.index(key)
        if names.count(key) > 1:
            raise InputError(f"{name}: several columns are called {shortened(wanted)}; give {_COLUMNS} by number")
    raise InputError(f"{name}: there is no column {shortened(wanted)}; {_listing(fields)}; correct {_COLUMNS}")


def _unknown_columns(name: str, fields: list[str], header: bool) -> InputError:
    if len(fields) == 1:
        return InputError(
            f"{name}: the first line has one column, {fields[0][:40]!r}; give x and y, separated by "
            "a comma, a semicolon, a tab or blanks"
        )
    what = "the header names no known pair of coordinates" if header else f"{len(fields)} columns without a header"
    example = _example(fields) if header else _numeric_example(fields)
    if example is None:
        return InputError(
            f"{name}: {what}, and no two columns look like one; give the points that the table was made from, or say "
            f"which are x and y with {_X_Y} ({_listing(fields)})"
        )
    chosen = option(f"--columns {example}", f'columns="{example}"')
    return InputError(f"{name}: {what}; say which are x and y, for example {chosen} ({_listing(fields)})")


def _example(fields: list[str]) -> str | None:
    """Two columns that may be x and y, as their names begin alike and go on the same; None where no two do."""
    names = {plain_name(field): field for field in fields}
    for first, second in _BEGINNINGS:
        for key, field in names.items():
            other = names.get(second + key.removeprefix(first))
            if key.startswith(first) and other is not None and "," not in field + other:
                return f"{field},{other}"
    return None


def _numeric_example(fields: list[str]) -> str | None:
    """The numbers of the first two columns that hold numbers; None where no two do."""
    numeric = [str(i) for i, field in enumerate(fields, 1) if _looks_numeric(field)]
    return ",".join(numeric[:2]) if len(numeric) > 1 else None


def _listing(fields: list[str]) -> str:
    shown = ", ".join(f"{i} = {field[:24] or 'empty'}" for i, field in enumerate(fields[:_MOST_LISTED], 1))
    more = f", … {len(fields)} in all" if len(fields) > _MOST_LISTED else ""
    return f"its columns are {shown}{more}"


def _cut(text: str) -> str:
    return text if len(text) <= 40 else f"{text[:39]}…"


def _looks_numeric(text: str) -> bool:
    return bool(_NUMBER.fullmatch(text) or _DECIMAL_COMMA.fullmatch(text))


# ---- rows ----------------------------------------------------------------------------------------
def _read_rows(layout: _Layout, options: ReadOptions) -> PointSet:
    columns = [layout.x, layout.y] if layout.label is None else [layout.x, layout.y, layout.label]
    fields = len(layout.first_record)
    advice = f"correct it, or choose other columns with {_COLUMNS}"
    try:
        values = _core.text.parse_numbers(
            layout.data, layout.delimiter, columns, layout.header_records, fields, options.threads
        )
    except _core.text.TextError as error:
        raise explain(layout.name, error, layout.described, _counted_by(layout), advice) from None
    options.check_sites(layout.name, len(values))
    labels = None if layout.label is None else _labels(layout, values[:, 2])
    rest = [i for i in range(fields) if i not in columns] if options.properties else []
    x, y = (layout.first_record[column] if layout.header else "" for column in (layout.x, layout.y))
    return PointSet(values[:, :2], labels, _properties(layout, rest, options.threads), **placed_by(x, y, options))


def placed_by(x: str, y: str, options: ReadOptions) -> dict[str, Any]:
    """Give the direction of y and the coordinate reference system of points, which the names of the columns tell.

    Examples
    --------
    >>> placed_by("x", "y", ReadOptions())
    {'y_up': False, 'crs': None}
    """
    is_geographic = is_longitude_latitude(x, y) and options.crs is None
    return {"y_up": is_map(x, y), "crs": crs_member(LONGITUDE_LATITUDE) if is_geographic else None}


def _counted_by(layout: _Layout) -> str:
    return f"the {'header' if layout.header else 'first row'} (line {layout.first_line})"


def _labels(layout: _Layout, values: NDArray[np.float64]) -> NDArray[np.int64]:
    bad = np.flatnonzero((values != np.floor(values)) | (values < 1) | (values > LARGEST_LABEL))
    if bad.size:
        row = int(bad[0])
        line = _core.text.line_of_row(layout.data, layout.delimiter, layout.header_records, row)
        raise InputError(
            f"{layout.name}, line {line}: the label {values[row]:.17g} is not a whole number from 1 to "
            f"{LARGEST_LABEL}; correct it, or leave the label out of {_COLUMNS}"
        )
    return values.astype(np.int64)


def _properties(layout: _Layout, columns: list[int], threads: int) -> dict[str, list[str]]:
    if not columns:
        return {}
    _check_utf8(layout)
    header = layout.header_records
    fields = len(layout.first_record)
    texts = _core.text.parse_fields(layout.data, layout.delimiter, columns, header, fields, threads)
    result: dict[str, list[str]] = {}
    for column, values in zip(columns, texts, strict=True):
        name = (layout.first_record[column] if layout.header else "") or f"column_{column + 1}"
        result[_unused(name, result)] = typed_texts(values)
    return result


def _unused(name: str, taken: dict[str, list[str]]) -> str:
    number, candidate = 2, name
    while candidate in taken:
        number, candidate = number + 1, f"{name}_{number}"
    return candidate


def _check_utf8(layout: _Layout) -> None:
    try:
        layout.data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = layout.data.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{layout.name}, line {line}: the byte {layout.data[error.start]:#04x} is not UTF-8; "
            f"save the file as UTF-8, or use {NO_PROPERTIES}"
        ) from None


def explain(
    name: str,
    error: _core.text.TextError,
    described: Callable[[int], str],
    counted_by: str,
    advice: str = "correct it, or remove the line",
) -> InputError:
    """Put an error of the core into words.

    Parameters
    ----------
    name : str
        The input.
    error : TextError
        What the core found.
    described : callable
        Gives the words for a 0-based column.
    counted_by : str
        What set the number of fields that each line must have.
    advice : str
        What to do about text that is no number.

    Returns
    -------
    InputError
        To be raised.
    """
    kind, line, column, text, found, expected = error.args
    place = described(column)
    if kind == "field_count":
        what = (
            f"{found} field{'s' * (found != 1)}, but {counted_by} has {expected}; "
            "give every line the same number of fields"
        )
    elif kind == "open_quote":
        what = f"the quote that opens {place} is not closed before the next delimiter; close it, or remove it"
    elif kind == "not_finite":
        what = f"{text!r} in {place} is not a finite number; correct it, or remove the line"
    elif not text:
        what = f"{place} is empty; fill in a number, or remove the line"
    elif _DECIMAL_COMMA.fullmatch(text):
        point = text.replace(",", ".")
        what = f"{text!r} in {place} is not a number: decimal commas are not read, write {point}"
    else:
        what = f"{text!r} in {place} is not a number; {advice}"
    return InputError(f"{name}, line {line}: {what}")
