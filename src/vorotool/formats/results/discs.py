"""Writing discs, in every format that has a place for them."""

from __future__ import annotations

from typing import BinaryIO

from vorotool.formats.polygons.writer import write_polygons
from vorotool.formats.text.tables import write_table
from vorotool.geometry.skeleton.discs import Discs
from vorotool.products.formats import TABLES


def write_discs(
    out: BinaryIO,
    discs: Discs,
    fmt: str,
    *,
    flatten: float | None = None,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a row or a feature a disc."""
    if fmt in TABLES:
        write_table(out, discs.table(), fmt, precision=precision, threads=threads)
        return
    write_polygons(out, discs.flattened(flatten), fmt)
