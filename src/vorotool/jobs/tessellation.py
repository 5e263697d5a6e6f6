"""What a tessellation can be written as (``--what``): each from rows, or from the label image held in memory."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property, partial
from math import isqrt
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.frames import require_memory, squared_limit
from vorotool.engines.tessellation.raster_objects import PartwiseObjects
from vorotool.engines.tessellation.seeding import seeds_from_raster, seeds_in_frame
from vorotool.engines.tessellation.tessellate import PropagatedRows
from vorotool.engines.tessellation.tessellator import Band, Tessellator
from vorotool.errors import InputError, LimitError, UsageError, warn
from vorotool.formats.opening import opened
from vorotool.jobs.inputs import (
    JobInput,
    asked_frame,
    frame_of,
    no_seeds,
    read_opened,
    seeds_of_image,
    tell_outside,
)
from vorotool.jobs.options import OF_FRAMES, Options, changed
from vorotool.jobs.pixel_sizes import lengths_of_image, unit_of_grid, with_pixel_size, written_grid
from vorotool.jobs.refusals import check_image_size, refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.streams import Tessellated, check_chunks, scale_of_squares, tessellated_rows
from vorotool.jobs.targets import Target
from vorotool.jobs.units import PixelSize, known_length, sides_of, unit_columns, unit_stats, unit_text
from vorotool.numeric.crs import crs_name
from vorotool.numeric.length_units import ratio
from vorotool.products.formats import ANIMATIONS, resolved
from vorotool.types.box import bounds
from vorotool.types.fields import DOWN, UNSTATED, is_up
from vorotool.types.images import Raster
from vorotool.types.pixels import SQUARE, Frame, PixelGrid, PixelSides, in_cells, map_frame
from vorotool.types.points.point_set import PointSet
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.polygons.polygon_set import PolygonSet

if TYPE_CHECKING:
    from vorotool.engines.tessellation.streamed_image import StreamedImage
    from vorotool.formats.images.image_header import TiffRows, ZarrRows
    from vorotool.formats.opening import Opened
    from vorotool.numeric.length_units import InputUnit
    from vorotool.render.drawing import World
    from vorotool.render.label_images.picture import LabelPicture

LARGE = 2**24
"""Pixels from which an image that can be read in bands is not held: a seed in memory takes some 40 bytes."""

LEAST_ROWS = 128
"""Rows that are read at a time, however low chunks are: for each band two lists are kept."""

TABLES = frozenset({"table", "neighbors"})
OF_LARGE = TABLES | {"labels", "distance", "distance2"}
"""What can be written of an image that is not held."""

_OF_POINTS = "applies to lists of points, but the input is an image with its own frame"

DARK_LABELS = 1024
"""Labels up to here look black in a 16-bit image."""


def products(run: Run, o: Options, given: JobInput) -> Products:
    """Read points or an image, and prepare what labels any rows."""
    with run.phase("read"):
        with opened(given.path, geometry=None if o.is_laid_out else "points", **o.opening) as source:
            large = rows_of_large(o, source)
            with_columns = "table" in o.what or o.names_columns or given.has_page
            if large is None:
                how: dict[str, Any] = {"properties": with_columns, "wants_unit": o.like is not None}
                o, value = read_opened(run, o, given, source, columns=o.columns, **how)
        if large is not None:
            run.grid = large.grid
            check_image_size(run, o, given.name, large.grid)
            o = with_pixel_size(run, lengths_of_image(o, large.grid), given, large.grid)
            return StreamedProducts(run, o, given, _streamed(run, o, large), large.grid)
        if o.is_laid_out and not isinstance(value, Raster):
            o, seeds = seeds_on_map(run, o, given, value)
        else:
            seeds = _seeds_of(run, o, value)
        if isinstance(value, Raster):
            o = with_pixel_size(run, o, given, seeds.grid)
    with run.phase("prepare" if o.method == "exact" else "tessellate"):
        rows = tessellated_rows(run, o, seeds)
    if isinstance(value, PointSet):
        _tell_outside(run, rows)
    return Products(run, o, given, rows, seeds.grid)


def _tell_outside(run: Run, rows: Tessellator | PropagatedRows) -> None:
    seeds, (left, top, right, bottom) = rows.seeds, rows.frame.box.sides
    if seeds.sites is not None and seeds.site_labels is not None:
        x, y = seeds.sites.T
        is_outside = (x < left) | (x > right) | (y < top) | (y > bottom)
        tell_outside(run, seeds.site_labels, is_outside)
        if len(x) and is_outside.all():
            run.warn(
                f"no seed is in the frame: they lie at x {x.min():g} to {x.max():g}, y {y.min():g} to {y.max():g}; "
                "choose the frame with --window X,Y,W,H, or for coordinates of a map the side of a pixel with "
                "--cell-size SIDE"
            )


def _seeds_of(run: Run, o: Options, value: PointSet | PolygonSet | Raster) -> SeedSet:
    if isinstance(value, PointSet) and not len(value):
        return replace(no_seeds(run, o, value), y_axis=value.y_axis)
    if isinstance(value, PointSet):
        return seeds_in_frame(value, asked_frame(o) or partial(frame_of, o), sides=sides_of(o), strict=o.strict)
    assert isinstance(value, Raster)  # what is asked for is points, or an image
    refuse(o, ("columns", *OF_FRAMES), _OF_POINTS)
    return seeds_of_image(run, o, value, o.seeds)


class Products(Tessellated):
    """Results of one tessellation."""

    begins_empty = True

    def __init__(self, run: Run, options: Options, given: JobInput, rows: Any, grid: PixelGrid | None) -> None:
        super().__init__(run, options, given, rows, sides_of(options), written_grid(options.pixel_size, grid))
        self.backdrop = given.backdrop

    def check(self, target: Target) -> None:
        """Refuse what cannot be written in the format of a target, before anything is."""
        what, fmt = target.what, target.fmt
        if fmt in ("svg", "html"):
            from vorotool.render.label_images.svg import check_size

            check_size(self.frame.shape, fmt.upper())
        elif fmt in ANIMATIONS:
            self.check_frames(self.frame.shape)
            self._exact_rows().check_distances()
        elif what == "labels" and fmt == "png":
            from vorotool.formats.images.label_images import check_png

            check_png(self.dtype, self.seeds.largest_label)
        elif what == "distance2":
            _ = self._exact_rows().square_dtype
        if fmt == "zarr":
            check_chunks(self.options, self.stream(what))
        if self.is_picture(target) or fmt == "html" or fmt in ANIMATIONS:
            require_memory(self.frame, self.options.max_pixels)
            self.is_held = True

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result, and say what may surprise in it."""
        seeds, rows = self.seeds, self.sweep
        is_png = (target.what, target.fmt) == ("labels", "png")
        if is_png and seeds.largest_label < DARK_LABELS and sys.stderr.isatty():
            self.run.note(
                f"labels up to {seeds.largest_label} look black in a 16-bit PNG: for a picture use --what color"
            )
        if target.what == "distance2" and self.sides.step != 1 and isinstance(rows, Tessellator):
            unit = unit_text(self.options.pixel_size)
            self.run.note(f"squared distances are in squares of a step of {rows.step}{unit}")
        elif target.what == "distance2" and seeds.scale > 1:
            self.run.note(f"squared distances are in units of 1/{seeds.scale}² square pixels: seeds lie between pixels")
        super().write(target, inputs=inputs)

    def is_picture(self, target: Target) -> bool:
        """Whether it is drawn from the whole image."""
        is_diagram = (target.what, target.fmt) == ("diagram", "png")
        return target.what == "color" or target.fmt == "svg" or (is_diagram and self.options.draws_diagram)

    def about(self, what: str, dtype: np.dtype[Any]) -> Mapping[str, Any]:
        """Give the largest value there can be, and how it is shown."""
        largest = {"labels": self.seeds.largest_label, "diagram": 1, "distance": 0}.get(what)
        made = {"tiled": self.options.tiled, "largest_label": np.iinfo(dtype).max if largest is None else largest}
        if what == "diagram":
            from vorotool.render.canvas.styles import LINE_ON_PAPER

            made |= {"palette": LINE_ON_PAPER, "bit_depth": 1}
        return made if what != "distance2" else {**made, "scale": scale_of_squares(self._exact_rows().step)}

    def write_page(self, out: BinaryIO) -> None:
        """Write a page that shows the regions."""
        from vorotool.render.pages.html import write_labels_html

        more = unit_columns(self.options.pixel_size, len(self.colors[0]))
        write_labels_html(out, self.whole, self.colors, self.written("table", "html"), more, y_up=is_up(self.whole))

    def drawing(self, what: str, fmt: str) -> LabelPicture:
        """Prepare a picture, which shows the seeds as well."""
        from vorotool.render.label_images.picture import label_picture

        y_up = self.backdrop is None and is_up(self.whole)
        return label_picture(self.whole, self.colors, self.products[what], self.wanted, y_up=y_up)

    def frames(self, what: str) -> Callable[[Fraction], NDArray[np.uint8]]:
        """Draw cells that grow from their seeds until they fill the frame, or to the largest distance."""
        o, whole, rows = self.options, self.drawing(what, "png"), self._exact_rows()
        squares = rows.squared_distances(dtype=rows.measured_dtype)
        farthest = (isqrt(int(squares.max(initial=0))) + 1) * rows.step
        last = farthest if o.max_distance is None else min(farthest, o.max_distance)
        widths = {"cells": 1.0 if whole.shows_borders else 0.0} | dict(whole.style.widths)
        whole = replace(whole, style=replace(whole.style, widths=widths))

        def draw(part: Fraction) -> NDArray[np.uint8]:
            limit = squared_limit(part * last, 1 / rows.step)
            labels = np.where(squares <= limit, whole.image.labels, 0)
            return replace(whole, image=replace(whole.image, labels=labels)).pixels()

        return draw

    @cached_property
    def world(self) -> World:
        """Where what is drawn lies: lengths are those across the picture."""
        from vorotool.jobs.picture_world import world_of

        o, frame = self.options, self.seeds.frame or self.frame
        made = world_of(self.run, o, frame=frame.box, size=o.pixel_size)
        if made.scale_bar is None or self.sides == SQUARE:
            return made
        return made._replace(scale_bar=made.scale_bar._replace(factor=float(self.sides.lengths[-1])))

    def _exact_rows(self) -> Tessellator:
        assert isinstance(self.sweep, Tessellator)  # the command refuses distances of the propagation
        return self.sweep

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        rows, counts = self.sweep, super().stats()
        if isinstance(rows, Tessellator):
            return {**counts, "distance2_step": str(rows.step), "arithmetic": rows.arithmetic, "simd": rows.simd}
        return {**counts, "passes": self.options.passes or 2, **rows.compare_with_exact()}


