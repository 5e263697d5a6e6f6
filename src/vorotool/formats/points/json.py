"""Points from JSON: GeoJSON, or a plain list of pairs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from vorotool.convert.tables import columns_of_features
from vorotool.errors import AS_JSON, InputError, UsageError, option
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
from vorotool.formats.parsing.reader_options import ReadOptions, note_unnamed, position_array, shortened
from vorotool.formats.points.columns import PointRows
from vorotool.formats.points.tables import points_of_objects
from vorotool.formats.text.tables import stated_unit
from vorotool.types.fields import UP

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
