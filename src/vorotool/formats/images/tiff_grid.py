"""The grid of the pixels of a TIFF: OME-XML, ImageJ, GeoTIFF, and resolution, as they are read from its tags."""

from __future__ import annotations

import re
from fractions import Fraction
from math import isfinite
from typing import Any

from vorotool.errors import InputError
from vorotool.formats.images.ome_xml import ome_sizes, states_one_side
from vorotool.numeric.crs import crs_member
from vorotool.plain import plain
from vorotool.types.pixel_grid import GeoKeys, PixelGrid, Transform, map_grid

PIXEL_SCALE, TIEPOINT, TRANSFORMATION = 33550, 33922, 34264
DIRECTORY, DOUBLES, TEXT, NODATA = 34735, 34736, 34737, 42113
"""Tags of GeoTIFF 1.1 (OGC 19-008r4), and that of GDAL for pixels without a value."""

MODEL_TYPE, RASTER_TYPE, GEOGRAPHIC, ANGULAR_UNIT, PROJECTED, LINEAR_UNIT = 1024, 1025, 2048, 2054, 3072, 3076
"""Keys of its directory."""

IS_GEOGRAPHIC, IS_POINT, USER_DEFINED = 2, 2, 32767

_UNITS = {2: "inch", 3: "cm"}
_LINEAR_UNITS = {9001: "m", 9002: "ft", 9003: "US survey ft"}
_DEGREE = 9102
_IMAGEJ_STEPS = 10**6
"""ImageJ states pixels a unit in millionths."""


@plain
class PageGrid:
    """What a page says of its pixels."""

    grid: PixelGrid | None = None  # their sides and places
    nodata: float | None = None  # pixels with this value have none
    note: str = ""  # what of it is not used


def grid_of(name: str, file: Any, page: Any) -> PageGrid:
    """Read what a page of a TIFF file says of its pixels."""
    nodata = _nodata(page)
    transform, note = _transform(name, page)
    if transform is not None:
        keys = _keys(page)
        unit, crs = _system(keys)
        if crs is None and keys is not None and {GEOGRAPHIC, PROJECTED} & set(_entries(keys)):
            note = (
                f"{name} is in a coordinate reference system without an EPSG code: vector files written from it state "
                "no system"
            )
        return PageGrid(map_grid(transform, unit=unit, crs=crs, keys=keys), nodata, note)
    ome = _ome_grid(file)
    one = "" if ome is None else states_one_side(file.pages[0].description)
    if one:
        note = f"{name} states only {one}: pixels are assumed to be squares"
    return PageGrid(ome or _resolution_grid(file, page), nodata, note)


def _ome_grid(file: Any) -> PixelGrid | None:
    sizes = ome_sizes(file.pages[0].description) if file.is_ome else None
    return None if sizes is None else PixelGrid(*sizes, "ome")


def _resolution_grid(file: Any, page: Any) -> PixelGrid | None:
    """The sides by pixels a unit; ImageJ names the unit in the description."""
    if "XResolution" not in page.tags or "YResolution" not in page.tags:
        return None
    per_unit = [page.tags[name].value for name in ("XResolution", "YResolution")]
    if any(denominator == 0 or numerator == 0 for numerator, denominator in per_unit):
        return None
    unit = _UNITS.get(int(page.tags.valueof("ResolutionUnit", default=2)))
    named = (file.imagej_metadata or {}).get("unit") if file.is_imagej else None
    if named and str(named).strip() in ("pixel", "pixels"):
        return None
    if named:
        width, height = (side_of_imagej(*each) for each in per_unit)
        return PixelGrid(width, height, unescaped(str(named)), "imagej")
    width, height = (Fraction(units, pixels) for pixels, units in per_unit)
    return None if unit is None else PixelGrid(width, height, unit)


def unescaped(text: str) -> str:
    """Undo how ImageJ writes letters that are not ASCII."""
    return re.sub(r"\\u([0-9a-fA-F]{4})", lambda match: chr(int(match[1], 16)), text)


