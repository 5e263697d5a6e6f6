"""Skeletons, and offset curves, as JSON and as NPZ, version 1: all that they hold."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.results import documents as d
from vorotool.formats.results.documents import LATTICE_STEP, as_read, as_written
from vorotool.formats.results.rows import Rows, is_number
from vorotool.numeric.arrays import starts_of
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.offsets import PIECE_KINDS, RING_KINDS, Offsets
from vorotool.types.skeleton.skeleton import KINDS, SIDES, Skeleton

_SKELETON = "vorotool.skeleton"
_SITES = ("site_a", "site_b")


# ---- writing -------------------------------------------------------------------------------------
def write_skeleton(out: BinaryIO, skeleton: Skeleton, fmt: str) -> None:
    """Write polygons, sites, vertices and arcs; no polygon, side or source is null, or -1."""
    d.write_document(out, _parts_of_skeleton(skeleton), fmt)


def _parts_of_skeleton(skeleton: Skeleton) -> d.Parts:
    """What is no list, the polygons, and the lists."""
    polygons, step = as_written(skeleton.polygons)
    own: dict[str, Any] = {} if skeleton.frame is None else {"frame": list(skeleton.frame)}
    usual = {"border": "closed", "gap": 0, "features": "separate"}
    own |= {name: getattr(skeleton, name) for name, value in usual.items() if getattr(skeleton, name) != value}
    head = d.head_of(_SKELETON, own, polygons) | ({LATTICE_STEP: step} if step else {})
    placed = skeleton.as_given if step else skeleton
    vertices = [*map(d.numbers, "xy", placed.vertices.T), d.numbers("r", skeleton.radius)]
    arcs = [
        *map(d.indices, ("source", "target"), skeleton.arcs.T),
        d.choices("kind", KINDS, skeleton.is_parabola),
        d.places("control", skeleton.control, skeleton.is_parabola),
        d.index_pairs("sites", skeleton.sites, _SITES),
        d.choices("side", SIDES, skeleton.side),
        d.numbers("error_bound", skeleton.error_bound),
        d.indices("polygon", skeleton.polygon, len(skeleton.polygons)),
        d.indices("branch", skeleton.branch),
        d.numbers("length", skeleton.length),
    ]
    return d.Parts(head, polygons, {"sites": d.site_members(skeleton.site_table), "vertices": vertices, "arcs": arcs})


# ---- reading -------------------------------------------------------------------------------------
def read_skeleton(source: Source, options: ReadOptions) -> Skeleton:
    """Read a skeleton."""
    rows = d.opened(source, options, _SKELETON, "skeleton")
    polygons = as_read(d.read_polygons(rows, options), rows.document)
    skeleton = _arcs(rows, polygons.as_given)
    return skeleton if polygons.as_given is polygons else skeleton.with_corners(polygons)


def _arcs(rows: Rows, polygons: PolygonSet) -> Skeleton:
    sites = d.read_sites(rows, polygons)
    ends = [rows.indices("arcs", name, rows.count("vertices")) for name in ("source", "target")]
    kind = rows.choices("arcs", "kind", KINDS)
    control = d.optional_pairs(rows, "arcs", "control", kind == 1, lambda at: f"control point of a {KINDS[kind[at]]}")
    branch = rows.indices("arcs", "branch", 2**31 - 1, optional=True)
    length = rows.numbers("arcs", "length", optional=True)
    return Skeleton(
        np.stack([rows.numbers("vertices", axis) for axis in "xy"], axis=1),
        rows.numbers("vertices", "r"),
        np.stack(ends, axis=1),
        control,
        rows.index_pairs("arcs", "sites", _SITES, len(sites)),
        sites,
        rows.indices("arcs", "polygon", len(polygons), optional=True),
        rows.choices("arcs", "side", SIDES, optional=True),
        np.where(branch < 0, np.arange(len(branch)), branch).astype(np.int32),
        np.where(np.isnan(length), 0.0, length),
        rows.numbers("arcs", "error_bound", optional=True),
        polygons,
        None if rows.document.get("frame") is None else d.read_frame(rows),
        float(d.stated(rows, "gap", 0, lambda value: is_number(value) and value >= 0, "the gap is", "a length")),
        d.stated_name(rows, "features", "features are", "separate", "together"),
        border=d.stated_name(rows, "border", "the border is", "closed", "open"),
    )


_OFFSETS = "vorotool.offsets"


# ---- writing offset curves -------------------------------------------------------------------------------------
def write_offsets(out: BinaryIO, offsets: Offsets, fmt: str) -> None:
    """Write polygons, sites, shapes, rings and pieces; no polygon is null, or -1, the center of a line null, or NaN."""
    d.write_document(out, _parts_of_offsets(offsets), fmt)


def _parts_of_offsets(offsets: Offsets) -> d.Parts:
    """What is no list, the polygons, and the lists."""
    polygons, step = as_written(offsets.polygons)
    own = {} if offsets.features == "separate" else {"features": offsets.features}
    head = d.head_of(_OFFSETS, own, polygons) | ({LATTICE_STEP: step} if step else {})
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


# ---- reading offset curves -------------------------------------------------------------------------------------
def read_offsets(source: Source, options: ReadOptions) -> Offsets:
    """Read offset curves."""
    rows = d.opened(source, options, _OFFSETS, "offset curves")
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
        d.stated_name(rows, "features", "features are", "separate", "together"),
    )


def _places(rows: Rows) -> tuple[NDArray[np.float64], ...]:
    """Ends and centers; an arc that few digits have shrunk to its center is a straight line."""
    start, end = (rows.pairs("pieces", name, optional=False) for name in ("start", "end"))
    is_arc = rows.choices("pieces", "kind", PIECE_KINDS) == 1
    words = ("center of a line", "center of an arc")
    center = d.optional_pairs(rows, "pieces", "center", is_arc, lambda at: words[int(is_arc[at])])
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
