"""Lengths with a unit in the coordinates of the input: by its file, its coordinate reference system, its pixels."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from vorotool.errors import InputError, UsageError
from vorotool.jobs.options import Options, changed
from vorotool.jobs.units import PixelSize, Sides, in_coordinates, measured, refuse_lengths
from vorotool.products.options import flag, options_of

if TYPE_CHECKING:
    from vorotool.convert.sites import Sites
    from vorotool.numeric.input_unit import InputUnit
    from vorotool.types.pixel_grid import PixelGrid
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.volumes.voxel_frame import VoxelGrid


_USUAL = "give --pixel-size, such as 0.325um, or 1m for coordinates in meters"


def lengths_of_vectors(o: Options, value: PointSet | PolygonSet | Sites) -> Options:
    """Give options in the coordinates of points, lines and polygons; ``--pixel-size auto`` is their unit."""
    from vorotool.numeric.input_unit import unit_of

    if not measured(o) and (o.pixel_size is None or not o.pixel_size.is_auto):
        return o
    unit = unit_of(value)
    if o.pixel_size is not None and o.pixel_size.is_auto:
        o = changed(o, pixel_size=_size_of(o.pixel_size, unit))
    return _converted(o, unit, _shapes(value))


def _shapes(value: PointSet | PolygonSet | Sites) -> PointSet | PolygonSet:
    from vorotool.convert.sites import Sites

    return value.polygons if isinstance(value, Sites) else value


def lengths_of_image(o: Options, grid: PixelGrid | None) -> Options:
    """Give options in pixels of an image, or in the unit of ``--spacing auto``."""
    if not measured(o):
        return o
    unit = None if grid is None else unit_of_grid(grid)
    if grid is None or unit is None:
        if o.pixel_size is not None and o.pixel_size.is_auto:
            sized(grid, o)
        return _refused(o)
    if not unit.is_length:
        return _refused_degrees(o, grid.crs)
    if grid.transform is not None:
        _refuse_places(o)
    sides = unit.side * grid.height, unit.side * grid.width
    if grid.is_square:
        sides = sides[1], sides[1]
    return in_coordinates(o, Sides(unit.unit, sides, _step(o)))


def _refuse_places(o: Options) -> None:
    """Refuse places with a unit in an image on a map, whose own begin in the corner of the image."""
    for name in (name for name in ("frame", "start", "end") if name in measured(o)):
        raise UsageError(f"{flag(o.command, name)} of an image on a map is in its pixels: give numbers without a unit")


def sized(grid: PixelGrid | None, o: Options) -> PixelGrid:
    """Return the grid of an image whose file has to state the size of its pixels."""
    is_spacing = o.pixel_size is not None and o.pixel_size.is_spacing
    instead = "give a number and its unit, such as --pixel-size 0.325um"
    if is_spacing:
        instead = "give numbers and their unit, such as --spacing 0.325,0.5um"
    if grid is None:
        raise InputError(f"the image states no pixel size: {instead}")
    if not grid.is_size:
        dots = f"{float(1 / grid.width):.10g}"
        raise InputError(f"the image states {dots} dots per inch, which is for print, but no pixel size: {instead}")
    return grid


def lengths_of_voxels(o: Options, grid: VoxelGrid | None) -> Options:
    """Give options in voxels of a volume, or in the unit of ``--spacing auto``."""
    if not measured(o):
        return o
    if grid is None or grid.unit is None:
        return _refused(o, "give --spacing, such as 0.325,0.325,1.5um")
    return in_coordinates(o, Sides(grid.unit, grid.sides, _step(o)))


def _step(o: Options) -> Fraction | None:
    """What lengths are counted in at first where distances are in the sides of pixels: their unit."""
    return Fraction(1) if o.pixel_size is not None and o.pixel_size.is_spacing else None


def unit_of_grid(grid: PixelGrid) -> InputUnit | None:
    """Return the unit that the sides of pixels are in; dots an inch are for print."""
    from vorotool.numeric.input_unit import InputUnit, unit_of_crs

    if not grid.is_size:
        return None
    if grid.unit is None:
        return None if grid.crs is None else unit_of_crs(grid.crs)
    return InputUnit(grid.unit)


def side_of_pixel(grid: PixelGrid | None) -> InputUnit | None:
    """Return the side of a pixel, if it is known of pixels that are squares."""
    unit = None if grid is None or not grid.is_square else unit_of_grid(grid)
    return None if grid is None or unit is None else unit._replace(side=unit.side * grid.width)


def _size_of(asked: PixelSize, unit: InputUnit | None) -> PixelSize:
    """Return what ``auto`` stands for."""
    if asked.is_spacing:
        raise UsageError(
            "--spacing auto needs an image whose file states its pixel size: give numbers, such as 0.325,0.5um"
        )
    if unit is None:
        raise UsageError(
            "--pixel-size auto needs an input whose file states a unit: give a number and its unit, such as 0.325um, "
            "or 1m for coordinates in meters"
        )
    return PixelSize(unit.side, unit.unit)


def _converted(o: Options, unit: InputUnit | None, shapes: PointSet | PolygonSet) -> Options:
    if not measured(o):
        return o
    if unit is None:
        system = "; for a map give --input-crs, such as EPSG:3857" if "input_crs" in options_of(o.command) else ""
        return _refused(o, f"{_USUAL}{system}")
    if not unit.is_length:
        return _refused_degrees(o, shapes.crs, shapes.xy)
    return in_coordinates(o, Sides(unit.unit, (unit.side,) * 2))


def _refused(o: Options, instead: str = "") -> Options:
    size = o.pixel_size
    if size is not None and size.unit is None and not size.is_auto:
        from vorotool.numeric.length_units import METERS

        refuse_lengths(o, f"{size.option} has no unit: give it one of {', '.join(METERS)}")
    refuse_lengths(o, f"the unit of the input is unknown: {instead or _USUAL}")
    return o


def _refused_degrees(o: Options, crs: Any, xy: Any = ()) -> Options:
    from vorotool.numeric.crs import crs_name, projected_advice

    advice = "reproject it, for example with gdalwarp -t_srs" if isinstance(xy, tuple) else projected_advice(xy)
    where = "" if crs is None else f" ({crs_name(crs)})"
    refuse_lengths(o, f"the input is in degrees{where}, whose length differs from place to place: {advice}")
    return o