def rows_of_large(o: Options, source: Opened) -> ZarrRows | TiffRows | None:
    """Give an image band by band, if it is large or its bands go to a cluster, and the options allow that."""
    held = o.verify or o.seeds == "centroids" or o.threshold == "otsu" or o.method != "exact" or o.columns is not None
    rows = None if held or not set(o.what) <= OF_LARGE else source.rows()
    if rows is None:
        return None
    height, width = rows.shape
    if o.cleans_masks:
        if height * width > max(o.max_pixels, LARGE):
            raise LimitError(
                f"{o.cleans_masks} needs the whole image in memory, but its {width} x {height} pixels are more than "
                f"--max-pixels {o.max_pixels}: raise that if there is memory for it, or leave out {o.cleans_masks} to "
                "read the image in bands"
            )
        return None
    on_cluster = o.cluster is not None and o.out_dir is None
    return rows if on_cluster or height * width > LARGE else None


def _streamed(run: Run, o: Options, image: ZarrRows | TiffRows) -> StreamedImage:
    """Read an image that is not held."""
    from vorotool.formats.zarr.writer import CHUNK

    refuse(o, OF_FRAMES, _OF_POINTS)
    if image.note:
        run.note(image.note)
    assert o.seeds != "centroids"  # of such images, and of those with Otsu's threshold, all is held
    assert o.threshold != "otsu"
    step = CHUNK[0] if o.chunk is None else max(LEAST_ROWS, o.chunk[1])
    source = PartwiseObjects(image, o.seeds, int(o.connectivity or 8), o.threshold, o.invert, step)
    reports = {"reading": run.progress("read"), "progress": run.progress("tessellate")}
    how = {"max_distance": o.max_distance, "sides": sides_of(o), "has_sites": bool(TABLES & set(o.what)), **reports}
    place = "engines.tessellation.streamed_image:StreamedImage"
    sweep: StreamedImage = run.call(o, place, source, phase=None, **how)
    if {"distance", "distance2"} & set(o.what):
        sweep.check_distances()
    return sweep


