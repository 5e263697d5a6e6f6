"""Offset curves as JSON, version 1."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.polygons.json import write_items
from vorotool.formats.results.json_reader import (
    JsonRows,
    opened_rows,
    read_features,
    read_polygons_of,
    read_sites,
)
from vorotool.formats.results.placed_polygons import LATTICE_STEP, as_read, as_written
from vorotool.formats.text.json_writer import choice, integers, number_or_null, optional_pair, write_list, write_sites
from vorotool.formats.text.row_writer import Column
from vorotool.formats.text.tables import json_text
from vorotool.geometry.ragged import starts_of
from vorotool.geometry.skeleton.offsets import PIECE_KINDS, RING_KINDS, Offsets
from vorotool.types.axis import MEMBER as Y_AXIS

TYPE = "vorotool.offsets"
VERSION = 1


# ---- writing -------------------------------------------------------------------------------------
def write_json(out: BinaryIO, offsets: Offsets, *, precision: int | None = None, threads: int = 0) -> None:
    """Polygons, sites, shapes, rings and pieces, one object a line of text; all indices are 0-based."""
    polygons, step = as_written(offsets.polygons)
    head: dict[str, Any] = {"type": TYPE, "version": VERSION}
    head[Y_AXIS] = polygons.y_axis
    if polygons.crs is not None:
        head["crs"] = polygons.crs
    if polygons.unit is not None:
        head["unit"] = polygons.unit
    if offsets.features != "separate":
        head["features"] = offsets.features
    if step:
        head[LATTICE_STEP] = step
    out.write(json_text(head).removesuffix("}").encode() + b",\n")
    write_items(out, polygons)
    write_sites(out, offsets.site_table, threads=threads)
    shapes = [
        Column("", offsets.distance),
        number_or_null(offsets.polygon, len(polygons)),
        integers(offsets.shape_start[:-1]),
        integers(np.diff(offsets.shape_start)),
    ]
    around: tuple[str, ...] = ('{"distance":', ',"polygon":', ',"first":', ',"rings":', "}")
    write_list(out, "shapes", shapes, around, precision=precision, threads=threads)
    rings = [
        integers(offsets.shape_of_ring),
        choice(RING_KINDS, offsets.ring_kind),
        integers(offsets.ring_start[:-1]),
        integers(np.diff(offsets.ring_start)),
    ]
    around = ('{"shape":', ',"kind":"', '","first":', ',"pieces":', "}")
    write_list(out, "rings", rings, around, threads=threads)
    places = [Column("", values.copy()) for values in (*offsets.start.T, *offsets.end.T)]
    pieces = [
        choice(PIECE_KINDS, offsets.is_arc),
        *places,
        *optional_pair(offsets.is_arc, [values.copy() for values in offsets.center.T]),
        choice(["null", "true", "false"], np.where(offsets.is_arc, np.where(offsets.piece_distance > 0, 1, 2), 0)),
        integers(offsets.site),
    ]
    around = (
        '{"kind":"', '","start":[', ",", '],"end":[', ",", '],"center":', "", "", "", "", ',"ccw":', ',"site":', "}",
    )  # fmt: skip
    write_list(out, "pieces", pieces, around, precision=precision, threads=threads)
    out.write(b"}\n")


# ---- reading -------------------------------------------------------------------------------------
def read_offsets(source: Source, options: ReadOptions) -> Offsets:
    """Read offset curves that were written as JSON."""
    rows = opened_rows(source, TYPE, VERSION, "offset curves")
    polygons = as_read(read_polygons_of(rows, options), rows.document)
    sites = read_sites(rows, polygons)
    shapes, rings, pieces = (rows.list_of(name) for name in ("shapes", "rings", "pieces"))
    distance = rows.numbers("shapes", shapes, "distance")
    if not distance.all():
        raise InputError(f"{rows.name}, shapes {np.flatnonzero(distance == 0)[0]}: the distance is 0; write another")
    start, end, center = _places(rows, pieces)
    return Offsets(
        start,
        end,
        center,
        rows.indices("pieces", pieces, "site", len(sites)),
        _starts(rows, "rings", rings, "pieces", len(pieces)),
        _starts(rows, "shapes", shapes, "rings", len(rings)),
        distance,
        rows.indices("shapes", shapes, "polygon", len(polygons), default=-1),
        sites,
        polygons,
        read_features(rows),
    )


def _places(rows: JsonRows, pieces: list[Any]) -> tuple[NDArray[np.float64], ...]:
    """Ends and centers; an arc that few digits have shrunk to its center is a straight line."""
    start, end = (rows.pairs("pieces", pieces, name, optional=False) for name in ("start", "end"))
    center = rows.pairs("pieces", pieces, "center", optional=True)
    kind = rows.choices("pieces", pieces, "kind", PIECE_KINDS)
    unlike = np.flatnonzero(np.isnan(center[:, 0]) == (kind == 1))
    if unlike.size:
        what = ("null", "[x, y]")[kind[unlike[0]]]
        raise InputError(
            f"{rows.name}, pieces {unlike[0]}: the center of {('a line', 'an arc')[kind[unlike[0]]]} is {what}"
        )
    center[(start == center).all(axis=1) | (end == center).all(axis=1)] = np.nan
    return start, end, center


def _starts(rows: JsonRows, member: str, items: list[Any], parts: str, count: int) -> NDArray[np.int64]:
    """Where the parts of each item begin: one after the other, all of them."""
    first = rows.indices(member, items, "first", max(count, 1))
    number = rows.indices(member, items, parts, count + 1)
    expected = starts_of(number)
    wrong = np.flatnonzero((first != expected[:-1]) | (number < 1))
    if wrong.size or expected[-1] != count:
        at = wrong[0] if wrong.size else len(items) - 1
        raise InputError(f"{rows.name}, {member} {at}: the {parts} of each follow those of the one before; list all")
    return expected
