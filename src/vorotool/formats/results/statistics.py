"""Tables of cells: their measures one by one, and the summary of these."""

from __future__ import annotations

from typing import BinaryIO

from vorotool.formats.text.tables import write_table
from vorotool.geometry.mesh.statistics import CellStatistics


def write_statistics(
    out: BinaryIO,
    found: CellStatistics,
    fmt: str,
    *,
    what: str = "statistics",
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write the measures of cells, or their summary."""
    write_table(out, found.measures if what == "measures" else found.summary, fmt, precision=precision, threads=threads)
