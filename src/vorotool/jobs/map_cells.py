"""``--cell-size``, ``--like``: points, lines and polygons as seeds in square cells, or in the pixels of a raster."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from vorotool.errors import InputError, Kind, Message, UsageError, VorotoolWarning, warn
from vorotool.jobs.inputs import JobInput, no_seeds
from vorotool.jobs.options import Options, changed
from vorotool.jobs.run_log import Run
from vorotool.jobs.units import PixelSize, unit_stats
from vorotool.types.fields import DOWN, UNSTATED

if TYPE_CHECKING:
    from vorotool.numeric.length_units import InputUnit
    from vorotool.types.pixels import Frame, PixelGrid
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.points.seed_set import SeedSet
    from vorotool.types.polygons.polygon_set import PolygonSet

MOST_NAMED = 5
"""Features without a cell that a warning names."""


def seeds_on_map(run: Run, o: Options, given: JobInput, value: PointSet | PolygonSet) -> tuple[Options, SeedSet]:
    """Lay cells over a map, and find the seeds in them: points, or the cells of lines and polygons."""
    from vorotool.engines.tessellation.seeding import seeds_in_frame
    from vorotool.types.pixels import in_cells
    from vorotool.types.points.point_set import PointSet

    is_empty = not len(value.xy)
    if is_empty and o.window is None and o.like is None:
        return o, no_seeds(run, o)
    frame, grid = _cells(o, value) if o.like is None else _cells_of_raster(run, o, o.like, given, value)
    run.grid = grid
    o = changed(o, window=(frame.x, frame.y, frame.width, frame.height), size=None)
    if grid is not None and grid.transform is not None:
        if o.max_distance is not None:
            o = changed(o, max_distance=o.max_distance * (1 if o.pixel_size is None else o.pixel_size.factor))
        side = Fraction(repr(float(grid.width))) if o.cell_size is None else o.cell_size
        o = changed(o, pixel_size=_size_of_cells(o, side, grid))
        value = replace(value, xy=in_cells(value.xy, grid))
    run.stats |= unit_stats(o.pixel_size)
    if is_empty:
        return o, replace(no_seeds(run, o), grid=grid)
    placed = replace(value, y_axis=UNSTATED)  # pictures show the first row on top, as the image has it
    if isinstance(placed, PointSet):
        seeds = seeds_in_frame(placed, frame, strict=o.strict)
    else:
        with run.phase("rasterize"):
            seeds = _seeds_of_features(o, placed, frame)
    return o, replace(seeds, grid=grid)


def _cells(o: Options, value: PointSet | PolygonSet) -> tuple[Frame, PixelGrid]:
    """Lay cells of ``--cell-size`` over what there is, or over a window."""
    import numpy as np

    from vorotool.types.box import bounds
    from vorotool.types.pixels import map_frame

    assert o.cell_size is not None
    if not 1e-100 < o.cell_size < 1e100:
        raise UsageError("--cell-size must be more than 0, and at most 1e100")
    low, high = bounds(value.xy) if len(value.xy) else (np.zeros(2), np.zeros(2))
    return map_frame(low, high, o.cell_size, window=o.window, y_axis=value.y_axis, crs=value.crs)


def _cells_of_raster(
    run: Run, o: Options, path: str, given: JobInput, value: PointSet | PolygonSet
) -> tuple[Frame, PixelGrid | None]:
    """Give the pixels of a raster, which lies on a map, or whose pixels are the coordinates."""
    import numpy as np

    from vorotool.formats.images.image_header import image_header
    from vorotool.formats.io.sources import reading
    from vorotool.jobs.second_files import in_one_crs
    from vorotool.types.pixels import Frame
    from vorotool.types.points.point_set import PointSet

    with reading(path):
        header = image_header(path)
        if header.note:
            run.note(header.note)
        frame, grid = Frame(0, 0, header.width, header.height), header.grid
        is_told = o.pixel_size is not None and o.pixel_size.unit is not None
        _check_units(path, given, value.crs, None if is_told else run.coordinates, grid)
        if grid is None or grid.transform is None:
            return frame, grid
        _check_upright(path, given, value, grid)
        a, _, c, _, e, f = grid.transform
        corners = PointSet(np.array([(c, f), (c + a * frame.width, f + e * frame.height)]), crs=grid.crs)
        return frame, replace(grid, crs=in_one_crs(run, (given.name, value), (path, corners)).crs)


def _check_units(path: str, given: JobInput, crs: Any, unit: InputUnit | None, grid: PixelGrid | None) -> None:
    """Refuse coordinates that state another unit than those of a raster, which may be its pixels."""
    from vorotool.jobs.pixel_sizes import unit_of_grid
    from vorotool.numeric.crs import crs_name
    from vorotool.numeric.length_units import ratio

    if grid is None or grid.transform is None:
        stated = crs_name(crs) if crs is not None else None if unit is None else unit.text
        if stated is not None:
            raise InputError(
                f"{given.name} is in {stated}, but {path} has no position on a map, so --like expects coordinates in "
                "its pixels: georeference it with gdal_translate -a_srs CRS -a_ullr LEFT TOP RIGHT BOTTOM, or use "
                "--cell-size"
            )
        return
    own = unit_of_grid(grid)
    if unit is not None and own is not None and ratio(unit.unit, own.unit) != 1:
        raise InputError(f"{given.name} is in {unit.text}, but {path} in {own.text}: convert one of them")


def _check_upright(path: str, given: JobInput, value: PointSet | PolygonSet, grid: PixelGrid) -> None:
    """Refuse a raster that is turned, mirrored, has pixels that are no squares, or y the other way."""
    if not grid.is_upright:
        raise InputError(f"{path} is rotated or mirrored on the map: straighten it with gdalwarp {path} upright.tif")
    if not grid.is_square:
        raise InputError(
            f"{path} has pixels of {grid.size_text()}, but cells are squares: resample it with gdalwarp -tr SIDE SIDE "
            f"{path} square.tif"
        )
    if value.y_axis == DOWN and grid.is_north_up:
        raise InputError(f"y goes down in {given.name}, but up in {path}: --y-up uses the numbers as they are")


def _size_of_cells(o: Options, side: Fraction, grid: PixelGrid) -> PixelSize:
    """Return the size by which results are in the unit of the map, times ``--pixel-size``."""
    from vorotool.types.pixels import PixelSides

    asked = PixelSize(Fraction(1), None) if o.pixel_size is None else o.pixel_size
    x, y = grid.center
    factor = float(asked.factor)
    sides = PixelSides((1, 1), side * asked.factor)
    return PixelSize(
        Fraction(1), asked.unit, origin=(x * factor, y * factor), y_up=grid.is_north_up, crs=grid.crs, sides=sides
    )


def _seeds_of_features(o: Options, polygons: PolygonSet, frame: Frame) -> SeedSet:
    """The cells of each feature are the seeds of its label; its properties are those of its first part."""
    import numpy as np

    from vorotool.engines.tessellation.frames import require_memory
    from vorotool.engines.tessellation.rasterized import rasterized
    from vorotool.engines.tessellation.seeding import seeds_from_raster
    from vorotool.types.images import Raster

    require_memory(frame, o.max_pixels)
    labels = rasterized(polygons, frame)
    if not labels.any():
        raise InputError("no feature has a cell in the frame: use a smaller --cell-size, or another --window or --like")
    seeds = seeds_from_raster(Raster(labels), mode="labels", max_sites=o.max_sites)
    features, first = np.unique(polygons.feature, return_index=True)
    known = first[np.searchsorted(features, seeds.site_labels.astype(np.int64) - 1)].tolist()
    without = len(features) - len(known)
    if without:
        names = [str(int(number) + 1) for number in np.setdiff1d(features, seeds.site_labels.astype(np.int64) - 1)]
        shown = ", ".join([*names[:MOST_NAMED], *(["…"] if len(names) > MOST_NAMED else [])])
        text = (
            f"{without} of {len(features)} features have no cell, because they are small, covered or outside: {shown}"
        )
        warn(VorotoolWarning(Message(text, Kind.GENERAL)))
    return replace(seeds, properties={name: [column[k] for k in known] for name, column in polygons.properties.items()})
