"""Writing centerlines."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.polygons.polylines import Wording, geojson_wording, wkt_wording, write_polylines
from vorotool.formats.text.tables import write_table
from vorotool.geometry.skeleton.centerline import Centerlines, centerline_table
from vorotool.geometry.skeleton.extended import extended_table
from vorotool.geometry.skeleton.led_on import LedOn
from vorotool.geometry.skeleton.smooth_lines import SmoothLines
from vorotool.geometry.table import Table
from vorotool.products.formats import TABLES


def write_centerlines(
    out: BinaryIO,
    lines: LedOn | SmoothLines,
    fmt: str,
    *,
    flatten: float | None = None,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write centerlines, skeletons with their ends, or smooth lines; the bytes depend on these alone."""
    if fmt in TABLES:
        write_table(out, _table(lines), fmt, precision=precision, threads=threads)
        return
    points, start = lines.as_given.flattened(flatten)
    wording = wkt_wording(len(lines)) if fmt == "wkt" else _features(lines)
    write_polylines(out, points, start[:-1], wording, precision=precision, threads=threads)


def _table(lines: LedOn | SmoothLines) -> Table:
    if isinstance(lines, SmoothLines):
        return lines.table()
    return centerline_table(lines) if isinstance(lines, Centerlines) else extended_table(lines)


def _features(lines: LedOn | SmoothLines) -> Wording:
    is_part = not isinstance(lines.lines if isinstance(lines, SmoothLines) else lines, Centerlines)
    return geojson_wording(lines.path.polygons, lines.polygon, _columns(lines), is_part=is_part)


def _columns(lines: LedOn | SmoothLines) -> dict[str, NDArray[Any]]:
    """Properties of each line."""
    if isinstance(lines, SmoothLines):
        branch = {} if isinstance(lines.lines, Centerlines) else {"branch": np.arange(len(lines))}
        return {**branch, "curves": np.diff(lines.start), "error": lines.error}
    branch = {} if isinstance(lines, Centerlines) else {"branch": np.arange(len(lines))}
    least, most = lines.width_range
    return {
        **branch,
        "length": lines.length,
        "width_mean": lines.width_mean,
        "width_min": least,
        "width_max": most,
    }
