"""Writing offset curves, in every format that has a place for them."""

from __future__ import annotations

from typing import BinaryIO

from vorotool.formats.polygons.writer import write_polygons
from vorotool.formats.results.offset_files import offset_arrays, write_json
from vorotool.formats.text.tables import write_arrays, write_table
from vorotool.geometry.skeleton.offsets import Offsets


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