class StreamedProducts(Products):
    """Results of one image that is not held."""

    def check(self, target: Target) -> None:
        """Refuse what cannot be written in the format of a target."""
        if target.fmt in ("svg", "html"):
            raise UsageError("the image is too large for a picture: write a PNG, a TIFF or a Zarr store")
        super().check(target)

    def band(self, what: Any, dtype: np.dtype[Any], first: int, count: int) -> Band:
        """Give some rows as what computes them anywhere."""
        return self.sweep.band(what, dtype, first, count, self.options.max_distance if what == "labels" else None)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        counts = {**super().stats(), "seeds": self.sweep.pixels, "objects": self.sweep.source.mode}
        if not TABLES & set(self.options.what):
            del counts["labels"]  # objects have sites for tables alone
        return counts


def check(o: Options, _targets: Sequence[Target]) -> None:
    """Refuse sizes without a depth for a volume, those with one for an image, and cells of no size."""
    depth = 3 if o.is_of_space else 2
    for name, sides in (("--size", o.size), ("--chunk", o.chunk)):
        if sides is not None and len(sides) != depth:
            shown = "x".join(map(str, sides))
            form = "WxHxD for a volume, such as 256x256x64" if depth == 3 else "WxH for an image, such as 2048x512"
            raise UsageError(f"{name} {shown} has {len(sides)} numbers: give {name} {form}")
    if o.window is not None and len(o.window) != 2 * depth:
        raise UsageError("--window has four numbers: give six for a volume, X,Y,Z,W,H,D")
    _check_side(known_length(o.cell_size))


