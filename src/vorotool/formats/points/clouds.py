"""Points from files of clouds and meshes: the vertices of PLY and OBJ, and the rows of XYZ."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import InputError, Message, option
from vorotool.formats.io.sources import Source, decoding
from vorotool.formats.parsing.reader_options import ReadOptions, no_points, shortened
from vorotool.formats.points.columns import PointRows, chosen_columns, note_no_label
from vorotool.formats.points.delimited import explain, read_text
from vorotool.formats.points.tables import check_coordinates
from vorotool.types.points.point_set import labels_of

Arrays = Mapping[str, NDArray[Any]]

_SPACE = option("delaunay or alphashape --space", 'geometry="space"')


def _note_plane(name: str, options: ReadOptions) -> None:
    """Say that z is no coordinate of points in the plane."""
    if options.axes == 2:
        text = f"{name}: only x and y are used; z is ignored (points in space: {_SPACE})"
        options.note(Message(text, source=name))


def rows_of_arrays(name: str, columns: Arrays, options: ReadOptions, placed: Mapping[str, Any]) -> PointRows:
    """Choose coordinates and labels by names, as in CSV; the other columns are properties."""
    names = list(columns)
    chosen = chosen_columns(name, names, options)
    places = np.stack([columns[names[column]] for column in chosen.coordinates], axis=1)
    labels = None
    if chosen.label is not None:
        labels = labels_of(columns[names[chosen.label]].tolist())
        if labels is None:
            note_no_label(name, options)
    used = chosen.coordinates if labels is None else chosen.used
    rest = [each for k, each in enumerate(names) if k not in used] if options.properties else []
    _note_plane(name, options)
    properties = {each: columns[each].tolist() for each in rest}
    return PointRows(check_coordinates(name, places), labels, properties, dict(placed))


# ---- PLY -----------------------------------------------------------------------------------------
_PLY_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "double": "f8", "float32": "f4", "float64": "f8"},
}
_PLY_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_END_OF_HEADER = re.compile(rb"(?<=[\r\n])end_header[ \t]*(\r?\n|\r)")
_LONGEST_HEADER = 1 << 16


class _Element(NamedTuple):
    """A kind of rows of a PLY file."""

    name: str
    rows: int
    properties: dict[str, str]  # names and types of numpy, `list` of lists

    def row(self, order: str) -> np.dtype[Any]:
        """Give the type of a row, which must have no lists."""
        return np.dtype([(name, order + kind) for name, kind in self.properties.items()])


def read_ply(source: Source, options: ReadOptions) -> PointRows:
    """Read the vertices of a PLY file; properties beside x, y and z are columns."""
    order, elements, body = _ply_header(source)
    kinds = [element.name for element in elements]
    if "vertex" not in kinds:
        raise InputError(f"{source.name} has no element vertex: only the vertices of PLY files are read")
    before, vertices = elements[: kinds.index("vertex")], elements[kinds.index("vertex")]
    if any("list" in each.properties.values() for each in [*before, vertices]):
        raise InputError(f"{source.name} has lists in or before its vertices: write the vertices first, without lists")
    options.check_sites(source.name, vertices.rows)
    read = _binary_columns if order else _text_columns
    with decoding(source.name, "PLY"):
        columns = read(source, order, before, vertices, body)
    return rows_of_arrays(source.name, columns, options, {})


def _ply_header(source: Source) -> tuple[str, list[_Element], int]:
    """Give the order of bytes (none of text), the elements, and where they begin."""
    end = _END_OF_HEADER.search(source.data[:_LONGEST_HEADER])
    if end is None or not source.data.startswith(b"ply"):
        raise InputError(f"{source.name} is not a PLY file: it begins with ply, and its header ends with end_header")
    order, elements = "", list[_Element]()
    for number, line in enumerate(source.data[: end.start()].decode("latin-1").splitlines(), 1):
        match line.split():
            case [] | ["ply"] | ["comment" | "obj_info", *_]:
                pass
            case ["format", name, _] if name in _PLY_ORDERS:
                order = _PLY_ORDERS[name]
            case ["element", name, count] if re.fullmatch("[0-9]{1,18}", count):
                elements.append(_Element(name, int(count), {}))
            case ["property", kind, name] if kind in _PLY_TYPES and elements and name not in elements[-1].properties:
                elements[-1].properties[name] = _PLY_TYPES[kind]
            case ["property", "list", _, _, name] if elements:
                elements[-1].properties[name] = "list"
            case _:
                raise InputError(f"{source.name}, line {number}: {shortened(line)} is not a line of a header of PLY")
    return order, elements, end.end()


def _binary_columns(source: Source, order: str, before: list[_Element], vertices: _Element, begin: int) -> Arrays:
    """Give the columns of rows of numbers."""
    begin += sum(each.rows * each.row(order).itemsize for each in before)
    row = vertices.row(order)
    whole = max(len(source.data) - begin, 0) // max(row.itemsize, 1)
    if whole < vertices.rows:
        raise InputError(
            f"{source.name} states {vertices.rows} vertices, but holds {whole}; is the file damaged or cut off?"
        )
    rows = np.frombuffer(source.data, row, vertices.rows, begin)
    return {name: rows[name].astype(rows[name].dtype.newbyteorder("="), copy=False) for name in vertices.properties}


def _text_columns(source: Source, _order: str, before: list[_Element], vertices: _Element, begin: int) -> Arrays:
    """Give the columns of rows of text: those of integers as integers."""
    lines = source.data.splitlines()
    begin = min(len(source.data[:begin].splitlines()) + sum(each.rows for each in before), len(lines))
    # empty lines in place of the others, so that messages name the line of the file
    text = b"\n".join([b"\n" * (begin - 1), *lines[begin : begin + vertices.rows]])
    names = list(vertices.properties)
    values = _numbers(source.name, text, dict(enumerate(names)), len(names))
    if len(values) != vertices.rows:
        raise InputError(
            f"{source.name} states {vertices.rows} vertices, but {len(values)} follow; is the file cut off?"
        )
    kinds = vertices.properties.values()
    return {
        name: column.astype(np.int64) if kind[0] in "iu" and (column % 1 == 0).all() else column
        for name, kind, column in zip(names, kinds, values.T, strict=True)
    }


def _numbers(name: str, text: bytes, columns: Mapping[int, str], fields: int, threads: int = 0) -> NDArray[np.float64]:
    """Read some of the columns of rows between blanks; a bad number is named with its line."""
    try:
        return _core.text.parse_numbers(text, " ", list(columns), 0, fields, threads)
    except _core.text.TextError as error:
        raise explain(name, error, lambda k: columns.get(k, f"column {k + 1}"), "the first vertex") from None


# ---- OBJ and XYZ ---------------------------------------------------------------------------------
_NO_VERTEX = re.compile(rb"^(?!v[ \t]).+$", re.MULTILINE)


def read_obj(source: Source, options: ReadOptions) -> PointRows:
    """Read the lines ``v x y z`` of a Wavefront OBJ file; what follows z (a weight, a color) is left out."""
    text = _NO_VERTEX.sub(b"", source.data.replace(b"\r\n", b"\n"))
    first = _core.text.first_record(text, " ")
    if first is None:
        return PointRows(no_points(options.axes), None, {}, {})
    fields = first[2]
    options.check_sites(source.name, len(re.findall(rb"^v", text, re.MULTILINE)))
    if len(fields) < 4:
        raise InputError(f"{source.name}, line {first[0]}: {shortened(first[1])} is not a vertex; write v x y z")
    columns = dict(enumerate("xyz"[: options.axes], 1))
    places = _numbers(source.name, text, columns, len(fields), options.threads)
    _note_plane(source.name, options)
    return PointRows(places, None, {}, {})


_COUNT = re.compile(rb"\s*[0-9]+[ \t]*\r?\n")
_ATOM = re.compile(rb"[^\n]*\n[ \t]*[A-Za-z][A-Za-z0-9]*[ \t]+[-+.0-9]")


def read_xyz(source: Source, options: ReadOptions) -> PointRows:
    """Read rows of x, y, z and more, with or without a header; a count before them is passed over.

    In files of molecules a comment follows the count, and each row begins with the symbol of an atom.
    """
    count = _COUNT.match(source.data)
    data, columns = source.data, [1, 2, 3]
    if count is not None:
        begin = count.end()
        if _ATOM.match(data, begin):
            begin, columns = data.index(b"\n", begin) + 1, [2, 3, 4]
        data = b"\n" * data.count(b"\n", 0, begin) + data[begin:]
    source = replace(source, data=data)
    first = re.search(rb"\S+", data)
    has_header = first is not None and first[0][:1].isalpha() and columns[0] == 1
    if options.columns is not None or has_header or first is None:
        return read_text(source, options)
    x, y, z = columns
    _note_plane(source.name, options)
    rows = read_text(source, replace(options, columns=f"{x},{y},z={z}" if options.axes == 3 else f"{x},{y}"))
    names = {f"column_{z}": "z"}
    return rows._replace(properties={names.get(name, name): rows.properties[name] for name in rows.properties})
