"""Voronoi maps as JSON, version 1."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions, no_note, shortened
from vorotool.formats.polygons.json import write_items
from vorotool.formats.results.json_reader import JsonRows, opened_rows, read_polygons_of
from vorotool.formats.results.voronoi_checks import check_map, naming_values, pairs_of_sites
from vorotool.formats.text.json_writer import choice, integers, number_or_null, optional_pair, write_list
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.formats.text.tables import json_text
from vorotool.geometry.arguments.sites import Sites
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.ragged import starts_of
from vorotool.geometry.table import Lookup
from vorotool.geometry.voronoi.tables import KINDS, kinds_of
from vorotool.geometry.voronoi.voronoi_map import VoronoiMap
from vorotool.types.axis import MEMBER as Y_AXIS

TYPE = "vorotool.voronoi"
VERSION = 1
_CUTS = ("clip", "enclosures")


# ---- writing -------------------------------------------------------------------------------------
def write_json(out: BinaryIO, cells: VoronoiMap, *, precision: int | None = None, threads: int = 0) -> None:
    """Write polygons, sites, vertices, arcs and cells, one object a line of text; all indices are 0-based."""
    polygons = cells.polygons
    head = {"type": TYPE, "version": VERSION, "frame": list(cells.frame), **described(cells)}
    out.write(json_text(head).removesuffix("}").encode() + b",\n")
    assert polygons.feature is not None
    own = {"feature": polygons.feature.tolist(), "site": cells.polygon_site.tolist()}
    write_items(out, polygons, own)
    _write_sites(out, cells, threads)
    x, y = np.ascontiguousarray(cells.vertices.T)
    missing = np.isnan(cells.radius)
    columns = [Column("", x), Column("", y), choice(["", "null"], missing), Column("", cells.radius, missing)]
    write_list(out, "vertices", columns, ('{"x":', ',"y":', ',"r":', "", "}"), precision=precision, threads=threads)
    _write_arcs(out, cells, precision, threads)
    _write_cells(out, cells, threads)
    out.write(b"}\n")


def described(cells: VoronoiMap) -> dict[str, Any]:
    """Give what is known of a map as a whole beside its frame, for JSON."""
    made: dict[str, Any] = {} if cells.max_distance is None else {"max_distance": cells.max_distance}
    made |= {name: _document(getattr(cells, name)) for name in _CUTS if getattr(cells, name) is not None}
    return made | _placed(cells.polygons)


def _placed(polygons: PolygonSet) -> dict[str, Any]:
    names = ("crs", "unit", "connectivity")
    known = {name: getattr(polygons, name) for name in names if getattr(polygons, name) is not None}
    return {Y_AXIS: polygons.y_axis} | known


def _document(polygons: PolygonSet) -> dict[str, Any]:
    """Polygons as the JSON that would hold them."""
    import orjson

    out = io.BytesIO()
    out.write(b"{")
    assert polygons.feature is not None
    write_items(out, polygons, {"feature": polygons.feature.tolist()})
    out.write(b"}")
    items: dict[str, Any] = orjson.loads(out.getvalue())
    return _placed(polygons) | items


def _write_sites(out: BinaryIO, cells: VoronoiMap, threads: int) -> None:
    texts = [json_text(site) for site in described_rows(len(cells), cells.ids, cells.properties)]
    write_list(out, "sites", [Column("", texts)], ("", ""), threads=threads)


def described_rows(count: int, ids: Sequence[Any] | None, properties: Mapping[str, Sequence[Any]]) -> list[Any]:
    """Give id and properties of each site or polygon as an object of JSON, as far as there are any."""
    made: list[dict[str, Any]] = [{} for _ in range(count)] if ids is None else [{"id": value} for value in ids]
    if properties:
        columns = {name: list(values) for name, values in properties.items()}
        for row, each in enumerate(made):
            each["properties"] = {name: values[row] for name, values in columns.items()}
    return made


def _write_arcs(out: BinaryIO, cells: VoronoiMap, precision: int | None, threads: int) -> None:
    columns = [
        *(integers(values) for values in cells.arcs.T),
        choice(KINDS, kinds_of(cells)),
        *optional_pair(cells.is_parabola, [values.copy() for values in cells.control.T]),
        *optional_pair(cells.is_circle, [values.copy() for values in cells.center.T]),
        *(number_or_null(values, len(cells)) for values in cells.sites.T),
        choice(["false", "true"], cells.is_cut),
    ]
    around = (
        '{"source":', ',"target":', ',"kind":"', '","control":', "", "", "", "", ',"center":', "", "", "", "",
        ',"sites":[', ",", '],"cut":', "}",
    )  # fmt: skip
    write_list(out, "arcs", columns, around, precision=precision, threads=threads)


def _write_cells(out: BinaryIO, cells: VoronoiMap, threads: int) -> None:
    """Write the rings: before each arc there is a comma, the end of a ring, or the beginning of a cell."""
    out.write(b',\n"cells":[\n' if len(cells) else b',\n"cells":[')
    texts = [",", "],["]
    token = np.zeros(len(cells.ring_arcs), dtype=np.int32)
    token[cells.ring_start[:-1]] = 1
    empty, before = '{"rings":[],"shells":[]}', ""
    full = np.flatnonzero(cells.components)
    place = 0
    for cell in full.tolist():
        before += f"{empty},\n" * (cell - place)
        shells = cells.polygon_start[cells.cell_start[cell] : cells.cell_start[cell + 1]]
        first = int(shells[0])
        token[cells.ring_start[first]] = len(texts)
        texts.append(f'{before}{{"shells":{json_text((shells - first).tolist())},"rings":[[')
        place, before = cell + 1, "]]},\n"
    write_rows(
        out,
        [Column("", Lookup(texts, token)), Column("", cells.ring_arcs.astype(np.int64))],
        RowShape(("", "", "")),
        threads=threads,
    )
    left = [empty] * (len(cells) - place)
    out.write(("]]}" * bool(full.size) + ",\n" * bool(full.size and left) + ",\n".join(left)).encode())
    out.write(b"\n]" if len(cells) else b"]")


# ---- reading -------------------------------------------------------------------------------------
def read_voronoi(source: Source, options: ReadOptions) -> VoronoiMap:
    """Read a Voronoi map that was written as JSON."""
    rows = opened_rows(source, TYPE, VERSION, "Voronoi map")
    with naming_values(rows.name):
        made = _map(rows, options)
    check_map(rows.name, made)
    return made


def _map(rows: JsonRows, options: ReadOptions) -> VoronoiMap:
    sites, vertices, arcs = (rows.list_of(name) for name in ("sites", "vertices", "arcs"))
    check_described(rows, "sites", sites)
    polygons, polygon_site = _polygons(rows, len(sites), options)
    x, y = (rows.numbers("vertices", vertices, name) for name in ("x", "y"))
    ends = [rows.indices("arcs", arcs, name, len(vertices)) for name in ("source", "target")]
    control, center = _curves(rows, arcs)
    return VoronoiMap(
        vertices=np.stack([x, y], axis=1),
        radius=rows.numbers("vertices", vertices, "r", optional=True),
        arcs=np.stack(ends, axis=1),
        sites=pairs_of_sites(rows, arcs, len(sites)),
        control=control,
        center=center,
        is_cut=rows.truths("arcs", arcs, "cut"),
        frame=read_frame(rows.name, rows.document.get("frame")),
        polygons=polygons,
        polygon_site=polygon_site,
        **_rings(rows, len(sites)),
        **read_described(rows.name, rows.document, options),
        **(named_rows(sites) if options.properties else {}),
    )


def read_sites(source: Source, options: ReadOptions) -> Sites:
    """Read the sites of a Voronoi map that was written as JSON."""
    return sites_of_map(read_voronoi(source, replace(options, note=no_note)))


def sites_of_map(cells: VoronoiMap) -> Sites:
    """Give the sites that a map was made of."""
    ids = None if cells.ids is None else list(cells.ids)
    return Sites(cells.polygons, cells.polygon_site, len(cells), ids, cells.properties)


def _polygons(rows: JsonRows, sites: int, options: ReadOptions) -> tuple[PolygonSet, NDArray[np.int32]]:
    """The polygons, and the site of each."""
    items = rows.list_of("polygons")
    made = read_polygons_of(rows, replace(options, note=no_note))
    if len(made) != len(items):
        raise InputError(f"{rows.name}: a polygon has no vertices; write each with some")
    feature = rows.indices("polygons", items, "feature", 2**31 - 1)
    return replace(made, feature=feature), rows.indices("polygons", items, "site", sites)


def check_described(rows: JsonRows, member: str, items: list[Any]) -> None:
    """Refuse properties that are no objects."""

    def is_right(value: Any) -> bool:
        return isinstance(value, dict | None)

    if not all(is_right(item.get("properties")) for item in items):
        raise rows.fault(member, items, "properties", is_right, "an object")


def named_rows(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Give ids and properties as columns; see `described_rows`."""
    ids = [row.get("id") for row in rows] if any("id" in row for row in rows) else None
    own = [row.get("properties") or {} for row in rows]
    names = dict.fromkeys(name for each in own for name in each)
    return {"ids": ids, "properties": {name: [each.get(name) for each in own] for name in names}}


