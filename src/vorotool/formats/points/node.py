"""Points from the ``.node`` files of Triangle, and from those of TetGen, which have a z."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import InputError, option
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.points.columns import PointRows
from vorotool.formats.points.delimited import explain
from vorotool.plain import plain
from vorotool.types.points.point_set import PointSet

_FORM = "<vertices> {} <attributes> <0 or 1 boundary markers>"
_SPACE = option("tessellate --size WxHxD", 'geometry="space"')


@plain
class _Header:
    line: int
    vertices: int
    dimension: int
    attributes: int
    markers: int

    @property
    def fields(self) -> int:
        return 1 + self.dimension + self.attributes + self.markers


class _Vertices(NamedTuple):
    places: NDArray[np.float64]
    properties: dict[str, list[str]]
    first_number: int


def read_node(source: Source, options: ReadOptions) -> PointSet | PointRows:
    """Read vertices; attributes and boundary markers become properties, numbering may begin at 0 or 1."""
    read = _vertices(source, options, options.axes)
    if options.wants_z:  # whose labels are from 1
        return PointRows(read.places, None, read.properties, {})
    return PointSet(read.places, None, read.properties, first_number=read.first_number)


def _vertices(source: Source, options: ReadOptions, dimension: int) -> _Vertices:
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
        raise explain(source.name, error, _described, counted_by) from None
    _check_count(source.name, header, len(values))
    base = _checked_numbering(source, values[:, 0])
    return _Vertices(values[:, 1:], _properties(source, header, options), base)


def _described(column: int) -> str:
    return f"column {column + 1}"


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


def _check_count(name: str, header: _Header, rows: int) -> None:
    if rows != header.vertices:
        raise InputError(
            f"{name}, line {header.line}: the header states {header.vertices} vertices, but {rows} follow; correct "
            "the header, or complete the file"
        )


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


def _properties(source: Source, header: _Header, options: ReadOptions) -> dict[str, list[str]]:
    names = [f"attribute_{i + 1}" for i in range(header.attributes)] + ["boundary_marker"] * header.markers
    if not names or not options.properties:
        return {}
    columns = list(range(1 + header.dimension, header.fields))
    texts = _core.text.parse_fields(source.data, " ", columns, 1, header.fields, options.threads)
    return dict(zip(names, texts, strict=True))
