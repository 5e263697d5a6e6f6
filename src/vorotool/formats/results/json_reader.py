"""Lists of objects in a JSON document, whose members are taken out as arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.geojson import parse_json, read_y_axis
from vorotool.formats.parsing.reader_options import ReadOptions, shortened
from vorotool.formats.polygons.json import read_json
from vorotool.formats.text.json_writer import SITE_KINDS
from vorotool.formats.text.tables import json_text
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.skeleton.skeleton import SiteTable
from vorotool.types.axis import UNSTATED


class JsonRows:
    """Lists of objects, whose members are taken out as arrays."""

    def __init__(self, name: str, document: Mapping[str, Any]) -> None:
        self.name, self.document = name, document

    def list_of(self, member: str) -> list[Any]:
        """A member of the document, which is a list of objects."""
        value = self.document.get(member)
        if not isinstance(value, list):
            raise InputError(f"{self.name}: {member} are {shortened(value)}; write a list")
        for index, row in enumerate(value):
            if not isinstance(row, dict):
                raise InputError(f"{self.name}, {member} {index}: {shortened(row)} is no object")
        return value

    def fault(self, member: str, rows: list[Any], name: str, is_right: Callable[[Any], bool], what: str) -> InputError:
        """The error for the first value that is not right."""
        at = next((i for i, row in enumerate(rows) if not is_right(row.get(name))), 0)
        value = rows[at].get(name)
        return InputError(f"{self.name}, {member} {at}: {name} is {shortened(value)}; write {what}")

    def numbers(self, member: str, rows: list[Any], name: str, *, optional: bool = False) -> NDArray[np.float64]:
        """Numbers; None becomes NaN where it is allowed."""

        def is_right(value: Any) -> bool:
            return type(value) in (int, float) or (value is None and optional)

        values = [row.get(name) for row in rows]
        if not all(map(is_right, values)):
            raise self.fault(member, rows, name, is_right, "a number")
        return np.array([np.nan if value is None else value for value in values], dtype=np.float64)

    def indices(self, member: str, rows: list[Any], name: str, limit: int, default: Any = None) -> NDArray[np.int32]:
        """Integers from 0 to below a limit; None becomes -1 where it is the default."""

        def is_right(value: Any) -> bool:
            return (type(value) is int and 0 <= value < limit) or (value is None and default is not None)

        values = [row.get(name) for row in rows]
        if not all(map(is_right, values)):
            raise self.fault(member, rows, name, is_right, f"a whole number from 0 to {limit - 1}")
        return np.array([-1 if value is None else value for value in values], dtype=np.int32)

    def choices(self, member: str, rows: list[Any], name: str, names: tuple[str | None, ...]) -> NDArray[np.int8]:
        """The number of each name in a list."""
        number = {text: index for index, text in enumerate(names)}
        values = [row.get(name) for row in rows]
        if not all(isinstance(value, str | None) and value in number for value in values):
            listed = " or ".join(json_text(text) for text in names)
            raise self.fault(member, rows, name, lambda v: isinstance(v, str | None) and v in number, listed)
        return np.array([number[value] for value in values], dtype=np.int8)

    def truths(self, member: str, rows: list[Any], name: str) -> NDArray[np.bool_]:
        """Truth values."""
        values = [row.get(name) for row in rows]
        if not all(type(value) is bool for value in values):
            raise self.fault(member, rows, name, lambda value: type(value) is bool, "true or false")
        return np.array(values, dtype=bool)

    def pairs(self, member: str, rows: list[Any], name: str, *, optional: bool) -> NDArray[np.float64]:
        """Pairs of numbers; None becomes NaN where it is allowed."""

        def is_right(value: Any) -> bool:
            if value is None:
                return optional
            return type(value) is list and len(value) == 2 and all(type(v) in (int, float) for v in value)

        values = [row.get(name) for row in rows]
        if not all(map(is_right, values)):
            raise self.fault(member, rows, name, is_right, "[number, number]")
        nothing = (np.nan, np.nan)
        return np.array([nothing if value is None else value for value in values], dtype=np.float64).reshape(-1, 2)


def opened_rows(source: Source, kind: str, version: int, noun: str) -> JsonRows:
    """Parse the JSON of one of our results, whose type and version are stated."""
    document = parse_json(source)
    if not isinstance(document, Mapping) or document.get("type") != kind:
        raise InputError(f'{source.name} holds no {noun}; its type should be "{kind}"')
    if document.get("version") != version:
        found = shortened(document.get("version"))
        raise InputError(f"{source.name}: version {found} of {kind} is not known; write version {version}")
    return JsonRows(source.name, document)


def read_polygons_of(rows: JsonRows, options: ReadOptions) -> PolygonSet:
    """Read the polygons of a result, and what it says about all of them."""
    document = rows.document
    only_polygons = {"polygons": rows.list_of("polygons")}
    polygons = read_json(Source(rows.name, b"", "json", only_polygons), options)
    return replace(
        polygons,
        y_axis=read_y_axis(rows.name, document, UNSTATED),
        crs=document.get("crs"),
        connectivity=document.get("connectivity"),
        unit=read_unit(rows.name, document),
    )


def read_unit(name: str, document: Mapping[str, Any]) -> str | None:
    """Read the unit of coordinates, if there is one."""
    unit = document.get("unit")
    if not isinstance(unit, str | None):
        raise InputError(f"{name}: the unit is {shortened(unit)}; write a name, such as mm")
    return unit


def read_sites(rows: JsonRows, polygons: PolygonSet) -> SiteTable:
    """Read the sites of a result, all of them vertices and edges of its polygons."""
    items = rows.list_of("sites")
    kind = rows.choices("sites", items, "kind", SITE_KINDS)
    polygon = rows.indices("sites", items, "polygon", len(polygons))
    ring = rows.indices("sites", items, "ring", len(polygons.xy))
    index = rows.indices("sites", items, "index", len(polygons.xy))
    number = polygons.polygon_start[polygon] + ring
    bad = np.flatnonzero(number >= polygons.polygon_start[polygon + 1])
    if bad.size:
        raise InputError(f"{rows.name}, sites {bad[0]}: there is no ring {ring[bad[0]]} in polygon {polygon[bad[0]]}")
    bad = np.flatnonzero(index >= np.diff(polygons.ring_start)[number])
    if bad.size:
        raise InputError(f"{rows.name}, sites {bad[0]}: the ring has no vertex {index[bad[0]]}")
    source = rows.pairs("sites", items, "source", optional=True)
    source_ring, source_index = np.where(np.isnan(source), -1, source).astype(np.int32).T
    ends = [rows.pairs("sites", items, name, optional=True) for name in ("from", "to")]
    has_ends = not all(np.isnan(places).all() for places in ends)
    return SiteTable(
        kind, polygon, ring, index, source_ring, source_index, np.stack(ends, axis=1) if has_ends else None
    )


def read_features(rows: JsonRows) -> str:
    """Read whether features are separate, as they are if nothing is said, or together."""
    value = rows.document.get("features", "separate")
    if value not in ("separate", "together"):
        raise InputError(f"{rows.name}: features are {shortened(value)}; write separate or together")
    return str(value)
