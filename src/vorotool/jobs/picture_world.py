"""Where what is drawn lies: units of lengths, longitude and latitude, the frame of an image, and columns of names."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from vorotool.jobs.checked_columns import check_column
from vorotool.numeric.crs import is_geographic
from vorotool.numeric.input_unit import InputUnit, unit_of_crs
from vorotool.numeric.length_units import ratio, unit_name
from vorotool.render.looks import Looks, World
from vorotool.types.values import input_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.jobs.options import Options
    from vorotool.jobs.run_log import Run
    from vorotool.jobs.units import PixelSize
    from vorotool.render.canvas.styles import ScaleBar
    from vorotool.types.box import Box, Extent, Sides
    from vorotool.types.mesh.digital_triangulation import AnyTriangulation
    from vorotool.types.points.label_image import LabelImage
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.points.seed_set import SeedSet
    from vorotool.types.polygons.polygon_set import PolygonSet

STEEPEST = 89.0
"""Degrees of latitude beyond which the world is drawn as at this one: the poles have no aspect."""


def world_of(
    run: Run | None,
    looks: Looks,
    *,
    crs: Any = None,
    unit: str | None = None,
    bounds: Sides | None = None,
    frame: Box | None = None,
    size: PixelSize | None = None,
    is_paper: bool = False,
) -> World:
    """Tell where what is drawn lies; a frame is that of an image."""
    is_angular = is_geographic(crs) and frame is None
    aspect = aspect_at((bounds[1] + bounds[3]) / 2) if is_angular and bounds is not None else 1.0
    bar = None
    if looks.has_scale_bar:
        if is_angular or (size is not None and is_geographic(size.crs)):
            if run is not None:
                run.note("there is no scale bar: the length of a degree of longitude differs from place to place")
        else:
            bar = _scale_bar(crs, unit, size, is_image=frame is not None)
    scale = looks.scale
    wants_unit = is_paper if scale is None else scale.is_ratio and looks.drawing_unit is None
    millimetres = _millimetres(crs, unit, size, run, is_image=frame is not None) if wants_unit else None
    is_paper &= looks.aspect is None and millimetres is not None
    return World(bar, millimetres, aspect, None if frame is None else frame.sides, is_paper=is_paper)


def world_of_sites(run: Run, o: Options, mesh: AnyTriangulation, sites: PointSet | SeedSet) -> World:
    """Tell where sites lie that are points, or objects of an image."""
    from vorotool.types.points.seed_set import SeedSet

    frame = None
    if isinstance(sites, SeedSet) and sites.frame is not None:
        sides = None if o.pixel_size is None else o.pixel_size.sides
        frame = sites.frame.box if sides is None else sites.frame.box.stretched(sides.x, sides.y)
    made = world_of(run, o.looks, crs=mesh.crs, bounds=_bounds_of(mesh.points), frame=frame, size=o.pixel_size)
    asked = _asked(o)
    return made if asked is None else made._replace(frame=asked, page=asked)


def world_of_polygons(
    run: Run, o: Options, polygons: PolygonSet, *, size: PixelSize | None = None, is_cut: bool = True
) -> World:
    """Tell where polygons and lines lie, or outlines of an image; `is_cut` if ``--frame`` cuts what is drawn."""
    made = _world_of_set(run, o.looks, polygons, size=size, is_paper=o.width is None)
    asked = _asked(o)
    return made if asked is None else made._replace(frame=None if is_cut else asked, page=asked)


def _world_of_set(
    run: Run | None,
    looks: Looks,
    polygons: PolygonSet,
    *,
    is_paper: bool,
    bounds: Sides | None = None,
    size: PixelSize | None = None,
) -> World:
    made = world_of(
        run,
        looks,
        crs=polygons.crs,
        unit=polygons.unit,
        bounds=bounds or _bounds_of(polygons.xy),
        frame=polygons.frame,
        size=size,
        is_paper=is_paper and polygons.is_drawing,
    )
    return made if polygons.page is None else made._replace(page=polygons.page.sides)


def _asked(o: Options) -> Sides | None:
    """Return the sides of ``--frame``, if the command has it."""
    frame: Extent | None = getattr(o, "frame", None)
    if frame is None:
        return None
    from vorotool.types.box import Box

    return Box.of_size(*frame).sides


def world_of_value(value: Any, looks: Looks, *, is_paper: bool = False) -> World:
    """Tell where a value of the library lies, and refuse a column that it has not."""
    from vorotool.types.box import extent_sides
    from vorotool.types.mesh.cells import CellSet
    from vorotool.types.points.label_image import LabelImage
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.voronoi.voronoi_map import VoronoiMap

    if isinstance(value, LabelImage):
        check_column(looks.label_by, {} if value.seeds is None else value.seeds.properties, "label_by")
        assert value.frame is not None  # LabelImage has filled it in
        return world_of(None, looks, frame=value.frame.box, size=_size_of(value))
    if isinstance(value, VoronoiMap):
        check_column(looks.label_by, value.properties, "label_by")
        bounds = extent_sides(value.frame)
        made = _world_of_set(None, looks, value.polygons, is_paper=is_paper, bounds=bounds)
        return made._replace(frame=None)
    inner = input_of(value)
    check_column(looks.label_by, inner.properties, "label_by")
    if isinstance(inner, PolygonSet):
        return _world_of_set(None, looks, inner, is_paper=is_paper)._replace(frame=None)
    points = inner.sites if isinstance(inner, CellSet) else inner.points
    return world_of(None, looks, crs=inner.crs, bounds=_bounds_of(points))


def _size_of(image: LabelImage) -> PixelSize | None:
    """Return the width of a pixel, if the image says it of one that is a square, or of its distances."""
    from vorotool.jobs.units import PixelSize
    from vorotool.types.spacing import SQUARE

    grid = image.grid
    if image.sides != SQUARE:
        return PixelSize(image.sides.lengths[-1], grid.unit if grid is not None and grid.has(image.sides) else None)
    return PixelSize(grid.width, grid.unit) if grid is not None and grid.is_size and grid.is_square else None


def _bounds_of(points: NDArray[np.float64]) -> Sides:
    from vorotool.types.box import bounds

    if not len(points):
        return (0.0, 0.0, 0.0, 0.0)
    low, high = bounds(points)
    return (float(low[0]), float(low[1]), float(high[0]), float(high[1]))


def aspect_at(latitude: float) -> float:
    """Give how much longer a degree of latitude is than one of longitude, on a sphere."""
    from math import pi

    from vorotool.numeric.curves.inverse_functions import cosine_and_sine

    nearest = min(max(latitude, -STEEPEST), STEEPEST)
    return 1.0 / float(cosine_and_sine(nearest * pi / 180.0)[0])


def _scale_bar(crs: Any, unit: str | None, size: PixelSize | None, *, is_image: bool) -> ScaleBar:
    from vorotool.render.canvas.styles import ScaleBar

    if size is not None and not size.is_auto:
        return ScaleBar(float(size.factor), None if size.unit is None else unit_name(size.unit))
    found = None if is_image or unit else unit_of_crs(crs)
    return ScaleBar(1.0, "px" if is_image else unit or (found and found.text))


def _millimetres(
    crs: Any, unit: str | None, size: PixelSize | None, run: Run | None, *, is_image: bool
) -> Fraction | None:
    """How many millimetres 1 in the coordinates is, if that is known."""
    known = None if is_image else unit_of_crs(crs) if unit is None else InputUnit(unit)
    if size is not None and size.unit is not None:
        known = InputUnit(size.unit, size.factor)
    elif is_image and run is not None:
        known = run.pixel
    ratio_of = None if known is None else ratio(known.unit, "mm")
    return None if known is None or ratio_of is None else known.side * ratio_of
