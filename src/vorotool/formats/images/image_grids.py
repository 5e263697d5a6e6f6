"""The grid of the pixels of an image: tags of a TIFF (OME-XML, ImageJ, GeoTIFF, resolution), or a world file."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from math import isfinite, isnan
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.images.ome_xml import ome_sizes, ome_xml, states_one_side
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.sources import STANDARD_INPUT
from vorotool.frozen import frozen
from vorotool.numeric.crs import crs_member, crs_name, is_geographic
from vorotool.numeric.length_units import meters
from vorotool.types.images import Raster
from vorotool.types.pixels import GeoKeys, PixelGrid, Transform, map_grid

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


@frozen
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
    sizes = ome_sizes(file.pages[0].description) if file.is_ome else None
    ome = None if sizes is None else PixelGrid(*sizes, "ome")
    one = "" if ome is None else states_one_side(file.pages[0].description)
    if one:
        note = f"{name} states only {one}: pixels are assumed to be squares"
    return PageGrid(ome or _resolution_grid(file, page), nodata, note)


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
    if _is_point(_keys(page)):  # numbers of pixels are those of their centers
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


def _is_point(keys: GeoKeys | None) -> bool:
    return keys is not None and _entries(keys).get(RASTER_TYPE) == IS_POINT


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


# ---- pixels without a value ----------------------------------------------------------------------
def tiff_raster(name: str, values: NDArray[Any], about: PageGrid, note: Callable[[str], None]) -> Raster:
    """Make an image of what was read of a TIFF, and say what of it is not used."""
    if about.note:
        note(about.note)
    masked = with_nodata(values, about.nodata)
    return replace(masked, grid=placed_grid(name, about.grid))


def placed_grid(name: str, grid: PixelGrid | None) -> PixelGrid | None:
    """Give the grid of a file, or that of a world file beside it where the file itself is not placed on a map."""
    return grid if grid is not None and grid.transform is not None else world_grid(name) or grid


def with_nodata(values: NDArray[Any], nodata: float | None) -> Raster:
    """Mask the pixels of one value; of those that are not finite the values become 0."""
    missing = missing_values(values, nodata)
    if missing is None:
        return Raster(values)
    if values.dtype.kind == "f":
        values = np.where(missing & ~np.isfinite(values), values.dtype.type(0), values)
    mask: NDArray[np.bool_] = np.asarray(missing.all(axis=2)) if missing.ndim == 3 else missing
    return Raster(values, mask=mask)


def missing_values(values: NDArray[Any], nodata: float | None) -> NDArray[np.bool_] | None:
    """Tell which values stand for none; None where no value does."""
    if nodata is None:
        return None
    missing: NDArray[np.bool_] = np.isnan(values) if isnan(nodata) else values == nodata
    return missing if missing.any() else None


# ---- tags that are written -----------------------------------------------------------------------
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
    if _is_point(keys):
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


_LONGEST = 4096
"""Bytes; six numbers need some hundred."""


def world_grid(name: str) -> PixelGrid | None:
    """Read the grid of an image from the world file beside it; None where there is none, or the image is a stream."""
    if name == STANDARD_INPUT or stream_kind(name) is not None:
        return None
    for path in _candidates(Path(name)):
        try:
            with path.open("rb") as file:
                data = file.read(_LONGEST + 1)
        except (OSError, ValueError):
            continue
        return _parsed(str(path), data)
    return None


def world_text(transform: Transform) -> bytes:
    """Write the six numbers of a world file, whose place is that of the center of the first pixel."""
    a, b, x, d, e, y = map(float, transform)
    numbers = (a, d, b, e, x + (a + b) / 2, y + (d + e) / 2)
    return "".join(f"{number!r}\n" for number in numbers).encode("ascii")


def _candidates(image: Path) -> Iterator[Path]:
    letters = image.suffix[1:]
    endings = [f"{letters[0]}{letters[-1]}w", f"{letters}w"] if letters else []
    for ending in dict.fromkeys([*endings, "wld"]):
        for each in dict.fromkeys((ending.lower(), ending.upper())):
            yield image.with_suffix(f".{each}")


def _parsed(name: str, data: bytes) -> PixelGrid:
    try:
        numbers = [float(text) for text in data.decode("ascii").replace(",", ".").split()]
    except ValueError:
        numbers = []
    if len(data) > _LONGEST or len(numbers) != 6 or not all(map(isfinite, numbers)):
        raise InputError(
            f"{name} is not a world file: it should have six lines of one number each; correct or remove it"
        )
    a, d, b, e, x, y = numbers  # the place is that of the center of the first pixel
    if a * e == b * d:
        raise InputError(f"{name} states pixels without an area: correct or remove it")
    return map_grid((a, b, x - (a + b) / 2, d, e, y - (d + e) / 2))
