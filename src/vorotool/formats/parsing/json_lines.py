"""JSON lines: features of GeoJSON, or rows of a table, each on a line or behind a record separator (RFC 8142)."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from typing import Any

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import shortened
from vorotool.numeric.crs import crs_name, same_crs
from vorotool.types.axis import MEMBER

RECORD_MARK = b"\x1e"
"""What each text of a GeoJSON text sequence begins with; it may then have several lines."""

_LOOKED_AT = 1 << 24
"""Bytes in which two lines must end to be told from a document over several lines."""
_LONGEST_ROW = 1 << 16
_NO_ROW = re.compile(rb'.[{[]|"type"|"polygons"|^{\s*}')
"""What no row of a table has: lists, objects, and the members of our documents and of GeoJSON."""
_GEOMETRIES = ("Point", "LineString", "Polygon", "MultiPoint", "MultiLineString", "MultiPolygon", "GeometryCollection")


def is_json_lines(data: bytes) -> bool:
    """Whether the first two lines are JSON objects of their own, or there is a record separator before the first."""
    import orjson

    if data.startswith(RECORD_MARK):
        return True
    lines = [line for line in data[:_LOOKED_AT].split(b"\n", 2)[:2] if line.startswith(b"{")]
    if len(lines) == 1 and len(data) < _LONGEST_ROW and len(data.strip()) == len(lines[0].strip()):
        return not _NO_ROW.search(lines[0])
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
