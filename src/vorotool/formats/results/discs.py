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
    r"""Write a row or a feature a disc.

    Parameters
    ----------
    out, precision, threads
        As of `vorotool.formats.text.tables.write_table`.
    discs : Discs
        What to write, in its order.
    fmt : {"csv", "tsv", "json", "npz", "geojson", "wkt"}
        The first four are of tables. GeoJSON and WKT have no circles: these are polygons, in GeoJSON with the id and
        the properties of the polygon, and ``rank``, ``x``, ``y``, ``r`` and ``feet``.
    flatten : float, optional
        How far a chord may be from its circle, in input units; by default 1/2000 of the radius.

    Raises
    ------
    UsageError
        If the tolerance is not positive.

    Examples
    --------
    >>> import io
    >>> from vorotool import largest_discs
    >>> out = io.BytesIO()
    >>> write_discs(out, largest_discs([[0, 0], [4, 0], [4, 4], [0, 4]]), "wkt", flatten=1)
    >>> out.getvalue()
    b'POLYGON ((4 2, 2 4, 0 2, 2 0, 4 2))\n'
    """
    if fmt in TABLES:
        write_table(out, discs.table(), fmt, precision=precision, threads=threads)
        return
    write_polygons(out, discs.flattened(flatten), fmt)
