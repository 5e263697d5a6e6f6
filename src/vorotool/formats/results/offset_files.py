"""Offset curves as JSON and as NPZ, version 1: all that they hold."""

from __future__ import annotations

from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.results import documents as d
from vorotool.formats.results.documents import LATTICE_STEP, as_read, as_written
from vorotool.formats.results.rows import Rows
from vorotool.numeric.arrays import starts_of
from vorotool.types.skeleton.offsets import PIECE_KINDS, RING_KINDS, Offsets

TYPE = "vorotool.offsets"
NOUN = "offset curves"


# ---- writing -------------------------------------------------------------------------------------
def write_offsets(out: BinaryIO, offsets: Offsets, fmt: str, *, precision: int | None = None, threads: int = 0) -> None:
    """Write polygons, sites, shapes, rings and pieces; no polygon is null, or -1, the center of a line null, or NaN."""
    d.write_document(out, _parts(offsets), fmt, precision=precision, threads=threads)


def _parts(offsets: Offsets) -> d.Parts:
    """What is no list, the polygons, and the lists."""
    polygons, step = as_written(offsets.polygons)
    own = {} if offsets.features == "separate" else {"features": offsets.features}
    head = d.head_of(TYPE, own, polygons) | ({LATTICE_STEP: step} if step else {})
    shapes = [
        d.numbers("distance", offsets.distance),
        d.indices("polygon", offsets.polygon, len(polygons)),
        *_ranges("rings", offsets.shape_starts),
    ]
    rings = [
        d.indices("shape", offsets.shape_of_ring),
        d.choices("kind", RING_KINDS, offsets.ring_kind),
        *_ranges("pieces", offsets.ring_starts),
    ]
    pieces = [
        d.choices("kind", PIECE_KINDS, offsets.is_arc),
        d.places("start", offsets.start),
        d.places("end", offsets.end),
        d.places("center", offsets.center, offsets.is_arc),
        d.choices("ccw", (False, True), np.where(offsets.is_arc, offsets.piece_distance > 0, -1)),
        d.indices("site", offsets.site),
    ]
    sites = d.site_members(offsets.site_table)
    return d.Parts(head, polygons, {"sites": sites, "shapes": shapes, "rings": rings, "pieces": pieces})


def _ranges(parts: str, start: NDArray[np.int64]) -> list[d.Member]:
    """The first part of each item, and how many it has."""
    return [d.indices("first", start[:-1]), d.indices(parts, np.diff(start))]


# ---- reading -------------------------------------------------------------------------------------
def read_offsets(source: Source, options: ReadOptions) -> Offsets:
    """Read offset curves."""
    rows = d.opened(source, options, TYPE, NOUN)
    polygons = as_read(d.read_polygons(rows, options), rows.document)
    sites = d.read_sites(rows, polygons)
    distance = rows.numbers("shapes", "distance")
    if not distance.all():
        raise InputError(
            f"{rows.name}, shapes {np.flatnonzero(distance == 0)[0]}: the distance is 0; write a nonzero one"
        )
    start, end, center = _places(rows)
    return Offsets(
        start,
        end,
        center,
        rows.indices("pieces", "site", len(sites)),
        _starts(rows, "rings", "pieces"),
        _starts(rows, "shapes", "rings"),
        distance,
        rows.indices("shapes", "polygon", len(polygons), optional=True),
        sites,
        polygons,
        d.read_features(rows),
    )


def _places(rows: Rows) -> tuple[NDArray[np.float64], ...]:
    """Ends and centers; an arc that few digits have shrunk to its center is a straight line."""
    start, end = (rows.pairs("pieces", name, optional=False) for name in ("start", "end"))
    center = rows.pairs("pieces", "center", optional=True)
    kind = rows.choices("pieces", "kind", PIECE_KINDS)
    unlike = np.flatnonzero(np.isnan(center[:, 0]) == (kind == 1))
    if unlike.size:
        what = ("null", "[x, y]")[kind[unlike[0]]]
        raise InputError(
            f"{rows.name}, pieces {unlike[0]}: the center of {('a line', 'an arc')[kind[unlike[0]]]} is {what}"
        )
    center[(start == center).all(axis=1) | (end == center).all(axis=1)] = np.nan
    return start, end, center


def _starts(rows: Rows, member: str, parts: str) -> NDArray[np.int64]:
    """Where the parts of each item begin: one after the other, all of them."""
    count = rows.count(parts)
    first = rows.indices(member, "first", max(count, 1))
    number = rows.indices(member, parts, count + 1)
    expected = starts_of(number)
    wrong = np.flatnonzero((first != expected[:-1]) | (number < 1))
    if wrong.size or expected[-1] != count:
        at = wrong[0] if wrong.size else len(first) - 1
        raise InputError(
            f"{rows.name}, {member} {at}: the {parts} should begin where those of the previous row end; list all"
        )
    return expected
