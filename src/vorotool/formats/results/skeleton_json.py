"""Skeletons as JSON, version 1."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions, shortened
from vorotool.formats.polygons.json import write_items
from vorotool.formats.results.json_reader import (
    JsonRows,
    opened_rows,
    read_features,
    read_polygons_of,
    read_sites,
)
from vorotool.formats.results.placed_polygons import LATTICE_STEP, as_read, as_written
from vorotool.formats.text.json_writer import (
    choice,
    integers,
    number_or_null,
    optional_pair,
    write_list,
    write_sites,
)
from vorotool.formats.text.row_writer import Column
from vorotool.formats.text.tables import json_text
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.skeleton.skeleton import KINDS, SIDES, SiteTable, Skeleton
from vorotool.types.axis import MEMBER as Y_AXIS

TYPE = "vorotool.skeleton"
VERSION = 1


# ---- writing -------------------------------------------------------------------------------------
def write_json(out: BinaryIO, skeleton: Skeleton, *, precision: int | None = None, threads: int = 0) -> None:
    """Write polygons, sites, vertices and arcs, one object a line of text; all indices are 0-based."""
    polygons, step = as_written(skeleton.polygons)
    head: dict[str, Any] = {"type": TYPE, "version": VERSION}
    if skeleton.frame is not None:
        head["frame"] = list(skeleton.frame)
    if skeleton.border != "closed":
        head["border"] = skeleton.border
    if skeleton.gap:
        head["gap"] = skeleton.gap
    if skeleton.features != "separate":
        head["features"] = skeleton.features
    head[Y_AXIS] = polygons.y_axis
    if polygons.crs is not None:
        head["crs"] = polygons.crs
    if polygons.unit is not None:
        head["unit"] = polygons.unit
    if polygons.connectivity is not None:
        head["connectivity"] = polygons.connectivity
    if step:
        head[LATTICE_STEP] = step
    out.write(json_text(head).removesuffix("}").encode() + b",\n")
    write_items(out, polygons)
    write_sites(out, skeleton.site_table, threads=threads)
    _write_vertices(out, skeleton.as_given if step else skeleton, precision, threads)
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
def read_skeleton(source: Source, options: ReadOptions) -> Skeleton:
    """Read a skeleton that was written as JSON."""
    rows = opened_rows(source, TYPE, VERSION, "skeleton")
    polygons = as_read(read_polygons_of(rows, options), rows.document)
    sites = read_sites(rows, polygons)
    vertices = rows.list_of("vertices")
    x, y, radius = (rows.numbers("vertices", vertices, name) for name in ("x", "y", "r"))
    skeleton = _read_arcs(rows, polygons.as_given, sites, np.stack([x, y], axis=1), radius)
    return skeleton if polygons.as_given is polygons else skeleton.with_corners(polygons)


def _read_arcs(
    rows: JsonRows, polygons: PolygonSet, sites: SiteTable, vertices: NDArray[np.float64], radius: NDArray[np.float64]
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
        _frame(rows),
        _gap(rows),
        read_features(rows),
        border=_border(rows),
    )


def _frame(rows: JsonRows) -> tuple[float, float, float, float] | None:
    value = rows.document.get("frame")
    if value is None:
        return None
    if type(value) is not list or len(value) != 4 or not all(type(v) in (int, float) for v in value):
        raise InputError(f"{rows.name}: the frame is {shortened(value)}; write [x, y, w, h]")
    x, y, w, h = map(float, value)
    return (x, y, w, h)


def _border(rows: JsonRows) -> str:
    value = rows.document.get("border", "closed")
    if value not in ("closed", "open"):
        raise InputError(f"{rows.name}: the border is {shortened(value)}; write closed or open")
    return str(value)


def _gap(rows: JsonRows) -> float:
    value = rows.document.get("gap", 0)
    if type(value) not in (int, float) or not value >= 0:
        raise InputError(f"{rows.name}: the gap is {shortened(value)}; write a length")
    return float(value)
