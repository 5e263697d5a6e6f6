"""Writing offset curves, in every format that has a place for them."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.polygons.writer import write_polygons
from vorotool.formats.results.offset_json import write_json
from vorotool.formats.text.tables import write_arrays, write_table
from vorotool.geometry.skeleton.offsets import Offsets
from vorotool.types.axis import MEMBER as Y_AXIS


def write_offsets(
    out: BinaryIO,
    offsets: Offsets,
    fmt: str,
    *,
    flatten: float | None = None,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write offset curves; the bytes depend on nothing but these and the options."""
    if fmt in ("csv", "tsv"):
        write_table(out, offsets.table(), fmt, precision=precision, threads=threads)
    elif fmt == "json":
        write_json(out, offsets, precision=precision, threads=threads)
    elif fmt == "npz":
        write_arrays(out, offset_arrays(offsets), threads=threads)
    else:
        write_polygons(out, offsets.flattened(flatten), fmt)


def offset_arrays(offsets: Offsets) -> dict[str, NDArray[Any]]:
    """1-D arrays of pieces, rings and shapes; no polygon is -1, the center of a line NaN."""
    places = {"x0": offsets.start, "x1": offsets.end, "cx": offsets.center}
    return {
        **{f"piece_{name}": values[:, 0] for name, values in places.items()},
        **{f"piece_{name.replace('x', 'y')}": values[:, 1] for name, values in places.items()},
        Y_AXIS: np.array([offsets.y_axis]),
        "piece_site": offsets.site,
        "ring_start": offsets.ring_start,
        "shape_start": offsets.shape_start,
        "shape_distance": offsets.distance,
        "shape_polygon": offsets.polygon,
        **{f"site_{name}": getattr(offsets.site_table, name) for name in ("kind", "polygon", "ring", "index")},
    }
