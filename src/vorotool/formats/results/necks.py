"""Writing necks, and the parts of polygons between them."""

from __future__ import annotations

from typing import BinaryIO

import numpy as np

from vorotool.formats.polygons.polylines import geojson_wording, wkt_wording, write_polylines
from vorotool.formats.polygons.writer import write_polygons
from vorotool.formats.text.tables import write_table
from vorotool.geometry.skeleton.necks import Necks
from vorotool.geometry.skeleton.parts import Parts
from vorotool.products.formats import TABLES


def write_necks(out: BinaryIO, necks: Necks, fmt: str, *, precision: int | None = None, threads: int = 0) -> None:
    r"""Write necks: in GeoJSON and WKT the cuts, in tables one row a neck.

    Parameters
    ----------
    out, precision, threads
        As of `vorotool.formats.text.tables.write_table`.
    necks : Necks
        What to write, in its order.
    fmt : {"csv", "tsv", "json", "npz", "geojson", "wkt"}
        The first four are of tables. GeoJSON has the id and the properties of the polygon, ``width``, ``ratio``,
        ``r_smaller`` and ``r_larger``.

    Examples
    --------
    >>> import io
    >>> from vorotool import necks
    >>> out = io.BytesIO()
    >>> write_necks(out, necks([[0, 0], [10, 0], [10, 4], [6, 2], [0, 4]]), "wkt")
    >>> out.getvalue()
    b'LINESTRING (6 0, 6 2)\n'
    """
    if fmt in TABLES:
        write_table(out, necks.table(), fmt, precision=precision, threads=threads)
        return
    own = {"width": necks.width, "ratio": necks.ratio, "r_smaller": necks.beside[:, 0], "r_larger": necks.beside[:, 1]}
    described = {name: column.tolist() for name, column in own.items()}
    wording = (
        wkt_wording(len(necks))
        if fmt == "wkt"
        else geojson_wording(necks.skeleton.polygons, necks.polygon.tolist(), described)
    )
    start = 2 * np.arange(len(necks))
    write_polylines(out, necks.feet.reshape(-1, 2), start, wording, precision=precision, threads=threads)


def write_parts(out: BinaryIO, parts: Parts, fmt: str, *, precision: int | None = None, threads: int = 0) -> None:
    r"""Write the parts of polygons, in tables one row a piece.

    Parameters
    ----------
    out, precision, threads
        As of `vorotool.formats.text.tables.write_table`.
    parts : Parts
        What to write, in its order.
    fmt : {"csv", "tsv", "npz", "geojson", "json", "wkt", "poly"}
        The first three are of tables. GeoJSON and JSON have the id and the properties of the polygon, ``piece``,
        ``polygon``, ``area``, ``width``, ``cuts`` and ``neighbours``.

    Examples
    --------
    >>> import io
    >>> from vorotool import parts
    >>> out = io.BytesIO()
    >>> write_parts(out, parts([[0, 0], [10, 0], [10, 4], [6, 2], [0, 4]], neck=1), "wkt")
    >>> out.getvalue().splitlines()[1]
    b'POLYGON ((6 0, 10 0, 10 4, 6 2, 6 0))'
    """
    if fmt in ("csv", "tsv", "npz"):
        write_table(out, parts.table(), fmt, precision=precision, threads=threads)
    else:
        write_polygons(out, parts.described(), fmt)
