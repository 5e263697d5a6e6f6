"""Skeletons as JSON, version 1."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.geojson import JsonSource, parse_json
from vorotool.formats.json_lists import (
    SITE_KINDS,
    choice,
    integers,
    number_or_null,
    optional_pair,
    write_list,
    write_sites,
)
from vorotool.formats.point_options import no_note, shortened
from vorotool.formats.points import text_source
from vorotool.formats.polygon_json import read_json as read_polygon_json
from vorotool.formats.polygon_json import write_items
from vorotool.formats.polygon_options import PolygonOptions
from vorotool.formats.sources import Source
from vorotool.formats.tables import json_text
from vorotool.formats.text_rows import Column
from vorotool.geometry.polygons import PolygonSet
from vorotool.geometry.skeleton import KINDS, SIDES, SiteTable, Skeleton

TYPE = "vorotool.skeleton"
VERSION = 1


# ---- writing -------------------------------------------------------------------------------------
def write_json(out: BinaryIO, skeleton: Skeleton, *, precision: int | None = None, threads: int = 0) -> None:
    """Write polygons, sites, vertices and arcs, one object a line of text; all indices are 0-based.

    Beside what the format must have, arcs tell ``polygon`` (null outside), ``branch`` and ``length``, and the object
    ``frame``, ``gap``, ``y_up``, ``crs`` and ``connectivity`` where there are such.
    """
    polygons = skeleton.polygons
    head: dict[str, Any] = {"type": TYPE, "version": VERSION}
    if skeleton.frame is not None:
        head["frame"] = list(skeleton.frame)
    if skeleton.gap:
        head["gap"] = skeleton.gap
    if polygons.y_up:
        head["y_up"] = True
    if polygons.crs is not None:
        head["crs"] = polygons.crs
    if polygons.connectivity is not None:
        head["connectivity"] = polygons.connectivity
    out.write(json_text(head).removesuffix("}").encode() + b",\n")
    write_items(out, polygons, precision)
    write_sites(out, skeleton.site_table, threads=threads)
    _write_vertices(out, skeleton, precision, threads)
    _write_arcs(out, skeleton, precision, threads)
    out.write(b"}\n")


def _write_vertices(out: BinaryIO, skeleton: Skeleton, precision: int | None, threads: int) -> None:
    x, y = np.ascontiguousarray(skeleton.vertices.T)
    columns = [Column("", x), Column("", y), Column("", skeleton.radius)]
    write_list(out, "vertices", columns, ('{"x":', ',"y":', ',"r":', "}"), precision=precision, threads=threads)


def _write_arcs(out: BinaryIO, skeleton: Skeleton, precision: int | None, threads: int) -> None:
    cx, cy = np.ascontiguousarray(skeleton.control.T)
    bounds: Column = Column("", skeleton.error_bound)
    if np.isnan(skeleton.error_bound).any():
        bounds = Column("", [json_text(value) for value in skeleton.error_bound.tolist()])
    columns = [
        *(integers(values) for values in skeleton.arcs.T),
        choice(KINDS, skeleton.is_parabola),
        *optional_pair(skeleton.is_parabola, [cx, cy]),
        *(integers(values) for values in skeleton.sites.T),
        choice(['"interior"', '"exterior"', "null"], np.where(skeleton.side < 0, 2, skeleton.side)),
        bounds,
        number_or_null(skeleton.polygon, len(skeleton.polygons)),
        integers(skeleton.branch),
        Column("", skeleton.length),
    ]
    around = (
        '{"source":', ',"target":', ',"kind":"', '","control":', "", "", "", "", ',"sites":[', ",", '],"side":',
        ',"error_bound":', ',"polygon":', ',"branch":', ',"length":', "}",
    )  # fmt: skip
    write_list(out, "arcs", columns, around, precision=precision, threads=threads)


# ---- reading -------------------------------------------------------------------------------------
def says_skeleton(data: bytes) -> bool:
    """Whether text looks like the JSON of a skeleton, which is not parsed to tell."""
    return f'"{TYPE}"'.encode() in data and data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{")


def is_skeleton(document: Any) -> bool:
    """Whether a JSON document says that it is a skeleton."""
    return isinstance(document, Mapping) and document.get("type") == TYPE


def read_skeleton(
    source: Source, *, properties: bool = True, max_sites: int | None = None, note: Callable[[str], None] | None = None
) -> Skeleton:
    """Read a skeleton that was written as JSON.

    Parameters
    ----------
    source : Source
        What was read.
    properties : bool
        Keep ids and properties of the polygons.
    max_sites : int, optional
        The most vertices of polygons that are accepted.
    note : callable, optional
        Told what was left out.

    Raises
    ------
    InputError
        If it is no such JSON, or an index or a number is none; its place is named.
    LimitError
        If the polygons have too many vertices.

    Examples
    --------
    >>> import io, vorotool
    >>> out = io.BytesIO()
    >>> write_json(out, vorotool.skeleton_exact([[0, 0], [4, 0], [4, 4], [0, 4]]))
    >>> len(read_skeleton(Source("square.json", out.getvalue())))
    4
    """
    document = parse_json(source if isinstance(source, JsonSource) else text_source(source))
    if not is_skeleton(document):
        raise InputError(f'{source.name}: this is no skeleton; its type should be "{TYPE}"')
    if document.get("version") != VERSION:
        version = shortened(document.get("version"))
        raise InputError(f"{source.name}: version {version} of skeletons is not known; write version {VERSION}")
    rows = _Rows(source.name, document)
    options = PolygonOptions(properties, max_sites, note or no_note)
    only_polygons = {"polygons": rows.list_of("polygons")}
    polygons = _described(read_polygon_json(JsonSource(source.name, b"", only_polygons), options), document)
    sites = _read_sites(rows, polygons)
    vertices = rows.list_of("vertices")
    x, y, radius = (rows.numbers("vertices", vertices, name) for name in ("x", "y", "r"))
    return _read_arcs(rows, polygons, sites, np.stack([x, y], axis=1), radius)


class _Rows:
    """Lists of objects, whose members are taken out as arrays."""

    def __init__(self, name: str, document: Mapping[str, Any]) -> None:
        self.name, self.document = name, document

    def list_of(self, member: str) -> list[Any]:
        value = self.document.get(member)
        if not isinstance(value, list):
            raise InputError(f"{self.name}: {member} are {shortened(value)}; write a list")
        for index, row in enumerate(value):
            if not isinstance(row, dict):
                raise InputError(f"{self.name}, {member} {index}: {shortened(row)} is no object")
        return value

    def fault(self, member: str, rows: list[Any], name: str, is_right: Callable[[Any], bool], what: str) -> InputError:
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

    def frame(self) -> tuple[float, float, float, float] | None:
        value = self.document.get("frame")
        if value is None:
            return None
        if type(value) is not list or len(value) != 4 or not all(type(v) in (int, float) for v in value):
            raise InputError(f"{self.name}: the frame is {shortened(value)}; write [x, y, w, h]")
        x, y, w, h = map(float, value)
        return (x, y, w, h)

    def gap(self) -> float:
        value = self.document.get("gap", 0)
        if type(value) not in (int, float) or not value >= 0:
            raise InputError(f"{self.name}: the gap is {shortened(value)}; write a length")
        return float(value)

    def indices(self, member: str, rows: list[Any], name: str, limit: int, default: Any = None) -> NDArray[np.int32]:
        """Integers from 0 to below a limit; None becomes -1 where it is the default."""

        def is_right(value: Any) -> bool:
            return (type(value) is int and 0 <= value < limit) or (value is None and default is not None)

        values = [row.get(name) for row in rows]
        if not all(map(is_right, values)):
            raise self.fault(member, rows, name, is_right, f"a whole number from 0 to {limit - 1}")
        return np.array([-1 if value is None else value for value in values], dtype=np.int32)

    def choices(self, member: str, rows: list[Any], name: str, names: tuple[str | None, ...]) -> NDArray[np.int8]:
        number = {text: index for index, text in enumerate(names)}
        values = [row.get(name) for row in rows]
        if not all(isinstance(value, str | None) and value in number for value in values):
            listed = " or ".join(json_text(text) for text in names)
            raise self.fault(member, rows, name, lambda v: isinstance(v, str | None) and v in number, listed)
        return np.array([number[value] for value in values], dtype=np.int8)

    def pairs(self, member: str, rows: list[Any], name: str, *, optional: bool) -> NDArray[np.float64]:
        def is_right(value: Any) -> bool:
            if value is None:
                return optional
            return type(value) is list and len(value) == 2 and all(type(v) in (int, float) for v in value)

        values = [row.get(name) for row in rows]
        if not all(map(is_right, values)):
            raise self.fault(member, rows, name, is_right, "[number, number]")
        nothing = (np.nan, np.nan)
        return np.array([nothing if value is None else value for value in values], dtype=np.float64).reshape(-1, 2)


def _described(polygons: PolygonSet, document: Mapping[str, Any]) -> PolygonSet:
    return PolygonSet(
        polygons.xy,
        polygons.ring_start,
        polygons.ring_kind,
        polygons.ring_polygon,
        polygons.ids,
        polygons.feature,
        polygons.properties,
        y_up=document.get("y_up") is True,
        crs=document.get("crs"),
        connectivity=document.get("connectivity"),
    )


def _read_sites(rows: _Rows, polygons: PolygonSet) -> SiteTable:
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
    return SiteTable(kind, polygon, ring, index, source_ring, source_index)


def _read_arcs(
    rows: _Rows, polygons: PolygonSet, sites: SiteTable, vertices: NDArray[np.float64], radius: NDArray[np.float64]
) -> Skeleton:
    items = rows.list_of("arcs")
    ends = [rows.indices("arcs", items, name, len(vertices)) for name in ("source", "target")]
    kind = rows.choices("arcs", items, "kind", KINDS)
    control = rows.pairs("arcs", items, "control", optional=True)
    unlike = np.flatnonzero(np.isnan(control[:, 0]) == (kind == 1))
    if unlike.size:
        what = "null" if kind[unlike[0]] == 0 else "[x, y]"
        raise InputError(f"{rows.name}, arcs {unlike[0]}: the control point of a {KINDS[kind[unlike[0]]]} is {what}")
    pair = rows.pairs("arcs", items, "sites", optional=False)
    bad = np.flatnonzero(((pair < 0) | (pair >= len(sites)) | (pair % 1 != 0)).any(axis=1))
    if bad.size:
        raise InputError(
            f"{rows.name}, arcs {bad[0]}: sites are {items[bad[0]]['sites']}; there are {len(sites)} sites"
        )
    side = rows.choices("arcs", items, "side", (*SIDES, None))
    side[side == len(SIDES)] = -1
    branch = rows.indices("arcs", items, "branch", 2**31 - 1, default=-1)
    length = rows.numbers("arcs", items, "length", optional=True)
    return Skeleton(
        vertices,
        radius,
        np.stack(ends, axis=1),
        control,
        pair.astype(np.int32),
        sites,
        rows.indices("arcs", items, "polygon", len(polygons), default=-1),
        side,
        np.where(branch < 0, np.arange(len(items)), branch).astype(np.int32),
        np.where(np.isnan(length), 0.0, length),
        rows.numbers("arcs", items, "error_bound", optional=True),
        polygons,
        rows.frame(),
        rows.gap(),
    )