def read_described(name: str, document: Mapping[str, Any], options: ReadOptions) -> dict[str, Any]:
    """Read the limit of distance and what else than the frame a map was cut by."""
    limit = document.get("max_distance")
    if limit is not None and (type(limit) not in (int, float) or not limit > 0):
        raise InputError(f"{name}: max_distance is {shortened(limit)}; write a length above 0, or leave it out")
    made: dict[str, Any] = {"max_distance": None if limit is None else float(limit)}
    for each in _CUTS:
        part = document.get(each)
        if part is not None:
            made[each] = _cut(f"{name}, {each}", part, options)
    return made


def _cut(name: str, document: Any, options: ReadOptions) -> PolygonSet:
    if not isinstance(document, dict):
        raise InputError(f'{name}: {shortened(document)} is no object; write {{"polygons": […]}}')
    rows = JsonRows(name, document)
    made = read_polygons_of(rows, replace(options, note=no_note))
    items = rows.list_of("polygons")
    if len(made) != len(items):
        raise InputError(f"{name}: a polygon has no vertices; write each with some")
    feature = rows.indices("polygons", items, "feature", 2**31 - 1)
    return replace(made, feature=feature)


def read_frame(name: str, value: Any) -> tuple[float, float, float, float]:
    """Read the rectangle that cells were cut by."""
    is_right = type(value) is list and len(value) == 4 and all(type(v) in (int, float) for v in value)
    if not is_right or not np.isfinite(value).all() or min(value[2:]) < 0:
        raise InputError(f"{name}: the frame is {shortened(value)}; write [x, y, w, h]")
    x, y, w, h = map(float, value)
    return (x, y, w, h)


