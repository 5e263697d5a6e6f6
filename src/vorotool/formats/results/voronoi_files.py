"""Voronoi maps as JSON and as NPZ, version 1: all that they hold."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.sites import Sites
from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions, no_note, shortened
from vorotool.formats.polygons.json import write_items
from vorotool.formats.results import documents as d
from vorotool.formats.results.rows import PREFIXES, ArrayRows, JsonRows, Rows, is_number
from vorotool.formats.text.row_writer import Column, RowShape, write_list_rows, write_rows
from vorotool.formats.text.tables import json_text, write_arrays
from vorotool.numeric.arrays import owners, starts_of
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.table import Lookup
from vorotool.types.voronoi.tables import KINDS, kinds_of
from vorotool.types.voronoi.voronoi_map import OUTSIDE, VoronoiMap

TYPE = "vorotool.voronoi"
NOUN = "Voronoi map"
_CUTS = ("clip", "enclosures")
_SIDES = ("left", "right")
_STARTS = {"ring_starts": "ring_starts", "polygon_starts": "polygon_starts", "cell_starts": "starts"}
"""Of a map, and what their arrays are called."""
_MOST = 2**31 - 1


# ---- writing -------------------------------------------------------------------------------------
def write_voronoi(out: BinaryIO, cells: VoronoiMap, fmt: str) -> None:
    """Write polygons, sites, vertices, arcs and cells; what belongs to no cell is null, or -1."""
    if fmt == "npz":
        write_arrays(out, _arrays(cells))
        return
    polygons = cells.polygons
    d.write_head(out, _head(cells))
    write_items(out, polygons, {"feature": polygons.feature.tolist(), "site": cells.polygon_site.tolist()})
    texts = [json_text(site) for site in d.described_rows(len(cells), cells.ids, cells.properties)]
    out.write(b',\n"sites":[')
    write_list_rows(out, [Column("", texts)], RowShape(("", ""), ",\n", ""))
    out.write(b"]")
    for name, members in _lists(cells).items():
        d.write_list(out, name, members)
    _write_cells(out, cells)
    out.write(b"}\n")


def _arrays(cells: VoronoiMap) -> dict[str, NDArray[Any]]:
    """The same as 1-D arrays."""
    arrays: dict[str, NDArray[Any]] = {}
    for name, members in _lists(cells).items():
        arrays |= d.arrays_of(PREFIXES[name], members)
    arrays |= {"cell_ring_arcs": cells.ring_arcs}
    arrays |= {f"cell_{name}": getattr(cells, own) for own, name in _STARTS.items()}
    arrays |= d.polygon_arrays(cells.polygons) | {"polygon_site": cells.polygon_site}
    sites = d.described_rows(len(cells), cells.ids, cells.properties)
    return arrays | d.about_array(_head(cells), cells.polygons, sites=sites)


def _head(cells: VoronoiMap) -> dict[str, Any]:
    own: dict[str, Any] = {"frame": list(cells.frame)}
    own |= {} if cells.max_distance is None else {"max_distance": cells.max_distance}
    own |= {name: _document(getattr(cells, name)) for name in _CUTS if getattr(cells, name) is not None}
    return d.head_of(TYPE, own, cells.polygons)


def _document(polygons: PolygonSet) -> dict[str, Any]:
    """Polygons as the JSON that would hold them."""
    import orjson

    out = io.BytesIO()
    out.write(b"{")
    write_items(out, polygons, {"feature": polygons.feature.tolist()})
    out.write(b"}")
    items: dict[str, Any] = orjson.loads(out.getvalue())
    head = d.head_of(TYPE, {}, polygons)
    return {name: value for name, value in head.items() if name not in ("type", "version")} | items


def _lists(cells: VoronoiMap) -> dict[str, list[d.Member]]:
    return {
        "vertices": [*map(d.numbers, "xy", cells.vertices.T), d.numbers("r", cells.radius)],
        "arcs": [
            *map(d.indices, ("source", "target"), cells.arcs.T),
            d.choices("kind", KINDS, kinds_of(cells)),
            d.places("control", cells.control, cells.is_parabola),
            d.places("center", cells.center, cells.is_circle),
            d.index_pairs("sites", cells.sites, _SIDES, none_of=len(cells)),
            d.truths("cut", cells.is_cut),
        ],
    }


def _write_cells(out: BinaryIO, cells: VoronoiMap) -> None:
    """Write the rings: before each arc there is a comma, the end of a ring, or the beginning of a cell."""
    out.write(b',\n"cells":[\n' if len(cells) else b',\n"cells":[')
    texts = [",", "],["]
    token = np.zeros(len(cells.ring_arcs), dtype=np.int32)
    token[cells.ring_starts[:-1]] = 1
    empty, before = '{"rings":[],"shells":[]}', ""
    full = np.flatnonzero(cells.components)
    place = 0
    for cell in full.tolist():
        before += f"{empty},\n" * (cell - place)
        shells = cells.polygon_starts[cells.cell_starts[cell] : cells.cell_starts[cell + 1]]
        first = int(shells[0])
        token[cells.ring_starts[first]] = len(texts)
        texts.append(f'{before}{{"shells":{json_text((shells - first).tolist())},"rings":[[')
        place, before = cell + 1, "]]},\n"
    write_rows(
        out,
        [Column("", Lookup(texts, token)), Column("", cells.ring_arcs.astype(np.int64))],
        RowShape(("", "", "")),
    )
    left = [empty] * (len(cells) - place)
    out.write(("]]}" * bool(full.size) + ",\n" * bool(full.size and left) + ",\n".join(left)).encode())
    out.write(b"\n]" if len(cells) else b"]")


# ---- reading -------------------------------------------------------------------------------------
def read_voronoi(source: Source, options: ReadOptions) -> VoronoiMap:
    """Read a Voronoi map."""
    rows = d.opened(source, options, TYPE, NOUN)
    with d.naming_values(rows.name):
        sites = JsonRows(rows.name, rows.document).count("sites")
        if isinstance(rows, ArrayRows):
            site = rows.integers("polygon_site", 0, sites).astype(np.int32)
            polygons = d.read_polygons(rows, options)
        else:
            polygons = _whole(rows, options)
            site = rows.indices("polygons", "site", sites)
            polygons = replace(polygons, feature=rows.indices("polygons", "feature", _MOST))
        made = _map(rows, polygons, site, options)
    check_map(rows.name, made)
    return made


def _map(rows: Rows, polygons: PolygonSet, site: NDArray[np.int32], options: ReadOptions) -> VoronoiMap:
    d.check_described(rows, "sites")
    sites = JsonRows(rows.name, rows.document).list_of("sites")
    ends = [rows.indices("arcs", name, rows.count("vertices")) for name in ("source", "target")]
    control, center = _curves(rows)
    cells = _of_arrays(rows) if isinstance(rows, ArrayRows) else _of_cells(JsonRows(rows.name, rows.document))
    if len(cells["cell_starts"]) != len(sites) + 1:
        count = len(cells["cell_starts"]) - 1
        raise InputError(f"{rows.name}: there are {count} cells, but {len(sites)} sites: write one cell per site")
    pairs = rows.index_pairs("arcs", "sites", _SIDES, len(sites), optional=True)
    return VoronoiMap(
        vertices=np.stack([rows.numbers("vertices", axis) for axis in "xy"], axis=1),
        radius=rows.numbers("vertices", "r", optional=True),
        arcs=np.stack(ends, axis=1),
        sites=np.where(pairs < 0, OUTSIDE, pairs).astype(np.int32),
        control=control,
        center=center,
        is_cut=rows.truths("arcs", "cut"),
        frame=d.read_frame(rows),
        polygons=polygons,
        polygon_site=site,
        **cells,
        **_limits(rows, options),
        **(d.named_rows(sites) if options.properties else {}),
    )


def _whole(rows: JsonRows, options: ReadOptions) -> PolygonSet:
    """The polygons of a document, all of which have vertices."""
    made = d.read_polygons(rows, replace(options, note=no_note))
    if len(made) != rows.count("polygons"):
        raise InputError(f"{rows.name}: a polygon has no vertices; write at least one")
    return made


def read_sites(source: Source, options: ReadOptions) -> Sites:
    """Read the sites of a Voronoi map."""
    return sites_of_map(read_voronoi(source, replace(options, note=no_note)))


def sites_of_map(cells: VoronoiMap) -> Sites:
    """Return the sites that a map was made of."""
    ids = None if cells.ids is None else list(cells.ids)
    return Sites(cells.polygons, cells.polygon_site, len(cells), ids, cells.properties)


def _limits(rows: Rows, options: ReadOptions) -> dict[str, Any]:
    """The limit of distance, and what else than the frame a map was cut by."""
    form = "a length above 0, or leave it out"
    limit = d.stated(
        rows, "max_distance", None, lambda v: v is None or (is_number(v) and v > 0), "max_distance is", form
    )
    made: dict[str, Any] = {"max_distance": None if limit is None else float(limit)}
    for name in _CUTS:
        part = rows.document.get(name)
        if part is not None:
            made[name] = _cut(f"{rows.name}, {name}", part, options)
    return made


def _cut(name: str, document: Any, options: ReadOptions) -> PolygonSet:
    if not isinstance(document, dict):
        raise InputError(f'{name}: {shortened(document)} is not an object; write {{"polygons": […]}}')
    rows = JsonRows(name, document)
    return replace(_whole(rows, options), feature=rows.indices("polygons", "feature", _MOST))


def _curves(rows: Rows) -> list[NDArray[np.float64]]:
    """Control points of parabolas, and centers of circular arcs."""
    kind = rows.choices("arcs", "kind", tuple(KINDS))
    return [
        d.optional_pairs(rows, "arcs", "control", kind == 1, lambda at: f"control point of a {KINDS[kind[at]]}"),
        d.optional_pairs(rows, "arcs", "center", kind == 2, lambda at: f"center of a {KINDS[kind[at]]}"),
    ]


def _of_arrays(rows: ArrayRows) -> dict[str, Any]:
    """Arcs along rings, and where rings, polygons and cells begin."""
    starts = {own: rows.integers(f"cell_{name}", 0, _MOST) for own, name in _STARTS.items()}
    return {"ring_arcs": rows.integers("cell_ring_arcs", -_MOST, _MOST).astype(np.int32), **starts}


def _of_cells(rows: JsonRows) -> dict[str, Any]:
    """The same of the rings of each cell."""
    arcs: list[int] = []
    sizes: list[int] = []
    first: list[int] = []
    polygons: list[int] = []
    for index, cell in enumerate(rows.list_of("cells")):
        rings, shells = _rings_of(f"{rows.name}, cells {index}", cell)
        first.extend(len(sizes) + shell for shell in shells)
        polygons.append(len(shells))
        for ring in rings:
            arcs.extend(ring)
            sizes.append(len(ring))
    return {
        "ring_arcs": np.array(arcs, dtype=np.int32),
        "ring_starts": starts_of(np.array(sizes, dtype=np.int64)),
        "polygon_starts": np.array([*first, len(sizes)], dtype=np.int64),
        "cell_starts": starts_of(np.array(polygons, dtype=np.int64)),
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


def check_map(name: str, cells: VoronoiMap) -> None:
    """Check that arcs lead from lower to higher vertices, and that rings are closed and pass each side once."""
    low, high = cells.arcs.T
    _refuse(name, "arcs", low >= high, lambda at: f"it is from vertex {low[at]} to {high[at]}; write the smaller first")
    signed = cells.ring_arcs.astype(np.int64)
    arc, is_back = np.abs(signed) - 1, signed < 0
    ring = owners(np.diff(cells.ring_starts))
    cell = cells.cell_of_polygon[owners(np.diff(cells.polygon_starts))][ring]
    count = len(cells.arcs)
    wrong = (signed == 0) | (arc >= count)
    _refuse(name, "cells", wrong, lambda at: f"a ring has arc {signed[at]}, but there are {count}", cell)
    own = cells.sites[arc, is_back.astype(int)]
    _refuse(
        name,
        "cells",
        own != cell,
        lambda at: f"a ring has arc {signed[at]}, whose side is {_side(int(own[at]))}; correct its sites",
        cell,
    )
    begin, end = np.where(is_back, high[arc], low[arc]), np.where(is_back, low[arc], high[arc])
    after = np.arange(1, len(arc) + 1)
    after[cells.ring_starts[1:] - 1] = cells.ring_starts[:-1]
    _refuse(
        name,
        "cells",
        end != begin[after],
        lambda at: f"a ring continues at vertex {begin[after[at]]}, but arc {signed[at]} ends at {end[at]}; close it",
        cell,
    )
    passed = np.bincount(2 * arc + is_back, minlength=2 * count)
    due = (cells.sites != OUTSIDE).ravel()
    sides = np.repeat(np.arange(count), 2)
    _refuse(
        name,
        "arcs",
        passed != due,
        lambda at: f"rings have its {('left', 'right')[at % 2]} side {passed[at]} times; expected {int(due[at])}",
        sides,
    )


def _side(site: int) -> str:
    return "null" if site == OUTSIDE else f"of site {site}"


def _refuse(name: str, member: str, wrong: NDArray[np.bool_], words: Any, item: NDArray[Any] | None = None) -> None:
    """Refuse what is wrong first, with the number of its item."""
    if wrong.any():
        at = int(wrong.argmax())
        raise InputError(f"{name}, {member} {at if item is None else item[at]}: {words(at)}")
