"""Writing polygons and open lines, whatever the format."""

from __future__ import annotations

from collections.abc import Callable
from typing import BinaryIO

from vorotool.formats.polygons.geojson import write_geojson
from vorotool.formats.polygons.json import write_json
from vorotool.formats.polygons.poly import write_poly
from vorotool.formats.polygons.wkt import write_wkt
from vorotool.formats.written.polygons import written_polygons
from vorotool.geometry.polygons.polygon_set import PolygonSet

_WRITERS: dict[str, Callable[[BinaryIO, PolygonSet], None]] = {
    "json": write_json,
    "geojson": write_geojson,
    "wkt": write_wkt,
    "poly": write_poly,
}


def write_polygons(out: BinaryIO, polygons: PolygonSet, fmt: str) -> None:
    r"""Write polygons and lines; polygons are valid on the grid of the file.

    The parts of a feature become one multi-part geometry, but in JSON, which numbers them. WKT and ``.poly`` have no
    place for ids and properties; ``.poly`` has none for features either.

    Parameters
    ----------
    out : binary file object
        Need not be seekable.
    polygons : PolygonSet
        What to write.
    fmt : {"json", "geojson", "wkt", "poly"}
        The format.

    Examples
    --------
    >>> import io
    >>> from vorotool.geometry.arguments.polygons import as_polygons
    >>> out = io.BytesIO()
    >>> write_polygons(out, as_polygons([[0, 0], [4, 0.5], [0, 3]]), "wkt")
    >>> out.getvalue()
    b'POLYGON ((0 0, 4 0.5, 0 3, 0 0))\n'
    """
    _WRITERS[fmt](out, written_polygons(polygons))