def _check_side(side: Fraction | None) -> None:
    if side is not None and not 1e-100 < side < 1e100:
        raise UsageError("--cell-size must be more than 0, and at most 1e100")


MOST_NAMED = 5
"""Features without a cell that a warning names."""


def seeds_on_map(run: Run, o: Options, given: JobInput, value: PointSet | PolygonSet) -> tuple[Options, SeedSet]:
    """Lay cells over a map, and find the seeds in them: points, or the cells of lines and polygons."""
    is_empty = not len(value.xy)
    if is_empty and o.window is None and o.like is None:
        return o, no_seeds(run, o, value)
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
        return o, replace(no_seeds(run, o, value), grid=grid)
    placed = replace(value, y_axis=UNSTATED)  # pictures show the first row on top, as the image has it
    if isinstance(placed, PointSet):
        seeds = seeds_in_frame(placed, frame, strict=o.strict)
    else:
        with run.phase("rasterize"):
            seeds = _seeds_of_features(o, placed, frame)
    return o, replace(seeds, grid=grid)


def _cells(o: Options, value: PointSet | PolygonSet) -> tuple[Frame, PixelGrid]:
    """Lay cells of ``--cell-size`` over what there is, or over a window."""
    assert o.cell_size is not None
    _check_side(o.cell_size)
    low, high = bounds(value.xy) if len(value.xy) else (np.zeros(2), np.zeros(2))
    return map_frame(low, high, o.cell_size, window=o.window, y_axis=value.y_axis, crs=value.crs)


