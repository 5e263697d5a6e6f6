"""What a tessellation can be written as (``--what``): each from rows, or from the label image held in memory."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import cached_property
from types import SimpleNamespace
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.cli.run import Run
from vorotool.cli.targets import Target
from vorotool.cli.units import table_in_units
from vorotool.engines.digital import band_limits, label_dtype, require_memory
from vorotool.engines.propagation import PropagatedRows
from vorotool.engines.regions import (
    RegionMeasures,
    measure_regions,
    neighbour_table,
    region_colours,
    region_table,
    voronoi_diagram,
)
from vorotool.engines.sweep import Tessellator
from vorotool.engines.tessellate import verify_rows
from vorotool.geometry.label_image import LabelImage

DARK_LABELS = 1024
"""Labels up to here look black in a 16-bit image."""


class Products:
    """Results of one tessellation.

    Parameters
    ----------
    rows : Tessellator or PropagatedRows
        Gives any rows of labels.
    options : namespace
        Options of the command line.
    run : Run
        Takes notes and seconds.
    """

    def __init__(self, rows: Tessellator | PropagatedRows, options: SimpleNamespace, run: Run) -> None:
        self.rows, self.options, self.run = rows, options, run
        self.dtype = label_dtype(rows.seeds.largest_label, options.dtype)

    @cached_property
    def image(self) -> LabelImage:
        """The whole label image, in memory."""
        require_memory(self.rows.frame, self.options.max_pixels)
        return LabelImage(self._labels(), self.rows.frame, self.rows.seeds)

    def _labels(self, first: int = 0, rows: int | None = None) -> NDArray[Any]:
        with self.run.phase("tessellate"):
            return self.rows.labels(first, rows, dtype=self.dtype)

    @cached_property
    def measures(self) -> RegionMeasures:
        """Areas, borders and boxes of the regions: one pass that tables and colours share."""
        return measure_regions(self.image, threads=self.options.threads)

    @cached_property
    def colours(self) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """Labels, and the colour class of each."""
        return region_colours(self.image, measures=self.measures)

    def check(self, target: Target) -> None:
        """Refuse what cannot be written in the format of a target, before anything is."""
        from vorotool.formats.label_images import check_png
        from vorotool.render.label_svg import check_size

        what, fmt = target.what, target.fmt
        if fmt == "svg":
            check_size(self.rows.frame.shape)
        elif what == "labels" and fmt == "png":
            check_png(self.dtype, self.rows.seeds.largest_label)
        elif what == "distance2":
            _ = self._exact_rows().square_dtype
        draws = what == "diagram" and (self.options.layers or self.options.backdrop)
        if what in ("colour", "table", "neighbours") or fmt == "svg" or draws:
            require_memory(self.rows.frame, self.options.max_pixels)

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        from vorotool.formats.outputs import open_output

        with open_output(
            target.path, binary=target.is_binary, no_clobber=self.options.no_clobber, inputs=inputs
        ) as out:
            getattr(self, f"_write_{target.what}")(out, target.fmt)

    def _write_labels(self, out: BinaryIO, fmt: str) -> None:
        if fmt == "svg":
            self._write_picture(out, fmt, ("cells", "seeds", "labels"))
            return
        largest = self.rows.seeds.largest_label
        if fmt == "png" and largest < DARK_LABELS and sys.stderr.isatty():
            self.run.note(f"labels up to {largest} look black in a 16-bit PNG: --what colour draws a picture")
        self._write_rows(out, fmt, self._labels, self.dtype, largest)

    def _write_diagram(self, out: BinaryIO, fmt: str) -> None:
        from vorotool.render.palettes import LINE_ON_PAPER

        if (self.options.layers or self.options.backdrop) and fmt == "png":
            self._write_picture(out, fmt, ("diagram",))
            return

        def rows_of(first: int, rows: int) -> NDArray[Any]:
            above, below = min(1, first), min(1, self.rows.frame.height - first - rows)
            labels = self._labels(first - above, rows + above + below)
            return voronoi_diagram(labels, threads=self.options.threads)[above : above + rows]

        self._write_rows(out, fmt, rows_of, np.dtype(np.uint8), 1, palette=LINE_ON_PAPER, bit_depth=1)

    def _write_colour(self, out: BinaryIO, fmt: str) -> None:
        self._write_picture(out, fmt, ("cells", "seeds"))

    def _write_distance(self, out: BinaryIO, fmt: str) -> None:
        rows = self._exact_rows()
        self._write_rows(out, fmt, rows.distances, np.dtype(np.float32), 0)

    def _write_distance2(self, out: BinaryIO, fmt: str) -> None:
        rows = self._exact_rows()
        if rows.seeds.scale > 1:
            self.run.note(
                f"squared distances are in units of 1/{rows.seeds.scale}² square pixels: seeds lie between pixels"
            )
        self._write_rows(out, fmt, rows.squared_distances, rows.square_dtype, int(np.iinfo(rows.square_dtype).max))

    def _write_table(self, out: BinaryIO, fmt: str) -> None:
        image, measures = self.image, self.measures  # refuses a frame that is too large, before distances are taken
        squares = self.rows.squared_distances() if isinstance(self.rows, Tessellator) else None
        table = region_table(image, distance2=squares, measures=measures, threads=self.options.threads)
        own = self.rows.seeds.properties
        self._write_columns(out, fmt, table_in_units(self.options, table, properties=own))

    def _write_neighbours(self, out: BinaryIO, fmt: str) -> None:
        table = neighbour_table(self.image, measures=self.measures)
        self._write_columns(out, fmt, table_in_units(self.options, table))

    def _write_columns(self, out: BinaryIO, fmt: str, table: Any) -> None:
        from vorotool.formats.tables import write_table

        write_table(out, table, fmt, precision=self.options.precision, threads=self.options.threads)

    def _write_picture(self, out: BinaryIO, fmt: str, layers: tuple[str, ...]) -> None:
        from vorotool.pictures import write_label_picture

        write_label_picture(
            out,
            self.image,
            self.colours,
            fmt=fmt,
            layers=self.options.layers or layers,
            width=self.options.width or 1000,
            y_up=bool(self.options.y_up) and self.options.backdrop is None,
            backdrop=self.options.backdrop,
            threads=self.options.threads,
        )

    def _write_rows(
        self,
        out: BinaryIO,
        fmt: Any,
        rows_of: Callable[[int, int], NDArray[Any]],
        dtype: np.dtype[Any],
        largest: int,
        **kind: Any,
    ) -> None:
        from vorotool.formats.label_images import write_label_image

        write_label_image(
            out,
            (rows_of(first, rows) for first, rows in band_limits(self.rows.frame)),
            shape=self.rows.frame.shape,
            dtype=dtype,
            fmt=fmt,
            largest_label=largest,
            resolution=getattr(self.options, "resolution", None),
            threads=self.options.threads,
            **kind,
        )

    def _exact_rows(self) -> Tessellator:
        assert isinstance(self.rows, Tessellator)  # the command refuses distances of the propagation
        return self.rows

    def verify(self) -> None:
        """Check the labels of every band against an independent nearest-seed search."""
        verify_rows(self.rows, threads=self.options.threads)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        rows, seeds = self.rows, self.rows.seeds
        counts: dict[str, Any] = {
            "seeds": len(seeds),
            "labels": len(seeds.site_labels) if seeds.site_labels is not None else 0,
            "largest_label": seeds.largest_label,
            "duplicates": rows.duplicates,
            "snapped": seeds.snapped,
            "largest_move": seeds.largest_move,
            "steps_per_pixel": seeds.scale,
            "frame": [rows.frame.x, rows.frame.y, rows.frame.width, rows.frame.height],
            "method": self.options.method,
            "threads": self.options.threads,
        }
        if isinstance(rows, Tessellator):
            return {**counts, "arithmetic": rows.arithmetic, "simd": rows.simd}
        return {**counts, "passes": self.options.passes or 2, **rows.compare_with_exact()}
