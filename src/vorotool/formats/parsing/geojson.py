"""JSON and GeoJSON, as far as the readers of points and of polygons share it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from vorotool.errors import NO_PROPERTIES, InputError, LimitError
from vorotool.formats.io.sources import Source, check_nesting
from vorotool.formats.parsing.json_lines import parse_lines
from vorotool.formats.parsing.reader_options import shortened
from vorotool.types.axis import YAxis, y_axis_member

MOST_CELLS = 10**8
"""Properties times objects: as a table, features that share no names would need memory by the square."""


def parse_json(source: Source) -> Any:
    """Parse JSON whose nesting has been counted before; lines of it are one document."""
    import orjson

    if source.document is not None:
        return source.document
    if not source.data.strip():
        raise InputError(f"{source.name} is empty, but JSON is expected; check the program that wrote it")
    check_nesting(source.data, name=source.name)
    if source.format == "jsonl":
        return parse_lines(source)
    try:
        return orjson.loads(source.data)
    except orjson.JSONDecodeError as error:
        raise InputError(
            f"{source.name}, line {error.lineno}, column {error.colno}: the text is not valid JSON ({error.msg}); "
            "correct it"
        ) from None


def refuse_table(name: str, document: Sequence[Any], advice: str) -> None:
    """Refuse a list of objects that are rows of a table, such as ``--what table -f json`` writes."""
    row = document[0] if document else None
    if isinstance(row, dict) and row and not row.keys() & {"type", "shell", "line"}:
        fields = ", ".join([*list(row)[:4], *["…"] * (len(row) > 4)])
        raise InputError(f"{name} holds a table, whose rows have {fields}, not {advice}")


def read_y_axis(name: str, document: Mapping[str, Any], usual: YAxis) -> YAxis:
    """Return which way y goes, as a document says, else as usual in its form."""
    try:
        return y_axis_member(document, usual)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None


def features_of(name: str, document: Mapping[str, Any]) -> list[Any]:
    """Give the features of a GeoJSON document; a bare geometry is one."""
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


def feature_places(name: str, document: Mapping[str, Any]) -> Callable[[int], str]:
    """Give the words for the place of a feature (0-based)."""
    bare = document.get("type") not in ("Feature", "FeatureCollection")
    return lambda feature: name if bare else f"{name}, feature {feature + 1}"


def geometry_of(feature: Any, place: str) -> Mapping[str, Any] | None:
    """Give the geometry of a feature, or None; what is inside it is not looked at."""
    if not isinstance(feature, dict) or feature.get("type") != "Feature":
        raise InputError(f'{place}: {shortened(feature)} is not a Feature; give it "type": "Feature"')
    if not isinstance(feature.get("properties"), dict | None):
        raise InputError(f"{place}: properties are {shortened(feature['properties'])}; write an object or null")
    geometry = feature.get("geometry")
    if not isinstance(geometry, dict | None):
        raise InputError(f"{place}: the geometry is {shortened(geometry)}; write an object with type and coordinates")
    return geometry


def list_of(geometry: Mapping[str, Any], member: str, place: str) -> list[Any]:
    """Give a member of a geometry that must be a list."""
    value = geometry.get(member)
    if not isinstance(value, list):
        raise InputError(f"{place}: {member} of the {geometry['type']} are {shortened(value)}; write a list")
    return value


def holds_shapes(document: Any) -> bool:
    """Whether the first geometry of a GeoJSON document is a polygon or a line; False where that cannot be told."""
    if not isinstance(document, dict):
        return False
    features = document.get("features") if document.get("type") == "FeatureCollection" else [document]
    pending = list(reversed(features)) if isinstance(features, list) else []
    while pending:  # not recursive: a collection may hold very many
        each = pending.pop()
        if not isinstance(each, dict):
            continue
        kind = each.get("type")
        if kind == "Feature":
            pending.append(each.get("geometry"))
        elif kind == "GeometryCollection" and isinstance(each.get("geometries"), list):
            pending.extend(reversed(each["geometries"]))
        elif isinstance(kind, str):
            return kind.removeprefix("Multi") in ("Polygon", "LineString")
    return False


def property_columns(
    name: str, features: Sequence[Mapping[str, Any]], owners: Sequence[int], noun: str
) -> dict[str, list[Any]]:
    """Give the properties as columns with one value an object; ``owners`` tells the feature of each."""
    rows = [feature.get("properties") or {} for feature in features]
    names = list(dict.fromkeys(key for row in rows for key in row))
    if len(names) * len(owners) > MOST_CELLS:
        raise LimitError(
            f"{name} has {len(names)} different properties on {len(owners)} {noun}, more than "
            f"{MOST_CELLS} fields in all: use {NO_PROPERTIES}"
        )
    return {key: [rows[i].get(key) for i in owners] for key in names}
