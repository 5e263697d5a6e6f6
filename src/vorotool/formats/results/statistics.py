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
    """Write the measures of cells, or their summary.

    Parameters
    ----------
    out, fmt, precision, threads
        As of `vorotool.formats.text.tables.write_table`.
    found : CellStatistics
        What to write.
    what : {"statistics", "measures"}
        The summary, with one row a measure, or one row a cell.

    Examples
    --------
    >>> import io, vorotool
    >>> out = io.BytesIO()
    >>> write_statistics(out, vorotool.cell_statistics([[0, 0], [4, 0], [0, 3]]), "csv", what="measures")
    >>> out.getvalue().splitlines()[0]
    b'label,x,y,area,perimeter,roundness,neighbours,nearest_distance,whole'
    """
    write_table(out, found.cells if what == "measures" else found.summary, fmt, precision=precision, threads=threads)
