"""Points from JSON, and from tables that were written as JSON or NPZ: the columns that CSV has, with their types."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.tables import columns_of_features, placed_by
from vorotool.errors import AS_JSON, AS_VOLUME, InputError, UsageError, option
from vorotool.formats.io.arrays import npy_header, npy_values, npz_columns, present_values
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.json import (
    feature_places,
    features_of,
    geometry_of,
    is_table,
    list_of,
    not_a_point_advice,
    parse_json,
    property_columns,
    read_y_axis,
)
from vorotool.formats.parsing.reader_options import LARGEST_LABEL, ReadOptions, note_unnamed, position_array, shortened
from vorotool.formats.points.columns import PointRows, chosen_columns, note_no_label
from vorotool.formats.text.tables import stated_unit
from vorotool.numeric.coordinates import INEXACT, first_inexact
from vorotool.numeric.numbers import shown_number
from vorotool.types.fields import UP
from vorotool.types.points.point_set import PointSet, labels_of
from vorotool.types.values import counted

_MISSING = "_missing"


def points_of_objects(name: str, rows: Sequence[Any], options: ReadOptions) -> PointRows:
    """Read points from the rows of a table."""
    options.check_sites(name, len(rows))
    names = list(rows[0])
    for number, row in enumerate(rows, 1):
        if not isinstance(row, dict) or row.keys() != rows[0].keys():
            raise InputError(
                f"{name}, row {number}: {shortened(row)} has other fields than the first row; give all rows the same "
                "fields"
            )
    return rows_of_columns(name, {each: [row[each] for row in rows] for each in names}, options)


def read_npz(source: Source, options: ReadOptions) -> PointRows:
    """Read points from the columns of a table."""
    columns = npz_columns(source, options)
    lengths = {len(values) for values in columns.values()}
    if len(lengths) != 1:
        held = "no arrays" if not lengths else f"arrays of {min(lengths)} to {max(lengths)} values"
        raise InputError(
            f"{source.name} is not a table: it holds {held}; save columns of one length, or for a skeleton or offset "
            f"curves give the table ({option('--what points -f npz', 'of points_along')}) or the JSON"
        )
    kept = {name: values for name, values in columns.items() if not name.endswith(_MISSING)}
    values = {name: present_values(values, columns.get(f"{name}{_MISSING}")) for name, values in kept.items()}
    return rows_of_columns(source.name, values, options)


def rows_of_columns(name: str, columns: Mapping[str, list[Any]], options: ReadOptions) -> PointRows:
    """Choose coordinates and labels as in CSV; the other columns are properties."""
    names = list(columns)
    chosen = chosen_columns(name, names, options)
    coordinates = [names[column] for column in chosen.coordinates]
    found = np.stack([_numbers(name, each, columns[each]) for each in coordinates], axis=1)
    labels = None
    if chosen.label is not None:
        values = columns[names[chosen.label]]
        labels = _labels(name, values) if chosen.is_named else labels_of(values)
        if labels is None:
            note_no_label(name, options)
    used = {names[column] for column in (chosen.used if labels is not None else chosen.coordinates)}
    properties = {each: columns[each] for each in names if each not in used} if options.properties else {}
    return PointRows(found, labels, properties, placed_by(*coordinates[:2], has_crs=options.crs is not None))


def _numbers(name: str, column: str, values: list[Any]) -> NDArray[np.float64]:
    for row, value in enumerate(values, 1):
        if type(value) is not int and not (type(value) is float and math.isfinite(value)):
            raise InputError(
                f"{name}, row {row}: {column} is {shortened(value)}, not a finite number; correct or remove it"
            )
    inexact = first_inexact(np.array(values, dtype=object).reshape(-1, 1))
    if inexact is not None:
        raise InputError(f"{name}, row {inexact + 1}: {column} is {shown_number(values[inexact])}: {INEXACT}")
    return np.array(values, dtype=np.float64)


def _labels(name: str, values: list[Any]) -> NDArray[np.int64]:
    for row, value in enumerate(values, 1):
        if type(value) not in (int, float) or value != value // 1 or not 1 <= value <= LARGEST_LABEL:
            raise InputError(
                f"{name}, row {row}: the label {shortened(value)} is not an integer from 1 to {LARGEST_LABEL}; "
                f"correct it, or drop the label from {option('--columns')}"
            )
    return np.array(values, dtype=np.int64)


_ADVICE = "save an (n, 2) or (n, 3) array of numbers with numpy.save"


def read_npy(source: Source, options: ReadOptions) -> PointSet:
    """Read an (n, 2) array of x, y or an (n, 3) array of x, y, label."""
    header = npy_header(source)
    shape = header.shape
    if header.dtype.kind == "b":
        raise InputError(f"{source.name} holds truth values, not numbers; {_ADVICE}")
    if len(shape) != 2 or shape[1] not in (2, 3):
        other = f"; read it as a volume with {AS_VOLUME}" if len(shape) == 3 else ""
        raise InputError(f"{source.name} holds an array of shape {shape}; {_ADVICE} (columns x, y and label){other}")
    options.check_sites(source.name, shape[0])
    table = npy_values(source, header)
    xy = check_coordinates(source.name, table[:, :2])
    return PointSet(xy, npy_labels(source.name, table[:, 2]) if shape[1] == 3 else None)


def check_coordinates(name: str, table: NDArray[np.generic]) -> NDArray[np.float64]:
    """Give coordinates, a column each, as floating-point numbers, which hold them exactly and are finite."""
    row = first_inexact(table)
    if row is not None:
        raise InputError(f"{name}, row {row + 1}: ({_shown(table[row])}): {INEXACT}")
    places = np.ascontiguousarray(table, dtype=np.float64)
    is_finite = np.logical_and.reduce([np.isfinite(column) for column in places.T])  # rows this short are slow
    bad = np.flatnonzero(~is_finite)
    if bad.size:
        row = int(bad[0])
        raise InputError(
            f"{name}, row {row + 1}: ({_shown(places[row])}) is not finite; correct or remove it "
            f"({counted(bad.size, 'such row')})"
        )
    return places


def _shown(row: NDArray[np.generic]) -> str:
    return ", ".join(str(each) for each in row)


def npy_labels(name: str, values: NDArray[np.generic]) -> NDArray[np.int64]:
    """Give labels, which are whole numbers; the row of another value is named (InputError)."""
    good = (values >= 1) & (values <= LARGEST_LABEL)  # type: ignore[operator]
    good &= values == np.floor(values)
    bad = np.flatnonzero(~good)
    if bad.size:
        row = int(bad[0])
        raise InputError(
            f"{name}, row {row + 1}: the label {values[row]} is not an integer from 1 to {LARGEST_LABEL}; correct it, "
            "or save x and y alone"
        )
    return values.astype(np.int64)


_READER = option("skeleton-exact reads", 'geometry="polygons" reads')
_ALONG = option("--what points --every D -f csv there", "points_along")


def read_json(source: Source, options: ReadOptions) -> PointRows:
    """Read ``[[x, y], ...]``, the rows of a table, or GeoJSON where the document is an object."""
    options.check_sites(source.name, 0 if b"{" in source.data else source.data.count(b"[") - 1)
    document = parse_json(source)
    if isinstance(document, dict):
        _refuse_columns(source.name, options)
        return _read_document(source.name, document, options)
    if not isinstance(document, list):
        raise InputError(f"{source.name}: {shortened(document)} is not a list of points; write {_form(options)}")
    if is_table(document):
        return points_of_objects(source.name, document, options)
    _refuse_columns(source.name, options)
    for index, point in enumerate(document):
        if type(point) is list and len(point) > options.axes:
            form = "[x, y, z]" if options.axes == 3 else "[x, y]"
            raise InputError(
                f"{source.name}, point {index + 1}: {shortened(point)} has {len(point)} numbers; write {form}"
            )
    found = position_array(document, lambda i: f"{source.name}, point {i + 1}", options.axes)
    return PointRows(found, None, {}, {})


def _form(options: ReadOptions) -> str:
    return "[[x, y, z], …]" if options.axes == 3 else "[[x, y], …]"


def _refuse_columns(name: str, options: ReadOptions) -> None:
    if options.columns is not None:
        raise UsageError(
            f"{option('--columns')} applies to delimited text and tables, but {name} is neither: leave it out"
        )


def read_geojson(source: Source, options: ReadOptions) -> PointRows:
    """Read the points of a GeoJSON document with their ``id`` and properties."""
    document = parse_json(source)
    if not isinstance(document, dict):
        raise InputError(f"{source.name}: GeoJSON is an object with a type; use {AS_JSON} for {_form(options)}")
    return _read_document(source.name, document, options)


def _read_document(name: str, document: Mapping[str, Any], options: ReadOptions) -> PointRows:
    if "polygons" in document:
        raise InputError(
            f"{name} holds polygons, or a result for polygons, not points: {_READER} it; for points along a skeleton "
            f"use {_ALONG}"
        )
    features = features_of(name, document)
    place = feature_places(name, document)
    of_features = [
        _positions(geometry_of(feature, place(index)), place(index)) for index, feature in enumerate(features)
    ]
    positions = [position for each in of_features for position in each]
    owners = [index for index, each in enumerate(of_features) for _ in each]  # the feature of each, from 0
    options.check_sites(name, len(positions))
    found = position_array(positions, lambda i: place(owners[i]), options.axes)
    options.note_left_out(name, sum(not each for each in of_features))
    if options.axes == 2 and any(len(position) > 2 for position in positions):
        options.note_heights(name)
    crs, unit = document.get("crs"), stated_unit(document)
    if crs is unit is None and options.crs is None:
        note_unnamed(name, found[:, :2], options.note)
    parts = [part for each in of_features for part in range(1, len(each) + 1)]
    properties = _properties(name, features, owners, parts) if options.properties else {}
    return PointRows(found, None, properties, {"y_axis": read_y_axis(name, document, UP), "crs": crs, "unit": unit})


def _positions(geometry: Any, place: str) -> list[Any]:
    """Give the positions of a geometry; a collection is as deep as the nesting guard lets it be."""
    if geometry is None:
        return []
    if not isinstance(geometry, dict):
        raise InputError(f"{place}: the geometry is {shortened(geometry)}; write an object with type and coordinates")
    kind = geometry.get("type")
    if kind == "GeometryCollection":
        return [p for each in list_of(geometry, "geometries", place) for p in _positions(each, place)]
    if kind == "MultiPoint":
        return list_of(geometry, "coordinates", place)
    if kind == "Point":
        position = list_of(geometry, "coordinates", place)
        return [position] if position else []
    raise InputError(f"{place}: {shortened(kind)} is not a point; {not_a_point_advice(str(kind))}")


def _properties(
    name: str, features: list[Mapping[str, Any]], owners: list[int], parts: list[int]
) -> dict[str, list[Any]]:
    columns = property_columns(name, features, owners, "points")
    has_id = any("id" in feature for feature in features)
    return columns_of_features([features[i].get("id") for i in owners] if has_id else None, columns, parts)
