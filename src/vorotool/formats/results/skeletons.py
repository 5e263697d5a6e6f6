"""Writing skeletons, in every format that has a place for them."""

from __future__ import annotations

from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.polygons.polylines import Wording, geojson_wording, wkt_wording, write_polylines
from vorotool.formats.results.centerlines import write_centerlines
from vorotool.formats.results.skeleton_files import skeleton_arrays, write_json
from vorotool.formats.text.tables import write_arrays, write_table
from vorotool.geometry.curves.flatten import chained
from vorotool.geometry.skeleton.led_on import LedOn
from vorotool.geometry.skeleton.skeleton import SIDES, Skeleton
from vorotool.geometry.skeleton.smooth_lines import SmoothLines
from vorotool.geometry.skeleton.tables import arc_table, branch_columns, branch_table, element_table, polygon_table
from vorotool.geometry.table import Table
from vorotool.products.formats import TABLES


def write_skeleton(
    out: BinaryIO,
    skeleton: Skeleton | LedOn | SmoothLines,
    fmt: str,
    *,
    what: str = "skeleton",
    flatten: float | None = None,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a skeleton, its branches or a row a polygon; the bytes depend on these alone."""
    if not isinstance(skeleton, Skeleton):
        write_centerlines(out, skeleton, fmt, flatten=flatten, precision=precision, threads=threads)
    elif fmt in TABLES and what not in ("skeleton", "diagram"):
        write_table(out, _table(skeleton, what, threads), fmt, precision=precision, threads=threads)
    elif fmt in ("csv", "tsv"):
        write_table(out, arc_table(skeleton), fmt, precision=precision, threads=threads)
    elif fmt == "json":
        write_json(out, skeleton, precision=precision, threads=threads)
    elif fmt == "npz":
        write_arrays(out, skeleton_arrays(skeleton), threads=threads)
    else:
        first_arcs = np.flatnonzero(np.diff(skeleton.branch, prepend=-1))
        arcs = skeleton.as_given.flattened(flatten)
        points, start = chained(*arcs, first_arcs)
        wording = _wording(skeleton, fmt, first_arcs, threads)
        write_polylines(out, points, start[:-1], wording, precision=precision, threads=threads)


def _table(skeleton: Skeleton, what: str, threads: int) -> Table:
    if what == "elements":
        return element_table(skeleton)
    return (polygon_table if what == "table" else branch_table)(skeleton, threads=threads)


# ---- polylines -----------------------------------------------------------------------------------
def _wording(skeleton: Skeleton, fmt: str, first_arcs: NDArray[np.int64], threads: int) -> Wording:
    if fmt == "wkt":
        return wkt_wording(len(first_arcs))
    columns = branch_columns(skeleton, threads=threads)
    own = {name: columns[name] for name in ("branch", "kind", "length", "r_min", "r_max", "r_mean")}
    own["side"] = [None if number < 0 else SIDES[number] for number in skeleton.side[first_arcs].tolist()]
    return geojson_wording(skeleton.polygons, skeleton.polygon[first_arcs], own, is_part=True)
