"""``--cell-size``: points, lines and polygons of a map as seeds in a frame of square cells."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from vorotool.errors import InputError, Kind, Message, UsageError, VorotoolWarning, warn
from vorotool.jobs.given import changed
from vorotool.jobs.inputs import no_seeds
from vorotool.jobs.options import TessellationOptions
from vorotool.jobs.run_log import Run
from vorotool.jobs.units import PixelSize, unit_stats

if TYPE_CHECKING:
    from vorotool.types.pixel_frame import Frame
    from vorotool.types.pixel_grid import PixelGrid
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.points.seed_set import SeedSet
    from vorotool.types.polygons.polygon_set import PolygonSet

MOST_NAMED = 5
"""Features without a cell that a warning names."""


def seeds_on_map(run: Run, o: TessellationOptions, value: PointSet | PolygonSet) -> tuple[TessellationOptions, SeedSet]:
    """Lay cells over a map, and find the seeds in them: points, or the cells of lines and polygons."""
    import numpy as np

    from vorotool.engines.tessellation.seeding import seeds_in_frame
    from vorotool.types.box import bounds
    from vorotool.types.map_frame import in_cells, map_frame
    from vorotool.types.points.point_set import PointSet

    is_empty = not len(value.xy)
    if is_empty and o.window is None:
        return o, no_seeds(run, o)
    assert o.cell_size is not None
    if not 1e-100 < o.cell_size < 1e100:
        raise UsageError("--cell-size must be more than 0, and at most 1e100")
    low, high = (np.zeros(2), np.zeros(2)) if is_empty else bounds(value.xy)
    frame, grid = map_frame(low, high, o.cell_size, window=o.window, y_axis=value.y_axis, crs=value.crs)
    size = _size_of_cells(o, o.cell_size, grid)
    run.stats |= unit_stats(size)
    run.grid = grid
    if o.max_distance is not None:
        o = changed(o, max_distance=o.max_distance * (1 if o.pixel_size is None else o.pixel_size.factor))
    o = changed(o, window=(frame.x, frame.y, frame.width, frame.height), size=None, pixel_size=size)
    if is_empty:
        return o, replace(no_seeds(run, o), grid=grid)
    placed = replace(value, xy=in_cells(value.xy, grid))
    if isinstance(placed, PointSet):
        seeds = seeds_in_frame(placed, frame, strict=o.strict)
    else:
        with run.phase("rasterize"):
            seeds = _seeds_of_features(o, placed, frame)
    return o, replace(seeds, grid=grid)


def _size_of_cells(o: TessellationOptions, side: Fraction, grid: PixelGrid) -> PixelSize:
    """Return the size by which results are in the unit of the map, times ``--pixel-size``."""
    from vorotool.types.spacing import PixelSides

    asked = PixelSize(Fraction(1), None) if o.pixel_size is None else o.pixel_size
    x, y = grid.center
    factor = float(asked.factor)
    sides = PixelSides((1, 1), side * asked.factor)
    return PixelSize(
        Fraction(1), asked.unit, origin=(x * factor, y * factor), y_up=grid.is_north_up, crs=grid.crs, sides=sides
    )


def _seeds_of_features(o: TessellationOptions, polygons: PolygonSet, frame: Frame) -> SeedSet:
    """The cells of each feature are the seeds of its label; its properties are those of its first part."""
    import numpy as np

    from vorotool.engines.tessellation.frames import require_memory
    from vorotool.engines.tessellation.rasterized import rasterized
    from vorotool.engines.tessellation.seeding import seeds_from_raster
    from vorotool.types.points.raster import Raster

    require_memory(frame, o.max_pixels)
    labels = rasterized(polygons, frame)
    if not labels.any():
        raise InputError("no feature has a cell in the frame: use a smaller --cell-size, or another --window")
    seeds = seeds_from_raster(Raster(labels), mode="labels", max_sites=o.max_sites)
    assert seeds.site_labels is not None
    assert polygons.feature is not None
    features, first = np.unique(polygons.feature, return_index=True)
    known = first[np.searchsorted(features, seeds.site_labels.astype(np.int64) - 1)].tolist()
    without = len(features) - len(known)
    if without:
        names = [str(int(number) + 1) for number in np.setdiff1d(features, seeds.site_labels.astype(np.int64) - 1)]
        shown = ", ".join([*names[:MOST_NAMED], *(["…"] if len(names) > MOST_NAMED else [])])
        text = f"{without} of {len(features)} features have no cell, as they are small, covered or outside: {shown}"
        warn(VorotoolWarning(Message(text, Kind.GENERAL)))
    return replace(seeds, properties={name: [column[k] for k in known] for name, column in polygons.properties.items()})