def side_of_imagej(pixels: int, units: int) -> Fraction:
    """Give the side of a pixel: of those that ImageJ would write as this ratio, the one with the fewest digits."""
    exact = Fraction(units, pixels)
    if units != _IMAGEJ_STEPS:
        return exact
    for digits in range(1, 17):
        short = Fraction(f"{float(exact):.{digits}g}")
        if short and abs(1 / short - Fraction(pixels, units)) * 2 <= Fraction(1, units):
            return short
    return exact


def _transform(name: str, page: Any) -> tuple[Transform | None, str]:
    """From columns and rows of corners to places on the map; and what is left out."""
    matrix = _numbers(name, page, TRANSFORMATION, "ModelTransformation", 16)
    scale = _numbers(name, page, PIXEL_SCALE, "ModelPixelScale", 3)
    ties = _numbers(name, page, TIEPOINT, "ModelTiepoint", 6)
    if matrix is not None:
        a, b, _, c, d, e, _, f = matrix[:8]
    elif scale is not None and ties is not None:
        column, row, _, x, y = ties[:5]
        a, b, d, e = scale[0], 0.0, 0.0, -scale[1]
        c, f = x - column * a, y - row * e
    else:
        note = f"{name} is placed by control points, which are not used" if ties is not None else ""
        return None, note
    if a * e == b * d:
        raise InputError(f"{name} is damaged: its pixels have no area on the map; remove its georeference to read it")
    if _raster_type(page) == IS_POINT:  # numbers of pixels are those of their centers
        c, f = c - (a + b) / 2, f - (d + e) / 2
    return (a, b, c, d, e, f), ""


def _numbers(name: str, page: Any, tag: int, words: str, count: int) -> tuple[float, ...] | None:
    """Values of a tag; None where there is none."""
    value = page.tags.valueof(tag)
    if value is None:
        return None
    values = value if isinstance(value, tuple) else (value,)
    try:
        numbers = tuple(float(each) for each in values)
    except (TypeError, ValueError):
        numbers = ()
    if len(numbers) < count or not all(map(isfinite, numbers)):
        raise InputError(
            f"{name} is damaged: its {words} does not have {count} finite numbers; remove its georeference"
        )
    return numbers


def _raster_type(page: Any) -> int | None:
    keys = _keys(page)
    return None if keys is None else _entries(keys).get(RASTER_TYPE)


def _keys(page: Any) -> GeoKeys | None:
    directory = page.tags.valueof(DIRECTORY)
    if not isinstance(directory, tuple) or len(directory) < 4 or not all(isinstance(each, int) for each in directory):
        return None
    doubles = page.tags.valueof(DOUBLES)
    doubles = doubles if isinstance(doubles, tuple) else () if doubles is None else (doubles,)
    text = page.tags.valueof(TEXT)
    return GeoKeys(directory, tuple(map(float, doubles)), text if isinstance(text, str) else "")


def _entries(keys: GeoKeys) -> dict[int, int]:
    """Keys whose values are in the directory itself."""
    rows = zip(*(keys.directory[4 + k :: 4] for k in range(4)), strict=False)
    return {key: value for key, place, _, value in rows if place == 0}


def _system(keys: GeoKeys | None) -> tuple[str | None, Any]:
    """The unit, and the ``crs`` member of GeoJSON for the code of the system, if it has one."""
    if keys is None:
        return None, None
    entries = _entries(keys)
    is_geographic = entries.get(MODEL_TYPE) == IS_GEOGRAPHIC
    code = entries.get(GEOGRAPHIC if is_geographic else PROJECTED, USER_DEFINED)
    crs = crs_member(f"EPSG:{code}") if 1024 <= code < USER_DEFINED else None
    if is_geographic:
        return ("deg" if entries.get(ANGULAR_UNIT, _DEGREE) == _DEGREE else None), crs
    linear = entries.get(LINEAR_UNIT)
    return (_LINEAR_UNITS.get(linear) if linear is not None else "m" if crs is not None else None), crs


def _nodata(page: Any) -> float | None:
    """GDAL writes the value as text."""
    text = page.tags.valueof(NODATA)
    match = re.match(r"\s*([-+]?(?:nan|[0-9.]+(?:e[-+]?[0-9]+)?))\s*\0*", str(text), re.IGNORECASE)
    try:
        return None if text is None or match is None else float(match[1])
    except ValueError:
        return None
