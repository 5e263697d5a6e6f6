"""Skeletons as JSON and as NPZ, version 1: all that they hold."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions, shortened
from vorotool.formats.results import documents as d
from vorotool.formats.results.documents import LATTICE_STEP, as_read, as_written
from vorotool.formats.results.rows import Rows, is_number
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import KINDS, SIDES, Skeleton

TYPE = "vorotool.skeleton"
_SITES = ("site_a", "site_b")


# ---- writing -------------------------------------------------------------------------------------
def write_skeleton(
    out: BinaryIO, skeleton: Skeleton, fmt: str, *, precision: int | None = None, threads: int = 0
) -> None:
    """Write polygons, sites, vertices and arcs; no polygon, side or source is null, or -1."""
    d.write_document(out, _parts(skeleton), fmt, precision=precision, threads=threads)


def _parts(skeleton: Skeleton) -> d.Parts:
    """What is no list, the polygons, and the lists."""
    polygons, step = as_written(skeleton.polygons)
    own: dict[str, Any] = {} if skeleton.frame is None else {"frame": list(skeleton.frame)}
    usual = {"border": "closed", "gap": 0, "features": "separate"}
    own |= {name: getattr(skeleton, name) for name, value in usual.items() if getattr(skeleton, name) != value}
    head = d.head_of(TYPE, own, polygons) | ({LATTICE_STEP: step} if step else {})
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
    rows = d.opened(source, options, TYPE, "skeleton")
    polygons = as_read(d.read_polygons(rows, options), rows.document)
    skeleton = _arcs(rows, polygons.as_given)
    return skeleton if polygons.as_given is polygons else skeleton.with_corners(polygons)


def _arcs(rows: Rows, polygons: PolygonSet) -> Skeleton:
    sites = d.read_sites(rows, polygons)
    ends = [rows.indices("arcs", name, rows.count("vertices")) for name in ("source", "target")]
    kind = rows.choices("arcs", "kind", KINDS)
    control = rows.pairs("arcs", "control", optional=True)
    unlike = np.flatnonzero(np.isnan(control[:, 0]) == (kind == 1))
    if unlike.size:
        what = "null" if kind[unlike[0]] == 0 else "[x, y]"
        raise InputError(f"{rows.name}, arcs {unlike[0]}: the control point of a {KINDS[kind[unlike[0]]]} is {what}")
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
        _gap(rows),
        d.read_features(rows),
        border=_border(rows),
    )


def _border(rows: Rows) -> str:
    value = rows.document.get("border", "closed")
    if value not in ("closed", "open"):
        raise InputError(f"{rows.name}: the border is {shortened(value)}; write closed or open")
    return str(value)


def _gap(rows: Rows) -> float:
    value = rows.document.get("gap", 0)
    if not is_number(value) or not value >= 0:
        raise InputError(f"{rows.name}: the gap is {shortened(value)}; write a length")
    return float(value)
