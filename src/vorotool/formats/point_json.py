"""Points from JSON: GeoJSON, or a plain list of pairs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vorotool.errors import InputError, LimitError
from vorotool.formats.point_options import PointOptions, position_array, shortened
from vorotool.formats.sources import Source, check_nesting
from vorotool.geometry.points import PointSet

_MOST_CELLS = 10**8
"""Properties times points: as a table, features that share no names would need memory by the square."""


def parse_json(source: Source) -> Any:
    """Parse JSON whose nesting has been counted before.

    Raises
    ------
    InputError
        If it is not JSON; the line and column are named.
    """
    import orjson

    check_nesting(source.data, name=source.name)
    try:
        return orjson.loads(source.data)
    except orjson.JSONDecodeError as error:
        raise InputError(
            f"{source.name}, line {error.lineno}, column {error.colno}: this is not JSON ({error.msg}); correct it"
        ) from None


def read_json(source: Source, options: PointOptions) -> PointSet:
    """Read ``[[x, y], ...]``, or GeoJSON where the document is an object."""
    options.check_sites(source.name, 0 if b"{" in source.data else source.data.count(b"[") - 1)
    document = parse_json(source)
    if isinstance(document, dict):
        return _read_document(source.name, document, options)
    if not isinstance(document, list):
        raise InputError(f"{source.name}: {shortened(document)} is no list of points; write [[x, y], …]")
    for index, point in enumerate(document):
        if type(point) is list and len(point) > 2:
            raise InputError(
                f"{source.name}, point {index + 1}: {shortened(point)} has {len(point)} numbers; write [x, y]"
            )
    return PointSet(position_array(document, lambda i: f"{source.name}, point {i + 1}"))


def read_geojson(source: Source, options: PointOptions) -> PointSet:
    """Read the points of a GeoJSON document with their ``id`` and properties."""
    document = parse_json(source)
    if not isinstance(document, dict):
        raise InputError(f"{source.name}: GeoJSON is an object with a type; use --input-format json for [[x, y], …]")
    return _read_document(source.name, document, options)


@dataclass
class _Collected:
    """Positions in order, and for each the feature it comes from (0-based) and its part there (1-based)."""

    positions: list[Any] = field(default_factory=list)
    features: list[int] = field(default_factory=list)
    parts: list[int] = field(default_factory=list)
    without_geometry: int = 0


def _read_document(name: str, document: Mapping[str, Any], options: PointOptions) -> PointSet:
    features = _features_of(name, document)
    bare = document.get("type") not in ("Feature", "FeatureCollection")

    def place(feature: int) -> str:
        return name if bare else f"{name}, feature {feature + 1}"

    collected = _Collected()
    for index, feature in enumerate(features):
        _collect(collected, index, feature, place(index))
    options.check_sites(name, len(collected.positions))
    xy = position_array(collected.positions, lambda i: place(collected.features[i]))
    if collected.without_geometry:
        options.note(f"{name}: {collected.without_geometry} features without a geometry are left out")
    if any(len(position) > 2 for position in collected.positions):
        options.note(f"{name}: only x and y are used, heights are left out")
    crs = document.get("crs")
    if _in_degrees(crs, xy):
        options.note_degrees(name)
    properties = _properties(name, features, collected) if options.properties else {}
    return PointSet(xy, None, properties, y_up=True, crs=crs)


def _features_of(name: str, document: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    kind = document.get("type")
    if kind == "FeatureCollection":
        features = document.get("features")
        if not isinstance(features, list):
            raise InputError(f'{name}: the FeatureCollection has no list of features; add "features": […]')
        return features
    if kind == "Feature":
        return [document]
    if not isinstance(kind, str):
        raise InputError(f"{name}: the object has no GeoJSON type; write GeoJSON, or [[x, y], …]")
    return [{"type": "Feature", "geometry": document, "properties": None}]


def _collect(collected: _Collected, index: int, feature: Any, place: str) -> None:
    if not isinstance(feature, dict) or feature.get("type") != "Feature":
        raise InputError(f'{place}: {shortened(feature)} is no Feature; give it "type": "Feature"')
    if not isinstance(feature.get("properties"), dict | None):
        raise InputError(f"{place}: properties are {shortened(feature['properties'])}; write an object or null")
    positions = _positions(feature.get("geometry"), place)
    if not positions:
        collected.without_geometry += 1
    collected.positions.extend(positions)
    collected.features.extend([index] * len(positions))
    collected.parts.extend(range(1, len(positions) + 1))


def _positions(geometry: Any, place: str) -> list[Any]:
    """Give the positions of a geometry; a collection is as deep as the nesting guard lets it be."""
    if geometry is None:
        return []
    if not isinstance(geometry, dict):
        raise InputError(f"{place}: the geometry is {shortened(geometry)}; write an object with type and coordinates")
    kind = geometry.get("type")
    if kind == "GeometryCollection":
        return [p for each in _list_of(geometry, "geometries", place) for p in _positions(each, place)]
    if kind == "MultiPoint":
        return _list_of(geometry, "coordinates", place)
    if kind == "Point":
        position = _list_of(geometry, "coordinates", place)
        return [position] if position else []
    raise InputError(f"{place}: {shortened(kind)} is not a point; {not_a_point_advice(str(kind))}")


def not_a_point_advice(kind: str) -> str:
    """Say what to do with a geometry that is no point."""
    lines = kind.lower().removeprefix("multi")
    if lines in ("polygon", "linestring"):
        return "replace it by its centroid or its vertices (skeleton-exact reads polygons and lines)"
    return "use Point or MultiPoint"


def _list_of(geometry: Mapping[str, Any], member: str, place: str) -> list[Any]:
    value = geometry.get(member)
    if not isinstance(value, list):
        raise InputError(f"{place}: {member} of the {geometry['type']} are {shortened(value)}; write a list")
    return value


def _in_degrees(crs: Any, xy: Any) -> bool:
    """Whether these are longitude and latitude: by the crs, else (as GeoJSON has it) when they fit."""
    if crs is not None:
        text = str(crs).upper()
        return "CRS84" in text or "4326" in text
    return len(xy) > 0 and bool((np.abs(xy) <= (180.0, 90.0)).all()) and bool((xy % 1 != 0).any())


def _properties(name: str, features: list[Mapping[str, Any]], collected: _Collected) -> dict[str, list[Any]]:
    rows = [feature.get("properties") or {} for feature in features]
    names = list(dict.fromkeys(key for row in rows for key in row))
    if len(names) * len(collected.features) > _MOST_CELLS:
        raise LimitError(
            f"{name} has {len(names)} different properties on {len(collected.features)} points, more than "
            f"{_MOST_CELLS} fields in all: use --no-properties"
        )
    columns: dict[str, list[Any]] = {}
    has_id = any("id" in feature for feature in features)
    if has_id:
        columns["id"] = [features[i].get("id") for i in collected.features]
    for key in names:
        values = [rows[i].get(key) for i in collected.features]
        columns["property_id" if has_id and key == "id" else key] = values
    if max(collected.parts, default=1) > 1:
        columns["voro_part" if "part" in columns else "part"] = collected.parts
    return columns
