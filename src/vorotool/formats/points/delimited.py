"""Points from delimited text: which columns are the coordinates, and what each bad line says.

A million points take the core as long as pandas (`tests/benchmarks/libraries.py csv`), which would have to be
installed, and does not say what is wrong with a line.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.tables import coordinate_columns, placed_by, plain_name
from vorotool.errors import NO_PROPERTIES, InputError, option
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import (
    LARGEST_LABEL,
    ReadOptions,
    no_points,
)
from vorotool.formats.points.columns import (
    COLUMNS,
    DECIMAL_COMMA,
    Chosen,
    PointRows,
    choose,
    note_no_label,
    parse_columns,
)
from vorotool.frozen import frozen
from vorotool.numeric.numbers import typed_texts
from vorotool.products.formats import resolved
from vorotool.products.inputs import INPUTS
from vorotool.types.points.point_set import PointSet

GEOMETRY_COLUMNS = ("wkt", "geometry", "geom", "the_geom", "wkb", "wkb_geometry", "wkt_geom")
"""Names of columns with geometry."""

_QUOTED = r'"[^"]*"'


@frozen
class DelimitedText:
    """How the text of one file is read: columns are 0-based; without a header there are no names."""

    name: str
    data: bytes
    delimiter: str
    first_line: int
    fields: list[str]  # of the first record
    header: bool
    chosen: Chosen

    def described(self, column: int) -> str:
        """Give the words for a column."""
        shown = f" ({self.fields[column]})" if self.header and column < len(self.fields) else ""
        return f"column {column + 1}{shown}"

    def explain(self, error: _core.text.TextError, **advice: str) -> InputError:
        """Put an error of the core into words."""
        counted_by = f"the {'header' if self.header else 'first row'} (line {self.first_line})"
        return explain(self.name, error, self.described, counted_by, **advice)

    def columns(self) -> dict[str, list[str]]:
        """Give the texts of all columns by their names, a name that comes again with a number."""
        try:
            return _properties(self, list(range(len(self.fields))), 0)
        except _core.text.TextError as error:
            raise self.explain(error) from None

    def line_of(self, row: int) -> int:
        """Give the line of a row (0-based)."""
        return int(_core.text.line_of_row(self.data, self.delimiter, int(self.header), row))


def read_text(source: Source, options: ReadOptions) -> PointRows:
    """Read delimited text."""
    wanted = None if options.columns is None else parse_columns(options.columns, axes=options.axes)
    data, delimiter, line, fields = begun(source.data)
    if not line:
        return PointRows(no_points(options.axes), None, {}, {})
    if wanted is None and source.format == "csv" and has_geometry(fields):
        read: Callable[[Source, ReadOptions], PointRows] = resolved(INPUTS["csv-wkt"].readers["points"])
        return read(replace(source, format="csv-wkt"), options)
    header, chosen = choose(source.name, fields, wanted, options)
    layout = DelimitedText(source.name, data, delimiter, line, fields, header, chosen)
    if options.max_sites is not None and data.count(b"\n") >= options.max_sites:
        rows = _core.text.count_rows(data, delimiter, int(layout.header), options.threads)
        options.check_sites(source.name, rows)
    if chosen.label is None or chosen.is_named:
        return _read_rows(layout, options)
    try:
        return _read_rows(layout, options)
    except InputError:  # what is called label need not be one: then it is a column as others are
        numbered = _read_rows(replace(layout, chosen=Chosen(chosen.coordinates)), options)
    note_no_label(source.name, options)
    return numbered


def has_geometry(fields: Sequence[str]) -> bool:
    """Tell whether a header names a column of geometry, and no coordinates."""
    return any(field.strip().lower() in GEOMETRY_COLUMNS for field in fields) and coordinate_columns(fields) is None


def geometry_column(fields: Sequence[str]) -> int | None:
    """Which column holds geometry, by its usual names; None if there is none."""
    lower = [field.strip().lower() for field in fields]
    return next((lower.index(name) for name in GEOMETRY_COLUMNS if name in lower), None)


def delimited_text(source: Source) -> DelimitedText:
    """Take delimited text apart; its first record is a header."""
    data, delimiter, line, fields = begun(source.data)
    if delimiter == " ":  # there is one column, whose geometry has blanks and commas
        delimiter = "\t"
        line, _, fields = _core.text.first_record(data, delimiter) or (0, "", [])
    return DelimitedText(source.name, data, delimiter, line or 1, fields, True, Chosen([0, 0]))


class Begun(NamedTuple):
    """Delimited text whose first record has been looked at."""

    data: bytes  # with lines that end with LF: a text without any LF may end them with CR
    delimiter: str
    line: int  # of the first record; 0 where there is none
    fields: list[str]


def begun(data: bytes) -> Begun:
    """Find the delimiter of text, and the fields of its first record."""
    data = data if b"\n" in data or b"\r" not in data else data.replace(b"\r", b"\n")
    first = _core.text.first_record(data, ",")
    text = "" if first is None else first[1]
    text = (re.sub(_QUOTED, "", text) if '"' in text else text).strip()
    delimiter = next((each for each in ("\t", ";", ",") if each in text), " ")
    line, _, fields = _core.text.first_record(data, delimiter) or (0, "", [])
    return Begun(data, delimiter, line, fields)


def _read_rows(layout: DelimitedText, options: ReadOptions) -> PointRows:
    chosen = layout.chosen
    fields = len(layout.fields)
    advice = f"correct it, or choose other columns with {COLUMNS}"
    try:
        values = _core.text.parse_numbers(
            layout.data, layout.delimiter, chosen.used, int(layout.header), fields, options.threads
        )
    except _core.text.TextError as error:
        raise layout.explain(error, advice=advice) from None
    options.check_sites(layout.name, len(values))
    axes = len(chosen.used) - (chosen.label is not None)
    if axes == 2 and options.columns is None and layout.header and "z" in map(plain_name, layout.fields):
        options.note(f"{layout.name}: the column z is ignored: only x and y are used")
    labels = None if chosen.label is None else _labels(layout, values[:, axes])
    rest = [i for i in range(fields) if i not in chosen.used] if options.properties else []
    x, y = (layout.fields[column] if layout.header else "" for column in chosen.used[:2])
    properties = _properties(layout, rest, options.threads) if rest else {}
    return PointRows(values[:, :axes], labels, properties, placed_by(x, y, has_crs=options.crs is not None))


def _labels(layout: DelimitedText, values: NDArray[np.float64]) -> NDArray[np.int64]:
    bad = np.flatnonzero((values != np.floor(values)) | (values < 1) | (values > LARGEST_LABEL))
    if bad.size:
        row = int(bad[0])
        raise InputError(
            f"{layout.name}, line {layout.line_of(row)}: the label {values[row]:.17g} is not an integer from 1 to "
            f"{LARGEST_LABEL}; correct it, or drop the label from {COLUMNS}"
        )
    return values.astype(np.int64)


def _properties(layout: DelimitedText, columns: list[int], threads: int) -> dict[str, list[str]]:
    try:
        layout.data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = layout.data.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{layout.name}, line {line}: the byte {layout.data[error.start]:#04x} is not UTF-8; "
            f"save the file as UTF-8, or use {NO_PROPERTIES}"
        ) from None
    header, fields = int(layout.header), len(layout.fields)
    texts = _core.text.parse_fields(layout.data, layout.delimiter, columns, header, fields, threads)
    result: dict[str, list[str]] = {}
    for column, values in zip(columns, texts, strict=True):
        name = (layout.fields[column] if layout.header else "") or f"column_{column + 1}"
        result[_unused(name, result)] = typed_texts(values)
    return result


def _unused(name: str, taken: dict[str, list[str]]) -> str:
    number, candidate = 2, name
    while candidate in taken:
        number, candidate = number + 1, f"{name}_{number}"
    return candidate


def explain(
    name: str,
    error: _core.text.TextError,
    described: Callable[[int], str],
    counted_by: str,
    advice: str = "correct it, or remove the line",
) -> InputError:
    """Put an error of the core into words."""
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
    elif re.fullmatch(DECIMAL_COMMA, text):
        point = text.replace(",", ".")
        what = f"{text!r} in {place} is not a number: decimal commas are not read, write {point}"
    else:
        what = f"{text!r} in {place} is not a number; {advice}"
    return InputError(f"{name}, line {line}: {what}")


_FORM = "<vertices> {} <attributes> <0 or 1 boundary markers>"
_SPACE = option("tessellate --size WxHxD", 'geometry="space"')


@frozen
class _Header:
    """The first line of a ``.node`` file."""

    line: int
    vertices: int
    dimension: int
    attributes: int
    markers: int

    @property
    def fields(self) -> int:
        return 1 + self.dimension + self.attributes + self.markers


def read_node(source: Source, options: ReadOptions) -> PointSet | PointRows:
    """Read vertices; attributes and boundary markers become properties, numbering may begin at 0 or 1."""
    dimension = options.axes
    first = _core.text.first_record(source.data, " ")
    if first is None:
        raise InputError(f"{source.name}: the file is empty; a .node file begins with {_FORM.format(dimension)}")
    header = _read_header(source.name, first, dimension)
    options.check_sites(source.name, header.vertices)
    columns = list(range(1 + dimension))
    try:
        values = _core.text.parse_numbers(source.data, " ", columns, 1, header.fields, options.threads)
    except _core.text.TextError as error:
        counted_by = f"each vertex after the header (line {header.line})"
        raise explain(source.name, error, lambda column: f"column {column + 1}", counted_by) from None
    if len(values) != header.vertices:
        raise InputError(
            f"{source.name}, line {header.line}: the header states {header.vertices} vertices, but {len(values)} "
            "follow; correct the header, or complete the file"
        )
    base = _checked_numbering(source, values[:, 0])
    properties = _attributes(source, header, options)
    if options.axes == 3:  # whose labels are from 1
        return PointRows(values[:, 1:], None, properties, {})
    return PointSet(values[:, 1:], None, properties, first_number=base)


def _read_header(name: str, first: tuple[int, str, list[str]], wanted: int) -> _Header:
    line, text, fields = first
    form = _FORM.format(wanted)
    if not 1 <= len(fields) <= 4 or not all(field.isdecimal() and len(field) < 16 for field in fields):
        raise InputError(f"{name}, line {line}: {text[:40]!r} is not a header of a .node file; write {form}")
    vertices, dimension, attributes, markers = (int(v) for v in fields + ["0", str(wanted), "0", "0"][len(fields) :])
    if dimension != wanted:
        two = f"only 2 are read{f', or 3 with {_SPACE}' * (dimension == 3)}"
        what = "points in space have 3" if wanted == 3 else two
        raise InputError(f"{name}, line {line}: the vertices have {dimension} dimensions; {what}")
    if markers > 1 or attributes > 1000:
        raise InputError(
            f"{name}, line {line}: {attributes} attributes and {markers} boundary markers per vertex; write {form}"
        )
    return _Header(line, vertices, dimension, attributes, markers)


def _checked_numbering(source: Source, indices: NDArray[np.float64]) -> int:
    """Number of the first vertex; the others follow without gaps."""
    base = 0 if len(indices) and indices[0] == 0 else 1
    bad = np.flatnonzero(indices != np.arange(base, base + len(indices)))
    if bad.size:
        row = int(bad[0])
        line = _core.text.line_of_row(source.data, " ", 1, row)
        raise InputError(
            f"{source.name}, line {line}: vertex {indices[row]:.17g} should be {row + base}; number the vertices from "
            "0 or 1 without gaps"
        )
    return base


def _attributes(source: Source, header: _Header, options: ReadOptions) -> dict[str, list[str]]:
    names = [f"attribute_{i + 1}" for i in range(header.attributes)] + ["boundary_marker"] * header.markers
    if not names or not options.properties:
        return {}
    columns = list(range(1 + header.dimension, header.fields))
    texts = _core.text.parse_fields(source.data, " ", columns, 1, header.fields, options.threads)
    return dict(zip(names, texts, strict=True))
