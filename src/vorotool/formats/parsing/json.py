"""JSON and GeoJSON, as far as the readers of points and of polygons share it."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from vorotool.errors import NO_PROPERTIES, InputError, LimitError, option
from vorotool.formats.io.sources import Source, check_nesting
from vorotool.formats.parsing.reader_options import shortened
from vorotool.formats.recognition import RECORD_MARK
from vorotool.numeric.crs import crs_name, same_crs
from vorotool.types.fields import MEMBER, YAxis, y_axis_member

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


def is_table(document: Any) -> bool:
    """Whether parsed JSON is a list of rows of a table, such as ``--what table -f json`` writes."""
    row = document[0] if isinstance(document, list) and document else None
    return isinstance(row, dict) and bool(row) and not row.keys() & {"type", "shell", "line"}


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


def check_cells(name: str, columns: int, rows: int, noun: str) -> None:
    """Refuse properties that would need too much memory as a table."""
    if columns * rows > MOST_CELLS:
        raise LimitError(
            f"{name} has {columns} different properties on {rows} {noun}, more than {MOST_CELLS} fields in all: use "
            f"{NO_PROPERTIES}"
        )


def property_columns(
    name: str, features: Sequence[Mapping[str, Any]], owners: Sequence[int], noun: str
) -> dict[str, list[Any]]:
    """Give the properties as columns with one value an object; ``owners`` tells the feature of each."""
    rows = [feature.get("properties") or {} for feature in features]
    names = list(dict.fromkeys(key for row in rows for key in row))
    check_cells(name, len(names), len(owners), noun)
    return {key: [rows[i].get(key) for i in owners] for key in names}


# ---- JSON lines ----------------------------------------------------------------------------------
_LOOKED_AT = 1 << 24
"""Bytes in which two lines must end to be told from a document over several lines."""
_LONGEST_ROW = 1 << 16
_NO_ROW = rb'.[{[]|"type"|"polygons"|^{\s*}'
"""What no row of a table has: lists, objects, and the members of our documents and of GeoJSON."""
_GEOMETRIES = ("Point", "LineString", "Polygon", "MultiPoint", "MultiLineString", "MultiPolygon", "GeometryCollection")


def is_json_lines(data: bytes) -> bool:
    """Whether the first two lines are JSON objects of their own, or there is a record separator before the first."""
    import orjson

    if data.startswith(RECORD_MARK):
        return True
    lines = [line for line in data[:_LOOKED_AT].split(b"\n", 2)[:2] if line.startswith(b"{")]
    if len(lines) == 1 and len(data) < _LONGEST_ROW and len(data.strip()) == len(lines[0].strip()):
        return not re.search(_NO_ROW, lines[0])
    try:
        return len(lines) == 2 and all(isinstance(orjson.loads(line), dict) for line in lines)
    except orjson.JSONDecodeError:
        return False


def parse_lines(source: Source) -> Any:
    """Parse each line: features and geometries are given as a collection, all else as a list."""
    import orjson

    rows: list[dict[str, Any]] = []
    lines: list[int] = []
    for line, text in _records(source.data):
        try:
            row = orjson.loads(text)
        except orjson.JSONDecodeError as error:
            raise InputError(
                f"{source.name}, line {line + error.lineno - 1}, column {error.colno}: the text is not valid JSON "
                f"({error.msg}); correct it{', or remove the line' * bool(rows)}"
            ) from None
        if not isinstance(row, dict):
            raise InputError(
                f"{source.name}, line {line}: {shortened(row)} is not an object; write one object per line"
            )
        rows.append(row)
        lines.append(line)
    kind = rows[0].get("type") if rows else None
    if kind != "Feature" and kind not in _GEOMETRIES:
        return rows
    features = [_feature(source.name, line, row) for line, row in zip(lines, rows, strict=True)]
    crs = _common_crs(source.name, lines, rows)
    known = ({} if crs is None else {"crs": crs}) | _common_members(source.name, lines, rows)
    return {"type": "FeatureCollection", "features": features} | known


def _records(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Give the texts that are not blank, each with the number of the line that it begins on."""
    line = 1
    for text in data.split(RECORD_MARK) if data.startswith(RECORD_MARK) else io.BytesIO(data):
        if text and not text.isspace():
            yield line, text.rstrip()
        line += text.count(b"\n")


def _feature(name: str, line: int, row: dict[str, Any]) -> dict[str, Any]:
    kind = row.get("type")
    if kind in _GEOMETRIES:
        return {"type": "Feature", "geometry": row, "properties": None}
    if kind != "Feature":
        raise InputError(f"{name}, line {line}: {shortened(row)} is not a feature, unlike those before it")
    return row


def _common_members(name: str, lines: list[int], rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Return which way y goes, and the unit of coordinates, where all features state the same."""
    members: dict[str, Any] = {}
    for member in (MEMBER, "unit"):
        stated = rows[0].get(member)
        other = next((line for line, row in zip(lines, rows, strict=True) if row.get(member) != stated), None)
        if other is not None:
            raise InputError(
                f"{name}, line {other}: {member} is not {stated!r}, the value on line {lines[0]}: write the same in "
                "all lines"
            )
        if stated is not None:
            members[member] = stated
    return members


def _common_crs(name: str, lines: list[int], rows: list[dict[str, Any]]) -> Any:
    """Give the ``crs`` member of the features that have one."""
    named = [(line, row["crs"]) for line, row in zip(lines, rows, strict=True) if row.get("crs") is not None]
    if not named:
        return None
    before, crs = named[0]
    for line, other in named:
        if other != crs and not same_crs(other, crs):
            raise InputError(
                f"{name}, line {line}: the feature is in {crs_name(other)}, but that of line {before} in "
                f"{crs_name(crs)}: put them into separate files"
            )
    return crs


# ---- advice --------------------------------------------------------------------------------------
_TAKERS = (
    option("voronoi and skeleton-exact read", "voronoi and skeleton_exact take"),
    option("tessellate --cell-size rasterizes", "tessellate(..., cell_size=...) rasterizes"),
)
_TAKER_OF_ALL = option("voronoi reads", "voronoi takes")
OF_SITES = "use (Multi)Point, (Multi)LineString or (Multi)Polygon"
"""What to do with geometry that is none of these."""


def not_a_point_advice(kind: str) -> str:
    """Say what to do with a geometry that is no point."""
    lines = kind.lower().removeprefix("multi")
    if lines in ("polygon", "linestring"):
        return f"replace it by its centroid or its vertices ({_TAKERS[0]} polygons and lines, {_TAKERS[1]} them)"
    return "use Point or MultiPoint"


def not_a_shape_advice(kind: str) -> str:
    """Say what to do with a geometry that is neither polygon nor line."""
    if kind.lower().removeprefix("multi") == "point":
        return f"put points into a separate file ({_TAKER_OF_ALL} points, lines and polygons together)"
    return "use (Multi)Polygon or (Multi)LineString"