def _cells_of_raster(
    run: Run, o: Options, path: str, given: JobInput, value: PointSet | PolygonSet
) -> tuple[Frame, PixelGrid | None]:
    """Give the pixels of a raster, which lies on a map, or whose pixels are the coordinates."""
    from vorotool.formats.io.sources import reading
    from vorotool.jobs.second_files import in_one_crs

    with reading(path):
        header = resolved("formats.images.image_header:image_header")(path)
        if header.note:
            run.note(header.note)
        frame, grid = Frame(0, 0, header.width, header.height), header.grid
        is_stated = o.pixel_size is not None and o.pixel_size.unit is not None
        _check_units(path, given, value.crs, None if is_stated else run.coordinates, grid)
        if grid is None or grid.transform is None:
            return frame, grid
        _check_upright(path, given, value, grid)
        a, _, c, _, e, f = grid.transform
        corners = PointSet(np.array([(c, f), (c + a * frame.width, f + e * frame.height)]), crs=grid.crs)
        return frame, replace(grid, crs=in_one_crs(run, (given.name, value), (path, corners)).crs)


def _check_units(path: str, given: JobInput, crs: Any, unit: InputUnit | None, grid: PixelGrid | None) -> None:
    """Refuse coordinates that state another unit than those of a raster, which may be its pixels."""
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
        raise InputError(
            f"{path} is rotated, mirrored or sheared on the map: straighten it with gdalwarp {path} upright.tif"
        )
    if not grid.is_square:
        raise InputError(
            f"{path} has pixels of {grid.size_text()}, but cells are squares: resample it with gdalwarp -tr SIDE SIDE "
            f"{path} square.tif"
        )
    if value.y_axis == DOWN and grid.is_north_up:
        raise InputError(f"y goes down in {given.name}, but up in {path}: --y-up uses the numbers as they are")


def _size_of_cells(o: Options, side: Fraction, grid: PixelGrid) -> PixelSize:
    """Return the size by which results are in the unit of the map, times ``--pixel-size``."""
    asked = PixelSize(Fraction(1), None) if o.pixel_size is None else o.pixel_size
    x, y = grid.center
    factor = float(asked.factor)
    place: dict[str, Any] = {"origin": (x * factor, y * factor), "y_up": grid.is_north_up, "crs": grid.crs}
    return PixelSize(Fraction(1), asked.unit, **place, sides=PixelSides((1, 1), side * asked.factor))


def _seeds_of_features(o: Options, polygons: PolygonSet, frame: Frame) -> SeedSet:
    """The cells of each feature are the seeds of its label; its properties are those of its first part."""
    require_memory(frame, o.max_pixels)
    labels = resolved("engines.tessellation.rasterized:rasterized")(polygons, frame)
    if not labels.any():
        raise InputError("no feature has a cell in the frame: use a smaller --cell-size, or another --window or --like")
    seeds = seeds_from_raster(Raster(labels), mode="labels", max_sites=o.max_sites)
    features, first = np.unique(polygons.feature, return_index=True)
    seen = seeds.site_labels.astype(np.int64) - 1
    known, missing = first[np.searchsorted(features, seen)].tolist(), np.setdiff1d(features, seen) + 1
    if len(missing):
        shown = ", ".join([*map(str, missing[:MOST_NAMED].tolist()), *(["…"] if len(missing) > MOST_NAMED else [])])
        number = f"{len(missing)} of {len(features)}"
        warn(f"{number} features without a cell, because they are small, covered or outside: {shown}")
    return replace(seeds, properties={name: [column[k] for k in known] for name, column in polygons.properties.items()})
