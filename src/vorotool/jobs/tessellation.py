"""What a tessellation can be written as (``--what``): each from rows, or from the label image held in memory."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property, partial
from math import isqrt
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.bands import Band, SeedBand, SeedBands
from vorotool.engines.tessellation.frames import band_limits, require_memory, squared_limit
from vorotool.engines.tessellation.propagation import PropagatedRows
from vorotool.engines.tessellation.seeding import seeds_in_frame
from vorotool.engines.tessellation.tessellate import labeled_rows, verify_rows
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import LimitError
from vorotool.jobs.checked_columns import tell_outside
from vorotool.jobs.inputs import JobInput, asked_frame, frame_of, no_seeds, opened_input, read_opened, seeds_of_image
from vorotool.jobs.map_cells import seeds_on_map
from vorotool.jobs.options import Options
from vorotool.jobs.pixel_sizes import lengths_of_image, with_pixel_size, written_grid
from vorotool.jobs.refusals import check_image_size, refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.streamed_tessellation import StreamedProducts, rows_of_large
from vorotool.jobs.streams import STREAMED, Limits, Tessellated, check_chunks, scale_of_squares
from vorotool.jobs.targets import Target
from vorotool.jobs.units import sides_of, table_in_units, unit_columns, unit_text
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import ANIMATIONS
from vorotool.types.axis import is_up
from vorotool.types.pixel_frame import Frame
from vorotool.types.pixel_grid import PixelGrid
from vorotool.types.points.label_image import LabelImage
from vorotool.types.points.point_set import PointSet
from vorotool.types.points.raster import Raster
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.spacing import SQUARE
from vorotool.types.table import Table

if TYPE_CHECKING:
    from vorotool.engines.label_images.regions import RegionMeasures
    from vorotool.render.label_images.picture import LabelPicture
    from vorotool.render.looks import World

DARK_LABELS = 1024
"""Labels up to here look black in a 16-bit image."""


class ReadSeeds(NamedTuple):
    """Seeds, and what else an input says."""

    seeds: SeedSet
    grid: PixelGrid | None = None  # sides and places of the pixels of the image


def products(run: Run, o: Options, given: JobInput) -> Products | StreamedProducts:
    """Read points or an image, and prepare what labels any rows."""
    with run.phase("read"):
        with opened_input(o, given, None if o.is_laid_out else "points") as source:
            large = rows_of_large(o, source)
            with_columns = "table" in o.what or o.names_columns or given.has_page
            if large is None:
                with_unit = o.like is not None
                o, value = read_opened(
                    run, o, given, source, columns=o.columns, properties=with_columns, wants_unit=with_unit
                )
        if large is not None:
            run.grid = large.grid
            check_image_size(run, o, given.name, large.grid)
            o = with_pixel_size(run, lengths_of_image(o, large.grid), given, large.grid)
            return StreamedProducts(run, o, large)
        if o.is_laid_out and not isinstance(value, Raster):
            o, seeds = seeds_on_map(run, o, given, value)
            read = ReadSeeds(seeds, grid=seeds.grid)
        else:
            read = _seeds_of(run, o, value)
        if isinstance(value, Raster):
            o = with_pixel_size(run, o, given, read.grid)
    with run.phase("prepare" if o.method == "exact" else "tessellate"):
        rows = _rows_of(run, o, read.seeds)
    if isinstance(value, PointSet):
        _tell_outside(run, rows)
    return Products(run, o, given, read, rows)


def _tell_outside(run: Run, rows: Tessellator | PropagatedRows) -> None:
    seeds, (left, top, right, bottom) = rows.seeds, rows.frame.box.sides
    if seeds.sites is not None and seeds.site_labels is not None:
        x, y = seeds.sites.T
        tell_outside(run, seeds.site_labels, (x < left) | (x > right) | (y < top) | (y > bottom))


def _seeds_of(run: Run, o: Options, value: PointSet | PolygonSet | Raster) -> ReadSeeds:
    if isinstance(value, PointSet) and not len(value):
        return ReadSeeds(replace(no_seeds(run, o), y_axis=value.y_axis))
    if isinstance(value, PointSet):
        frame = asked_frame(o) or partial(frame_of, o)
        seeds = seeds_in_frame(value, frame, sides=sides_of(o), strict=o.strict)
        return ReadSeeds(seeds)
    assert isinstance(value, Raster)  # what is asked for is points, or an image
    alone = {"columns": o.columns, **o.of_frame}
    refuse(alone, "applies to lists of points, but the input is an image with its own frame")
    return ReadSeeds(seeds_of_image(run, o, value, o.seeds), grid=value.grid)


def _rows_of(run: Run, o: Options, seeds: SeedSet) -> Tessellator | PropagatedRows:
    if len(seeds) > o.max_sites:
        raise LimitError(f"the input has {len(seeds)} seeds, more than --max-sites {o.max_sites}")
    rows = labeled_rows(
        seeds,
        frame_of(o, seeds),
        method=o.method,
        passes=o.passes or 2,
        max_distance=o.max_distance,
        sides=SQUARE if o.method == "propagation" and o.spacing is None else sides_of(o),
        strict=o.strict,
        threads=o.threads,
        max_pixels=o.max_pixels,
        progress=run.progress("tessellate"),
    )
    if isinstance(rows, Tessellator) and {"distance", "distance2"} & set(o.what):
        rows.check_distances()
    return rows


class Products(Tessellated):
    """Results of one tessellation."""

    begins_empty = True

    def __init__(
        self,
        run: Run,
        options: Options,
        given: JobInput,
        read: ReadSeeds,
        rows: Tessellator | PropagatedRows,
    ) -> None:
        super().__init__(run, options, rows, written_grid(options.pixel_size, read.grid))
        self.backdrop, self.sides = given.backdrop, sides_of(options)

    @cached_property
    def image(self) -> LabelImage:
        """The whole label image, in memory."""
        require_memory(self.frame, self.options.max_pixels)
        return LabelImage(self.labels(), self.frame, self.seeds, sides=self.sides)

    @cached_property
    def measures(self) -> RegionMeasures:
        """Areas, borders and boxes of the regions: one pass that tables and colors share."""
        from vorotool.engines.label_images.regions import measure_regions

        return measure_regions(self.image, threads=self.options.threads)

    @cached_property
    def colors(self) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """Labels, and the color class of each."""
        from vorotool.engines.label_images.regions import region_colors

        return region_colors(self.image, measures=self.measures)

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
        if what not in STREAMED or self.is_picture(target):
            require_memory(self.frame, self.options.max_pixels)

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

    def limits(self) -> Limits:
        """Give bands of rows."""
        return list(band_limits(self.frame))

    def band(self, what: Any, dtype: np.dtype[Any], first: int, count: int) -> Band:
        """Give some rows as what computes them anywhere."""
        frame = self.frame
        place = Frame(frame.x, frame.y + first, frame.width, count)
        seeds = self._seed_bands.seeds_of(first, count)
        return SeedBand(seeds, place, what, dtype, self.options.max_distance, self.sides)

    @cached_property
    def _seed_bands(self) -> SeedBands:
        return SeedBands(self.seeds, self.frame)

    def diagram_of(self, labels: NDArray[Any]) -> NDArray[Any]:
        """Mark pixels beside others of other labels."""
        from vorotool.engines.label_images.regions import voronoi_diagram

        return voronoi_diagram(labels, threads=self.options.threads)

    def written(self, what: str, fmt: str) -> Table:
        """Give a table of the whole image, in the units of files."""
        from vorotool.engines.label_images.regions import neighbor_table, region_table
        from vorotool.types.identity import ends_of_regions

        image, measures = self.image, self.measures  # refuses a frame that is too large, before distances are taken
        size, seeds = self.options.pixel_size, self.seeds
        if what == "neighbors":
            return ends_of_regions(table_in_units(size, neighbor_table(image, measures=measures)), seeds)
        has_distances = isinstance(self.sweep, Tessellator) and len(seeds)
        rows = self._exact_rows() if has_distances else None
        squares = None if rows is None else rows.squared_distances(dtype=rows.measured_dtype)
        table = region_table(image, distance2=squares, measures=measures, threads=self.options.threads)
        return table_in_units(size, table, properties=seeds.properties, has_rows=True)

    def write_page(self, out: BinaryIO) -> None:
        """Write a page that shows the regions."""
        from vorotool.render.pages.html import write_labels_html

        more = unit_columns(self.options.pixel_size, len(self.colors[0]))
        write_labels_html(out, self.image, self.colors, self.written("table", "html"), more, y_up=is_up(self.image))

    def drawing(self, what: str, fmt: str) -> LabelPicture:
        """Prepare a picture, which shows the seeds as well."""
        from vorotool.render.label_images.picture import label_picture

        y_up = self.backdrop is None and is_up(self.image)
        return label_picture(self.image, self.colors, self.products[what], self.wanted, y_up=y_up)

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

    def verify(self, progress: Progress) -> None:
        """Check the labels of every band against an independent nearest-seed search."""
        verify_rows(self.sweep, threads=self.options.threads)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        rows, frame = self.sweep, self.frame
        counts: dict[str, Any] = {
            **super().stats(),
            "steps_per_pixel": self.seeds.scale,
            "frame": [frame.x, frame.y, frame.width, frame.height],
            "method": self.options.method,
            "threads": self.options.threads,
        }
        if isinstance(rows, Tessellator):
            return {**counts, "distance2_step": str(rows.step), "arithmetic": rows.arithmetic, "simd": rows.simd}
        return {**counts, "passes": self.options.passes or 2, **rows.compare_with_exact()}
