"""``--pixel-size``, ``--spacing`` and lengths of the input: the size of pixels in the unit of the results."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeVar

from vorotool.errors import InputError, Kind, Message, UsageError
from vorotool.jobs.options import Options, changed
from vorotool.jobs.run_log import Run
from vorotool.jobs.units import (
    PixelSize,
    Sides,
    in_coordinates,
    refuse_lengths,
    shows_units,
    unit_stats,
)
from vorotool.products.options import flag, options_of
from vorotool.types.fields import UP

if TYPE_CHECKING:
    from vorotool.convert.sites import Sites
    from vorotool.jobs.inputs import JobInput
    from vorotool.numeric.length_units import InputUnit
    from vorotool.render.canvas.layers import Backdrop
    from vorotool.types.pixels import PixelGrid
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.volumes.volume import VoxelGrid

Placed = TypeVar("Placed")


_SHEARED = "the image is sheared on the map: its pixels are no rectangles"
_STRAIGHTEN = "straighten it with gdalwarp in.tif upright.tif"


def with_pixel_size(run: Run, o: Options, given: JobInput, grid: PixelGrid | None) -> Options:
    """Give options with the size of the pixels of an image: as the user says, else what the file says of a map."""
    asked = o.pixel_size
    if asked is not None and not asked.is_auto:
        run.stats |= unit_stats(asked)
        return o
    is_spacing = asked is not None and asked.is_spacing
    is_plain = not o.scale_bar and not shows_units(given.targets)
    measured = grid if o.takes_spacing and not is_spacing else None
    if measured is not None and measured.is_size and ("distance" in o.what if measured.is_square else is_plain):
        run.note(_note_of_size(given, measured, o, "distances"))
    if is_plain and not is_spacing:
        return o
    is_on_map = grid is not None and grid.transform is not None
    if grid is not None and is_on_map and (grid.is_upright or not is_plain):  # distances need no place on it
        size = _on_map(run, given, grid, o)
    elif asked is not None:
        size = size_of_file(grid, o)
    else:
        size = None
        if grid is not None and grid.is_size:
            run.note(_note_of_size(given, grid, o))
    run.stats |= unit_stats(size)
    return _mirrored_places(changed(o, pixel_size=size))


def size_of_file(grid: PixelGrid | None, o: Options) -> PixelSize:
    """Return the size of pixels that an image states, or refuse one that states none."""
    grid = sized(grid, o)
    if o.pixel_size is not None and o.pixel_size.is_spacing:
        return _spacing_of_pixels(grid)
    if not grid.is_square:
        instead = "give a number and its unit, such as --pixel-size 0.325um"
        measure = "use --spacing auto, or " if o.takes_spacing else ""
        raise InputError(f"the image has pixels of {grid.size_text()}, which are not squares: {measure}{instead}")
    return PixelSize(grid.width, grid.unit)


def _spacing_of_pixels(grid: PixelGrid) -> PixelSize:
    """Both sides as distances take them."""
    if not grid.is_rectangular:
        raise InputError(f"{_SHEARED}, which have no sides to measure with: {_STRAIGHTEN}")
    instead = "give rounded sides, such as --spacing 0.325,0.5um"
    return spacing_of(grid, (grid.height, grid.width), "image has pixels", instead)


def spacing_of(grid: PixelGrid | VoxelGrid, sides: tuple[Fraction, ...], what: str, instead: str) -> PixelSize:
    """Return the sides of pixels or voxels as distances take them, or refuse those that have no common step."""
    from vorotool.types.pixels import sides_of_grid

    found = sides_of_grid(*sides)
    if found is None:
        raise InputError(
            f"the {what} of {grid.size_text()}, whose sides have no common step that is coarse enough for exact "
            f"distances: {instead}"
        )
    return PixelSize(Fraction(1), grid.unit, is_spacing=True, sides=found)


def _note_of_size(given: JobInput, grid: PixelGrid, o: Options, what: str = "results") -> str:
    if not grid.is_rectangular:
        return f"{given.name}: {_SHEARED}: {what} are in pixels; {_STRAIGHTEN} to measure on the map"
    measure = "; --spacing auto measures with these sides" if o.takes_spacing else ""
    if grid.is_square and what == "distances":
        return f"{given.name} states a pixel size of {grid.size_text()}: {what} are in pixels{measure}"
    if grid.is_square:
        return f"{given.name} states a pixel size of {grid.size_text()}: --pixel-size auto uses it"
    return f"{given.name} has pixels of {grid.size_text()}, which are not squares: {what} are in pixels{measure}"


def _on_map(run: Run, given: JobInput, grid: PixelGrid, o: Options) -> PixelSize | None:
    """Size and place of the pixels of a map; None where they are no squares, and nobody asked for them."""
    asked, in_pixels = o.pixel_size, "--pixel-size 1 gives results in pixels"
    is_spacing = asked is not None and asked.is_spacing
    if not grid.is_upright:
        if is_spacing and grid.is_rectangular:
            lengths = ",".join(f"{float(side):.10g}" for side in (grid.width, grid.height))
            in_pixels = f"--spacing {lengths}{grid.unit or ''} gives results along its rows and columns"
        raise InputError(
            "the image is rotated, mirrored or sheared on the map, which vectors and tables cannot follow: "
            f"{in_pixels}, or {_STRAIGHTEN}"
        )
    if not grid.is_square and not is_spacing:
        if asked is not None:
            measure = "use --spacing auto; " if o.takes_spacing else ""
            raise InputError(
                f"the image has pixels of {grid.size_text()}, which are not squares: {measure}{in_pixels}, or "
                "resample it with gdalwarp -tr SIDE SIDE in.tif square.tif"
            )
        run.note(_note_of_size(given, grid, o))
        return None
    from vorotool.numeric.crs import crs_name, is_geographic

    if is_geographic(grid.crs):
        text = f"{given.name}: longitude and latitude are treated as planar, lengths are in degrees"
        run.note(Message(text, Kind.DEGREES, source=given.name))
    if asked is None:
        where = "on a map" if grid.crs is None else f"in {crs_name(grid.crs)}"
        run.note(f"{given.name} lies {where}: results are in its coordinates; {in_pixels}")
    size = _spacing_of_pixels(grid) if is_spacing else PixelSize(grid.width, grid.unit)
    return size._replace(origin=grid.center, y_up=grid.is_north_up, crs=grid.crs)


def _mirrored_places(o: Options) -> Options:
    """Options of places and frames, which are given in pixels with y downwards."""
    if o.pixel_size is None or not o.pixel_size.y_up:
        return o
    if o.frame is not None:
        x, y, width, height = o.frame
        o = changed(o, frame=(x, -(y + height), width, height))
    if o.start is not None or o.end is not None:
        start, end = (None if place is None else (place[0], -place[1]) for place in (o.start, o.end))
        o = changed(o, start=start, end=end)
    return o


def placed_polygons(size: PixelSize | None, polygons: PolygonSet) -> PolygonSet:
    """Give outlines of an image as they lie on its map, in pixels; in steps where these have sides."""
    from vorotool.types.scaling import stretched

    if size is not None and size.sides is not None:
        polygons = stretched(polygons, size.sides.x, size.sides.y)
    if size is None or size.origin is None:
        return polygons
    return replace(stretched(polygons, 1, -1) if size.y_up else polygons, y_axis=UP, crs=size.crs)


def written_grid(size: PixelSize | None, grid: PixelGrid | None) -> PixelGrid | None:
    """Give what images that are written say of their pixels: the sides of ``--spacing``, else what the input says."""
    if size is None or size.sides is None or size.unit is None or (grid is not None and grid.transform is not None):
        return grid
    from vorotool.types.pixels import PixelGrid

    height, width = size.sides.lengths
    return PixelGrid(width, height, size.unit, "imagej" if grid is None else grid.form)


def placed_mesh(size: PixelSize | None, mesh: Placed) -> Placed:
    """Give a triangulation of such seeds the coordinate reference system of the map."""
    if size is None or size.origin is None:
        return mesh
    return replace(mesh, y_axis=UP, crs=size.crs)  # type: ignore[type-var]  # triangulations have both


def placed_backdrop(run: Run, o: Options, backdrop: Backdrop) -> Backdrop:
    """Give the image of ``--overlay`` as what is drawn over it lies."""
    size = o.pixel_size
    if size is not None and size.sides is not None:
        raise UsageError("--overlay shows pixels as squares: leave it out with --spacing")
    from vorotool.jobs.second_files import side_of_backdrop

    return replace(backdrop, y_up=size is not None and size.y_up, side=side_of_backdrop(run, o, backdrop.grid))


_USUAL = "give --pixel-size, such as 0.325um, or 1m for coordinates in meters"


def lengths_of_vectors(o: Options, value: PointSet | PolygonSet | Sites) -> Options:
    """Give options in the coordinates of points, lines and polygons; ``--pixel-size auto`` is their unit."""
    from vorotool.numeric.length_units import unit_of

    is_auto = o.pixel_size is not None and o.pixel_size.is_auto
    if not o.measured and not is_auto:
        return o
    unit = unit_of(value)
    shapes: Any = getattr(value, "polygons", value)
    if o.pixel_size is not None and is_auto:
        o = changed(o, pixel_size=_size_of(o.pixel_size, unit))
    if not o.measured:
        return o
    if unit is None:
        system = "; of a map name its system with --input-crs, and with --crs one that is in meters"
        return _refused(o, _USUAL + (system if "input_crs" in options_of(o.command) else ""))
    if not unit.is_length:
        return _refused_degrees(o, shapes.crs, shapes.xy)
    return in_coordinates(o, Sides(unit.unit, (unit.side,) * 2))


def unit_of_vectors(o: Options, value: Any, *, with_system: bool = True) -> InputUnit | None:
    """Return the unit of coordinates: of ``--pixel-size``, else the one stated, by a reference system only if asked."""
    from vorotool.numeric.length_units import InputUnit, unit_of

    size = o.pixel_size
    if size is not None and size.unit is not None:
        return InputUnit(size.unit, size.factor)
    return unit_of(value) if with_system or getattr(value, "polygons", value).crs is None else None


def lengths_of_image(o: Options, grid: PixelGrid | None) -> Options:
    """Give options in pixels of an image, or in the unit of ``--spacing auto``."""
    if not o.measured:
        return o
    unit = None if grid is None else unit_of_grid(grid)
    if grid is None or unit is None:
        if o.pixel_size is not None and o.pixel_size.is_auto:
            sized(grid, o)
        return _refused(o)
    if not unit.is_length:
        return _refused_degrees(o, grid.crs)
    if grid.transform is not None:  # places begin in the corner of the image
        for name in (name for name in ("frame", "start", "end") if name in o.measured):
            option = flag(o.command, name)
            raise UsageError(f"{option} of an image on a map is in its pixels: give numbers without a unit")
    if not grid.is_rectangular:
        refuse_lengths(o, f"{_SHEARED}; give numbers of pixels, or {_STRAIGHTEN}")
    sides = unit.side * grid.height, unit.side * grid.width
    if grid.is_square:
        sides = sides[1], sides[1]
    return in_coordinates(o, Sides(unit.unit, sides, _step(o)))


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
    if not o.measured:
        return o
    if grid is None or grid.unit is None:
        return _refused(o, "give --spacing, such as 0.325,0.325,1.5um")
    return in_coordinates(o, Sides(grid.unit, grid.sides, _step(o)))


def _step(o: Options) -> Fraction | None:
    """What lengths are counted in at first where distances are in the sides of pixels: their unit."""
    return Fraction(1) if o.pixel_size is not None and o.pixel_size.is_spacing else None


def unit_of_grid(grid: PixelGrid) -> InputUnit | None:
    """Return the unit that the sides of pixels are in; dots an inch are for print."""
    from vorotool.numeric.length_units import InputUnit, unit_of_crs

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
