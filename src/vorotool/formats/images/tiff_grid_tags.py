"""The grid of the pixels of an image as tags of a TIFF: resolution, the descriptions of ImageJ and OME, GeoTIFF."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np

from vorotool.formats.images.ome_xml import ome_xml
from vorotool.formats.images.tiff_grid import (
    DIRECTORY,
    DOUBLES,
    GEOGRAPHIC,
    IS_GEOGRAPHIC,
    IS_POINT,
    MODEL_TYPE,
    NODATA,
    PIXEL_SCALE,
    PROJECTED,
    RASTER_TYPE,
    TEXT,
    TIEPOINT,
    TRANSFORMATION,
)
from vorotool.numeric.crs import crs_name, is_geographic
from vorotool.numeric.length_units import meters
from vorotool.types.pixel_grid import GeoKeys, PixelGrid

_LARGEST = 2**32 - 1
"""The largest numerator and denominator."""

_INCHES, _CENTIMETERS, NO_UNIT = 2, 3, 1
_DOUBLE, _SHORT, _ASCII = 12, 3, 2
"""Types of tags."""

_METADATA = 42112
"""The tag of GDAL for further metadata."""

_LARGEST_CODE = 32766
"""Codes of coordinate reference systems are numbers of 16 bits, of which the last are for others."""

_GEOGRAPHIC_CODES = range(4001, 5000)
"""Where EPSG has systems of longitude and latitude, beside few that are none."""

Tag = tuple[int, int, int, Any, bool]


def grid_tags(
    grid: PixelGrid | None, shape: tuple[int, int], dtype: np.dtype[Any], *, nodata: int | None = None
) -> dict[str, Any]:
    """Arguments of tifffile that say of an image what the file of another said of its pixels."""
    if grid is None:
        return {}
    if grid.transform is not None:
        tags = _map_tags(grid)
        if nodata is not None:
            tags.append((NODATA, _ASCII, 0, str(nodata), True))
        return {"extratags": tags}
    if grid.form == "imagej":
        ratios = [ratio_of(float(1 / side)) for side in (grid.width, grid.height)]
        description = f"ImageJ=1.54f\nunit={imagej_unit(str(grid.unit))}\n".encode("ascii")
        return {} if None in ratios else {**resolution(ratios, NO_UNIT), "description": description}
    xml = None
    if grid.form == "ome":
        xml = ome_xml(shape, dtype, grid.width, grid.height, "in" if grid.unit == "inch" else grid.unit or "µm")
    return {**resolution_tags(grid), **({} if xml is None else {"description": xml})}


def scale_tag(scale: float) -> Tag:
    """State what values are multiplied by, as GDAL does."""
    item = f'<Item name="SCALE" sample="0" role="scale">{scale!r}</Item>'
    return (_METADATA, _ASCII, 0, f"<GDALMetadata>{item}</GDALMetadata>", True)


def imagej_unit(unit: str) -> str:
    """Write a unit as ImageJ does, in ASCII."""
    plain = "um" if unit == "µm" else unit
    return "".join(letter if letter.isascii() else f"\\u{ord(letter) % 2**16:04x}" for letter in plain)


def resolution_tags(grid: PixelGrid) -> dict[str, Any]:
    """Pixels a unit; TIFF knows inches, centimeters and units without a name."""
    size = meters(grid.unit)
    number = _INCHES if grid.unit == "inch" else NO_UNIT if size is None else _CENTIMETERS
    units = Fraction(1) if size is None else Fraction(1, 100) / size
    ratios = [ratio_of(float(1 / side) * float(units)) for side in (grid.width, grid.height)]
    return {} if None in ratios else resolution(ratios, number)


def resolution(ratios: list[tuple[int, int] | None], unit: int) -> dict[str, Any]:
    """Give ratios of pixels a unit along x and y, and the number of the unit, as arguments of tifffile."""
    return {"resolution": tuple(ratios), "resolutionunit": unit}


def ratio_of(value: float) -> tuple[int, int] | None:
    """Nearest ratio of two 32-bit integers, as TIFF stores numbers; None beyond what they can tell."""
    if not 1 / _LARGEST <= value <= _LARGEST:
        return None
    return Fraction(value).limit_denominator(min(_LARGEST, int(_LARGEST / value))).as_integer_ratio()


def _map_tags(grid: PixelGrid) -> list[Tag]:
    """Where the pixels are, and in which coordinate reference system."""
    assert grid.transform is not None
    keys = grid.keys or _keys_of(grid.crs)
    a, b, c, d, e, f = grid.transform
    if keys is not None and _is_point(keys):
        c, f = c + (a + b) / 2, f + (d + e) / 2
    if a > 0 > e and b == 0 == d:
        tags = [_doubles(PIXEL_SCALE, (a, -e, 0)), _doubles(TIEPOINT, (0, 0, 0, c, f, 0))]
    else:
        tags = [_doubles(TRANSFORMATION, (a, b, 0, c, d, e, 0, f, 0, 0, 0, 0, 0, 0, 0, 1))]
    if keys is None:
        return tags
    tags.append((DIRECTORY, _SHORT, len(keys.directory), keys.directory, True))
    if keys.doubles:
        tags.append(_doubles(DOUBLES, keys.doubles))
    if keys.text:
        tags.append((TEXT, _ASCII, 0, keys.text, True))
    return tags


def _doubles(tag: int, values: tuple[float, ...]) -> Tag:
    return (tag, _DOUBLE, len(values), tuple(map(float, values)), True)


def _is_point(keys: GeoKeys) -> bool:
    rows = zip(*(keys.directory[4 + k :: 4] for k in range(4)), strict=False)
    return any((key, value) == (RASTER_TYPE, IS_POINT) for key, _, _, value in rows)


def _keys_of(crs: object) -> GeoKeys | None:
    """Give the keys for a coordinate reference system by its code; None of one without."""
    authority, _, code = ("", "", "") if crs is None else crs_name(crs).partition(":")
    longitude_latitude = (authority, code) in (("OGC", "CRS84"), ("CRS", "84"))
    number = 4326 if longitude_latitude else int(code) if authority == "EPSG" and code.isdecimal() else 0
    if not 0 < number <= _LARGEST_CODE:
        return None
    in_degrees = is_geographic(crs) or number in _GEOGRAPHIC_CODES
    entries = [
        (MODEL_TYPE, 0, 1, IS_GEOGRAPHIC if in_degrees else 1),
        (RASTER_TYPE, 0, 1, 1),
        (GEOGRAPHIC if in_degrees else PROJECTED, 0, 1, number),
    ]
    return GeoKeys((1, 1, 0, len(entries), *(value for entry in entries for value in entry)))