def _curves(rows: JsonRows, arcs: list[Any]) -> list[NDArray[np.float64]]:
    """Control points of parabolas, and centers of circular arcs."""
    kind = rows.choices("arcs", arcs, "kind", tuple(KINDS))
    found = []
    for number, (member, words) in enumerate((("control", "control point"), ("center", "center")), 1):
        places = rows.pairs("arcs", arcs, member, optional=True)
        unlike = np.flatnonzero(np.isnan(places[:, 0]) == (kind == number))
        if unlike.size:
            at = int(unlike[0])
            what = "[x, y]" if kind[at] == number else "null"
            raise InputError(f"{rows.name}, arcs {at}: the {words} of a {KINDS[kind[at]]} is {what}")
        found.append(places)
    return found


def _rings(rows: JsonRows, sites: int) -> dict[str, Any]:
    """Arcs along rings, and where rings, polygons and cells begin."""
    cells = rows.list_of("cells")
    if len(cells) != sites:
        raise InputError(f"{rows.name}: there are {len(cells)} cells, but {sites} sites: write one cell a site")
    arcs: list[int] = []
    sizes: list[int] = []
    first: list[int] = []
    polygons: list[int] = []
    for index, cell in enumerate(cells):
        rings, shells = _rings_of(f"{rows.name}, cells {index}", cell)
        first.extend(len(sizes) + shell for shell in shells)
        polygons.append(len(shells))
        for ring in rings:
            arcs.extend(ring)
            sizes.append(len(ring))
    return {
        "ring_arcs": np.array(arcs, dtype=np.int32),
        "ring_start": starts_of(np.array(sizes, dtype=np.int64)),
        "polygon_start": np.array([*first, len(sizes)], dtype=np.int64),
        "cell_start": starts_of(np.array(polygons, dtype=np.int64)),
    }


def _rings_of(place: str, cell: Mapping[str, Any]) -> tuple[list[list[int]], list[int]]:
    rings: Any = cell.get("rings")
    shells: Any = cell.get("shells")
    is_right = type(rings) is list and all(type(ring) is list and ring for ring in rings)
    if not is_right or not all(type(arc) is int and 0 < abs(arc) < 2**31 for ring in rings for arc in ring):
        raise InputError(f"{place}: rings are {shortened(rings)}; write lists of arcs, counted from 1 or from -1 down")
    begin = type(shells) is list and all(type(shell) is int for shell in shells)
    if not begin or shells[:1] != [0][: len(rings)] or shells != sorted({*shells}) or shells[-1:] > [len(rings) - 1]:
        raise InputError(f"{place}: shells are {shortened(shells)}; number those of the {len(rings)} rings, from 0 up")
    return rings, shells
