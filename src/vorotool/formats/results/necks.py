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
    """Write necks: in GeoJSON and WKT the cuts, in tables one row a neck."""
    if fmt in TABLES:
        write_table(out, necks.table(), fmt, precision=precision, threads=threads)
        return
    own = {"width": necks.width, "ratio": necks.ratio, "r_smaller": necks.beside[:, 0], "r_larger": necks.beside[:, 1]}
    wording = (
        wkt_wording(len(necks))
        if fmt == "wkt"
        else geojson_wording(necks.skeleton.polygons, necks.polygon, own, is_part=True)
    )
    start = 2 * np.arange(len(necks))
    write_polylines(out, necks.feet.reshape(-1, 2), start, wording, precision=precision, threads=threads)


def write_parts(out: BinaryIO, parts: Parts, fmt: str, *, precision: int | None = None, threads: int = 0) -> None:
    """Write the parts of polygons, in tables one row a piece."""
    if fmt in ("csv", "tsv", "npz"):
        write_table(out, parts.table(), fmt, precision=precision, threads=threads)
    else:
        write_polygons(out, parts.described(), fmt)
