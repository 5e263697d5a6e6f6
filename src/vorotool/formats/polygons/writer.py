"""Writing polygons and open lines, whatever the format."""

from __future__ import annotations

from collections.abc import Callable
from typing import BinaryIO

from vorotool.formats.polygons.geojson import write_geojson
from vorotool.formats.polygons.json import write_json
from vorotool.formats.polygons.poly import write_poly
from vorotool.formats.polygons.wkt import write_wkt
from vorotool.formats.written.polygons import written_polygons
from vorotool.types.polygons.polygon_set import PolygonSet

_WRITERS: dict[str, Callable[[BinaryIO, PolygonSet], None]] = {
    "json": write_json,
    "geojson": write_geojson,
    "wkt": write_wkt,
    "poly": write_poly,
}


def write_polygons(out: BinaryIO, polygons: PolygonSet, fmt: str) -> None:
    """Write polygons and lines; polygons are valid on the grid of the file."""
    _WRITERS[fmt](out, written_polygons(polygons))
