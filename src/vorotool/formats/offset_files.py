"""Writing offset curves, in every format that has a place for them."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.choices import check_format
from vorotool.formats.json_lists import choice, integers, number_or_null, optional_pair, write_list, write_sites
from vorotool.formats.polygon_json import write_items
from vorotool.formats.polygons import write_polygons
from vorotool.formats.tables import json_text, write_arrays, write_table
from vorotool.formats.text_rows import Column
from vorotool.geometry.flattening import checked_flatten
from vorotool.geometry.offsets import PIECE_KINDS, RING_KINDS, Offsets

OFFSET_FORMATS = ("json", "csv", "geojson", "npz", "wkt")
TYPE = "vorotool.offsets"
VERSION = 1


def write_offsets(
    out: BinaryIO,
    offsets: Offsets,
    fmt: str,
    *,
    flatten: float | None = None,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    r"""Write offset curves; the bytes depend on nothing but these and the options.

    JSON (version 1) and NPZ hold all there is, CSV one row a piece. GeoJSON and WKT have no arcs: shapes are polygons,
    those of one polygon at one distance one feature, in GeoJSON with its id, its properties and ``distance``.

    Parameters
    ----------
    out : binary file object
        Need not be seekable.
    offsets : Offsets
        What to write, in its order.
    fmt : {"json", "csv", "geojson", "npz", "wkt"}
        The format.
    flatten : float, optional
        How far a chord may be from its arc, in input units; by default 1/4096 of the larger side of the bounds of the
        polygons.
    precision : int, optional
        Significant digits of floating-point numbers in text; by default the shortest that reads back the same.
    threads : int
        0 for all.

    Raises
    ------
    UsageError
        If there is no such format of them, or the tolerance is not positive.

    Examples
    --------
    >>> import io
    >>> from vorotool import offset
    >>> out = io.BytesIO()
    >>> write_offsets(out, offset([[0, 0], [4, 0], [4, 4], [0, 4]], -1), "wkt")
    >>> out.getvalue()
    b'POLYGON ((1 1, 3 1, 3 3, 1 3, 1 1))\n'
    """
    check_format(fmt, OFFSET_FORMATS, "offset curves")
    if fmt == "csv":
        write_table(out, offsets.table(), fmt, precision=precision, threads=threads)
    elif fmt == "json":
        _write_json(out, offsets, precision, threads)
    elif fmt == "npz":
        write_arrays(out, offset_arrays(offsets), threads=threads)
    else:
        tolerance = checked_flatten(flatten, offsets.polygons)
        write_polygons(out, offsets.flattened(tolerance), fmt, precision=precision)


def offset_arrays(offsets: Offsets) -> dict[str, NDArray[Any]]:
    """1-D arrays of pieces, rings and shapes; no polygon is -1, the centre of a line NaN.

    Examples
    --------
    >>> from vorotool import offset
    >>> offset_arrays(offset([[0, 0], [4, 0], [4, 4], [0, 4]], -1))["piece_x0"].tolist()
    [1.0, 3.0, 3.0, 1.0]
    """
    places = {"x0": offsets.start, "x1": offsets.end, "cx": offsets.centre}
    return {
        **{f"piece_{name}": values[:, 0] for name, values in places.items()},
        **{f"piece_{name.replace('x', 'y')}": values[:, 1] for name, values in places.items()},
        "piece_site": offsets.site,
        "ring_start": offsets.ring_start,
        "shape_start": offsets.shape_start,
        "shape_distance": offsets.distance,
        "shape_polygon": offsets.polygon,
        "site_kind": offsets.site_table.kind,
        "site_polygon": offsets.site_table.polygon,
        "site_ring": offsets.site_table.ring,
        "site_index": offsets.site_table.index,
    }


def _write_json(out: BinaryIO, offsets: Offsets, precision: int | None, threads: int) -> None:
    """Polygons, sites, shapes, rings and pieces, one object a line of text; all indices are 0-based.

    The rings of a shape begin with the ring ``first``, its shell; the pieces of a ring with the piece ``first``.
    """
    polygons = offsets.polygons
    head: dict[str, Any] = {"type": TYPE, "version": VERSION}
    if polygons.y_up:
        head["y_up"] = True
    if polygons.crs is not None:
        head["crs"] = polygons.crs
    out.write(json_text(head).removesuffix("}").encode() + b",\n")
    write_items(out, polygons, precision)
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
        *optional_pair(offsets.is_arc, [values.copy() for values in offsets.centre.T]),
        choice(["null", "true", "false"], np.where(offsets.is_arc, np.where(offsets.piece_distance > 0, 1, 2), 0)),
        integers(offsets.site),
    ]
    around = (
        '{"kind":"', '","start":[', ",", '],"end":[', ",", '],"centre":', "", "", "", "", ',"ccw":', ',"site":', "}",
    )  # fmt: skip
    write_list(out, "pieces", pieces, around, precision=precision, threads=threads)
    out.write(b"}\n")
