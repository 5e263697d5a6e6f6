"""Polylines as text, streamed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.text_rows import Column, RowShape, write_rows
from vorotool.geometry.table import Lookup


def write_polylines(
    out: BinaryIO,
    points: NDArray[np.float64],
    start: NDArray[np.integer],
    openings: Sequence[str],
    texts: tuple[str, str, str],
    *,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    r"""Write polylines, each after its own text: one row a point, before it a comma, or an end and an opening.

    Parameters
    ----------
    out : binary file object
        Need not be seekable.
    points : (n, 2) float64 array
        Of all polylines, one after the other.
    start : (l,) integer array
        Where each begins; each has a point.
    openings : sequence of str
        What stands before each.
    texts : tuple of str
        What stands between points, between coordinates, and after each polyline; after the last one without a final
        comma and line end, which then ends the line.
    precision : int, optional
        Significant digits; by default the shortest that reads back the same.
    threads : int
        0 for all.

    Examples
    --------
    >>> import io
    >>> out = io.BytesIO()
    >>> places = np.array([[0.0, 0.0], [1.0, 0.5], [2.0, 2.0]])
    >>> write_polylines(out, places, np.array([0, 2]), ["A (", "B ("], (", ", " ", ")\n"))
    >>> out.getvalue()
    b'A (0 0, 1 0.5)\nB (2 2)\n'
    """
    if not len(points):
        return
    comma, space, closing = texts
    opens = np.zeros(len(points), dtype=bool)
    opens[start] = True
    before = [comma, *(closing + text if k else text for k, text in enumerate(openings))]
    token = np.where(opens, np.cumsum(opens), 0).astype(np.int32)
    columns = [Column("", Lookup(before, token)), *(Column("", values.copy()) for values in points.T)]
    write_rows(out, columns, RowShape(("", "", space, "")), precision=precision, threads=threads)
    out.write(closing.rstrip(",\n").encode() + b"\n")
