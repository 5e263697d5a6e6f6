"""``--pixel-size auto``, ``--spacing auto``, and images on a map: what a file says of pixels is the unit of results."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, TypeVar

from vorotool.errors import InputError, Kind, Message, UsageError
from vorotool.jobs.input_lengths import sized
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.options import Options, changed
from vorotool.jobs.run_log import Run
from vorotool.jobs.units import (
    PixelSize,
    lengths_in_steps,
    sides_of,
    unit_stats,
)
from vorotool.types.axis import UP

if TYPE_CHECKING:
    from vorotool.render.canvas.layers import Backdrop
    from vorotool.types.pixel_grid import PixelGrid
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.points.seed_set import SeedSet
    from vorotool.types.polygons.polygon_set import PolygonSet

Placed = TypeVar("Placed")


def with_pixel_size(run: Run, o: Options, given: JobInput, grid: PixelGrid | None) -> Options:
    """Give options with the size of the pixels of an image: as the user says, else what the file says of a map."""
    asked = o.pixel_size
    if asked is not None and not asked.is_auto:
        run.stats |= unit_stats(asked)
        return o
    is_spacing = asked is not None and asked.is_spacing
    if not given.has_units and not is_spacing:
        if grid is not None and grid.is_size and not grid.is_square and o.takes_spacing:
            run.note(_note_of_size(given, grid, o, "distances"))
        return o
    if grid is not None and grid.transform is not None:
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
        return _spacing_of(grid)
    if not grid.is_square:
        instead = "give a number and its unit, such as --pixel-size 0.325um"
        measure = "use --spacing auto, or " if o.takes_spacing else ""
        raise InputError(f"the image has pixels of {grid.size_text()}, which are not squares: {measure}{instead}")
    return PixelSize(grid.width, grid.unit)


def _spacing_of(grid: PixelGrid) -> PixelSize:
    """Both sides as distances take them."""
    from vorotool.types.pixel_grid import sides_of_grid

    sides = sides_of_grid(grid)
    if sides is None:
        raise InputError(
            f"the image has pixels of {grid.size_text()}, whose sides have no common step that is coarse enough for "
            "exact distances: give rounded sides, such as --spacing 0.325,0.5um"
        )
    return PixelSize(Fraction(1), grid.unit, is_spacing=True, sides=sides)


def _note_of_size(given: JobInput, grid: PixelGrid, o: Options, what: str = "results") -> str:
    if grid.is_square:
        return f"{given.name} states a pixel size of {grid.size_text()}: --pixel-size auto uses it"
    measure = "; --spacing auto measures with these sides" if o.takes_spacing else ""
    return f"{given.name} has pixels of {grid.size_text()}, which are not squares: {what} are in pixels{measure}"


def _on_map(run: Run, given: JobInput, grid: PixelGrid, o: Options) -> PixelSize | None:
    """Size and place of the pixels of a map; None where they are no squares, and nobody asked for them."""
    asked, in_pixels = o.pixel_size, "--pixel-size 1 gives results in pixels"
    is_spacing = asked is not None and asked.is_spacing
    if not grid.is_upright:
        raise InputError(
            f"the image is rotated or mirrored on the map, which vectors and tables cannot follow: {in_pixels}, or "
            "straighten it with gdalwarp in.tif upright.tif"
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
    size = _spacing_of(grid) if is_spacing else PixelSize(grid.width, grid.unit)
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
    if size is not None and size.sides is not None:
        steps = (size.sides.x, size.sides.y)
        frame = None if polygons.frame is None else polygons.frame.stretched(*steps)
        polygons = replace(polygons, xy=polygons.xy * steps, frame=frame)
    if size is None or size.origin is None:
        return polygons
    from vorotool.types.map_frame import mirrored_polygons

    return replace(mirrored_polygons(polygons) if size.y_up else polygons, y_axis=UP, crs=size.crs)


def placed_sites(
    run: Run, o: Options, given: JobInput, points: PointSet | SeedSet
) -> tuple[Options, PointSet | SeedSet]:
    """Give options with the size of pixels, see `with_pixel_size`, and seeds of an image as they lie on its map."""
    from vorotool.types.points.seed_set import SeedSet

    if not isinstance(points, SeedSet):
        return lengths_in_steps(o), points
    o = lengths_in_steps(with_pixel_size(run, o, given, points.grid))
    if o.pixel_size is None or not o.pixel_size.y_up:
        return o, points
    from vorotool.types.map_frame import mirrored_seeds

    return o, mirrored_seeds(points)


def in_steps(o: Options, points: PointSet | SeedSet) -> PointSet:
    """Give points in pixels, or the sites of an image, in steps of ``--spacing``."""
    from vorotool.convert.points import as_points

    sides = sides_of(o)
    steps = (sides.x, sides.y)
    placed = as_points(points)
    frame = None if placed.frame is None else placed.frame.stretched(*steps)
    return replace(placed, xy=placed.xy * steps, frame=frame)


def written_grid(size: PixelSize | None, grid: PixelGrid | None) -> PixelGrid | None:
    """Give what images that are written say of their pixels: the sides of ``--spacing``, else what the input says."""
    if size is None or size.sides is None or size.unit is None or (grid is not None and grid.transform is not None):
        return grid
    from vorotool.types.pixel_grid import PixelGrid

    height, width = size.sides.lengths
    return PixelGrid(width, height, size.unit, "imagej" if grid is None else grid.form)


def placed_mesh(size: PixelSize | None, mesh: Placed) -> Placed:
    """Give a triangulation of such seeds the coordinate reference system of the map."""
    if size is None or size.origin is None:
        return mesh
    made: Placed = replace(mesh, y_axis=UP, crs=size.crs)  # type: ignore[type-var]  # triangulations have both
    return made


def placed_backdrop(run: Run, o: Options, backdrop: Backdrop | None) -> Backdrop | None:
    """Give the image of ``--overlay`` as what is drawn over it lies."""
    from vorotool.jobs.second_files import side_of_backdrop

    size = o.pixel_size
    if backdrop is not None and size is not None and size.sides is not None:
        raise UsageError("--overlay shows pixels as squares: leave it out with --spacing")
    if backdrop is None:
        return None
    return replace(backdrop, y_up=size is not None and size.y_up, side=side_of_backdrop(run, o, backdrop.grid))
