"""Where what is drawn lies: units of lengths, longitude and latitude, the frame of an image, and columns of names."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from vorotool.jobs.inputs import check_column
from vorotool.numeric.crs import is_geographic
from vorotool.numeric.length_units import InputUnit, ratio, unit_name, unit_of_crs
from vorotool.products.registry import is_of
from vorotool.render.drawing import World
from vorotool.types.values import input_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.jobs.options import Options
    from vorotool.jobs.run_log import Run
    from vorotool.jobs.units import PixelSize
    from vorotool.render.canvas.layers import Page
    from vorotool.render.canvas.styles import ScaleBar
    from vorotool.types.box import Box, Sides
    from vorotool.types.images import LabelImage
    from vorotool.types.mesh.triangulation import AnyTriangulation
    from vorotool.types.pixels import Frame, PixelGrid, Transform
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.points.seed_set import SeedSet
    from vorotool.types.polygons.polygon_set import PolygonSet

STEEPEST = 89.0
"""Degrees of latitude beyond which the world is drawn as at this one: the poles have no aspect."""


def world_of(
    run: Run,
    o: Options,
    *,
    crs: Any = None,
    unit: str | None = None,
    bounds: Sides | None = None,
    frame: Box | None = None,
    size: PixelSize | None = None,
    is_paper: bool = False,
) -> World:
    """Return where what is drawn lies; a frame is that of an image."""
    looks, is_angular, is_image = o.looks, is_geographic(crs) and frame is None, frame is not None
    aspect = aspect_at((bounds[1] + bounds[3]) / 2) if is_angular and bounds is not None else 1.0
    bar = None
    if looks.scale_bar and (is_angular or (size is not None and is_geographic(size.crs))):
        run.note("no scale bar is drawn: the length of a degree of longitude varies over the map")
    elif looks.scale_bar:
        bar = _scale_bar(crs, unit, size, is_image=is_image)
    scale = looks.scale
    wants_unit = is_paper if scale is None else scale.is_ratio and looks.drawing_unit is None
    millimeters = _millimeters(crs, unit, size, run, is_image=is_image) if wants_unit else None
    is_paper &= looks.aspect is None and millimeters is not None
    return World(bar, millimeters, aspect, None if frame is None else frame.sides, is_paper=is_paper)


def world_of_sites(run: Run, o: Options, mesh: AnyTriangulation, sites: PointSet | SeedSet) -> World:
    """Return where sites lie that are points, or objects of an image."""
    frame: Frame | None = getattr(sites, "frame", None) if is_of(sites, "SeedSet") else None
    box = None if frame is None else frame.box
    if box is not None and o.pixel_size is not None and o.pixel_size.sides is not None:
        box = box.stretched(o.pixel_size.sides.x, o.pixel_size.sides.y)
    made = world_of(run, o, crs=mesh.crs, bounds=bounds_of(mesh.points), frame=box, size=o.pixel_size)
    asked = _asked(o)
    return made if asked is None else made._replace(frame=asked, page=asked)


def world_of_polygons(
    run: Run,
    o: Options,
    polygons: PolygonSet,
    *,
    bounds: Sides | None = None,
    size: PixelSize | None = None,
    is_cut: bool = True,
) -> World:
    """Return where polygons and lines lie, or outlines of an image; `is_cut` if ``--frame`` cuts what is drawn."""
    made = world_of(
        run,
        o,
        crs=polygons.crs,
        unit=polygons.unit,
        bounds=bounds or bounds_of(polygons.xy),
        frame=polygons.frame,
        size=size,
        is_paper=o.width is None and polygons.is_drawing,
    )
    if polygons.page is not None:
        made = made._replace(page=polygons.page.sides)
    asked = _asked(o)
    return made if asked is None else made._replace(frame=None if is_cut else asked, page=asked)


def _asked(o: Options) -> Sides | None:
    """Return the sides of ``--frame``, if it is given."""
    from vorotool.types.box import Box

    return None if o.frame is None else Box.of_size(*o.frame).sides


def world_of_value(run: Run, o: Options, value: Any) -> World:
    """Return where a value of the library lies, and refuse a column that it has not."""
    from vorotool.types.box import extent_sides

    if is_of(value, "LabelImage"):
        check_column(o.label_by, {} if value.seeds is None else value.seeds.properties, "label_by")
        return world_of(run, o, frame=value.frame.box, size=_size_of(value))
    is_map = is_of(value, "VoronoiMap")
    inner = value if is_map else input_of(value)
    check_column(o.label_by, inner.properties, "label_by")
    if is_map or is_of(inner, "PolygonSet"):
        bounds = extent_sides(value.frame) if is_map else None
        return world_of_polygons(run, o, inner.polygons if is_map else inner, bounds=bounds)._replace(frame=None)
    points = inner.sites if is_of(inner, "CellSet") else inner.points
    return world_of(run, o, crs=inner.crs, bounds=bounds_of(points))


def _size_of(image: LabelImage) -> PixelSize | None:
    """Return the width of a pixel, if the image says it of one that is a square, or of its distances."""
    from vorotool.jobs.units import PixelSize
    from vorotool.types.pixels import SQUARE

    grid = image.grid
    if image.sides != SQUARE:
        return PixelSize(image.sides.lengths[-1], grid.unit if grid is not None and grid.has(image.sides) else None)
    return PixelSize(grid.width, grid.unit) if grid is not None and grid.is_size and grid.is_square else None


def bounds_of(points: NDArray[np.float64]) -> Sides:
    """Give the bounds of places, of none those of the origin."""
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


def _millimeters(crs: Any, unit: str | None, size: PixelSize | None, run: Run, *, is_image: bool) -> Fraction | None:
    """How many millimeters 1 in the coordinates is, if that is known."""
    known = None if is_image else unit_of_crs(crs) if unit is None else InputUnit(unit)
    if size is not None and size.unit is not None:
        known = InputUnit(size.unit, size.factor)
    elif is_image:
        known = run.pixel
    ratio_of = None if known is None else ratio(known.unit, "mm")
    return None if known is None or ratio_of is None else known.side * ratio_of


# ---- world files beside PNGs of what lies on a map
def write_world_file(
    run: Run, size: PixelSize | None, page: Page | None, path: str, *, no_clobber: bool, inputs: Sequence[str]
) -> None:
    """Write the world file of a PNG whose pixels have places on a map; others have none."""
    transform = _transform(run, size, page)
    if transform is None:
        return
    from vorotool.formats.images.image_grids import world_text
    from vorotool.formats.io.atomic_output import open_output
    from vorotool.formats.io.descriptors import stream_kind

    if path == "-" or stream_kind(path) is not None:
        return
    from pathlib import Path

    with open_output(str(Path(path).with_suffix(".pgw")), no_clobber=no_clobber, inputs=inputs) as out:
        out.write(world_text(transform))


def _transform(run: Run, size: PixelSize | None, page: Page | None) -> Transform | None:
    grid = run.grid if run.grid is not None and run.grid.transform is not None else None
    if page is None:
        return None if grid is None else grid.transform
    if grid is None:
        return _of_page(page, lambda xy: xy) if run.crs is not None else None
    return _of_page(page, _to_map(size, grid))


def _to_map(size: PixelSize | None, grid: PixelGrid) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """From coordinates of an image, as they are drawn, to the map."""
    import numpy as np

    if size is not None and size.origin is not None:
        origin, factor = np.asarray(size.origin), float(size.factor)
        return lambda xy: xy * factor + origin
    assert grid.transform is not None
    a, b, c, d, e, f = grid.transform
    return lambda xy: (xy + 0.5) @ np.array([[a, d], [b, e]]) + (c, f)


def _of_page(page: Page, to_map: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> Transform | None:
    """From columns and rows of corners of a page to the map."""
    import numpy as np

    left, low, right, high = page.bounds
    if not (right > left and high > low):
        return None
    corner, opposite = page.place(np.array([[left, low], [right, high]]))
    scale = (opposite - corner) / (right - left, high - low)
    begin, across, down = to_map((np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) - corner) / scale + (left, low))
    (a, d), (b, e) = across - begin, down - begin
    return (a, b, float(begin[0]), d, e, float(begin[1])) if a * e != b * d else None
