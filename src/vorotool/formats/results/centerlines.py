"""Writing centerlines."""

from __future__ import annotations

from typing import BinaryIO

from vorotool.formats.polygons.polylines import geojson_wording, wkt_wording, write_polylines
from vorotool.formats.text.tables import write_table
from vorotool.geometry.curves.flatten import checked_flatten
from vorotool.geometry.skeleton.centerline import Centerlines, centerline_table
from vorotool.products.formats import TABLES


def write_centerlines(
    out: BinaryIO,
    lines: Centerlines,
    fmt: str,
    *,
    flatten: float | None = None,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    r"""Write centerlines; the bytes depend on nothing but the lines and the options.

    GeoJSON and WKT have one LineString a polygon, in GeoJSON with its id and properties, ``length``, ``width_mean``,
    ``width_min`` and ``width_max``; CSV, JSON and NPZ one row an arc (see
    :func:`vorotool.geometry.skeleton.centerline.centerline_table`).

    Parameters
    ----------
    out, precision, threads
        As of `vorotool.formats.text.tables.write_table`.
    lines : Centerlines
        What to write.
    fmt : {"geojson", "csv", "tsv", "json", "npz", "wkt"}
        The format.
    flatten : float, optional
        As of `vorotool.formats.results.skeletons.write_skeleton`.

    Examples
    --------
    >>> import io
    >>> from vorotool import centerline, prune, skeleton_exact
    >>> lines = centerline(prune(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]), angle=100))
    >>> out = io.BytesIO()
    >>> write_centerlines(out, lines, "wkt")
    >>> out.getvalue()
    b'LINESTRING (0 1, 4 1)\n'
    """
    if fmt in TABLES:
        write_table(out, centerline_table(lines), fmt, precision=precision, threads=threads)
        return
    points, start = lines.flattened(checked_flatten(flatten, lines.path.polygons))
    least, most = lines.width_range
    own = {"length": lines.length, "width_mean": lines.width_mean, "width_min": least, "width_max": most}
    wording = (
        wkt_wording(len(lines))
        if fmt == "wkt"
        else geojson_wording(
            lines.path.polygons, lines.polygon.tolist(), {name: column.tolist() for name, column in own.items()}
        )
    )
    write_polylines(out, points, start[:-1], wording, precision=precision, threads=threads)
