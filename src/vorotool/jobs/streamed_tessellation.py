"""Tessellations of images beyond memory: what can be written of them, and which images are such."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.bands import Band
from vorotool.engines.tessellation.frames import band_limits, label_dtype
from vorotool.engines.tessellation.streamed_image import ObjectRows, StreamedImage
from vorotool.errors import LimitError, UsageError
from vorotool.formats.opening import Opened
from vorotool.jobs.options import Options
from vorotool.jobs.pixel_sizes import written_grid
from vorotool.jobs.refusals import refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.streams import Stream, Streamed, check_chunks, scale_of_squares
from vorotool.jobs.targets import Target
from vorotool.jobs.units import sides_of, unit_text
from vorotool.numeric.parallel import Progress

if TYPE_CHECKING:
    from vorotool.formats.images.band_reader import TiffRows, ZarrRows

LARGE = 2**24
"""Pixels from which an image that can be read in bands is not held: a seed in memory takes some 40 bytes."""

LEAST_ROWS = 128
"""Rows that are read at a time, however low chunks are: for each band two lists are kept."""

STREAMED = frozenset({"labels", "distance", "distance2"})
"""What can be written of an image that is not held."""


def rows_of_large(o: Options, source: Opened) -> ZarrRows | TiffRows | None:
    """Give an image band by band, if it is large or its bands go to a cluster, and the options allow that."""
    held = o.verify or o.seeds == "centroids" or o.threshold == "otsu" or o.method != "exact" or o.columns is not None
    rows = None if held or not set(o.what) <= STREAMED else source.rows()
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


class StreamedProducts(Streamed):
    """Results of one image that is not held."""

    def __init__(self, run: Run, options: Options, image: ZarrRows | TiffRows) -> None:
        refuse(
            options.of_frame,
            "applies to lists of points, but the input is an image with its own frame",
        )
        super().__init__(run, options)
        self.grid = written_grid(options.pixel_size, image.grid)
        if image.note:
            run.note(image.note)
        from vorotool.formats.zarr.writer import CHUNK

        assert options.seeds != "centroids"  # of such images, and of those with Otsu's threshold, all is held
        assert options.threshold != "otsu"
        source = ObjectRows(
            image,
            options.seeds,
            int(options.connectivity or 8),
            options.threshold,
            options.invert,
            CHUNK[0] if options.chunk is None else max(LEAST_ROWS, options.chunk[1]),
        )
        self.image = StreamedImage(
            source,
            max_sites=options.max_sites,
            strict=options.strict,
            progress=run.progress("read"),
            note=run.note,
            sides=sides_of(options),
        )
        if set(options.what) & {"distance", "distance2"}:
            self.image.check_distances()
        self.dtype = label_dtype(self.image.largest_label, options.dtype)

    def check(self, target: Target) -> None:
        """Refuse what cannot be written in the format of a target."""
        from vorotool.formats.images.label_images import check_png

        if target.fmt in ("svg", "html"):
            raise UsageError("the image is too large for a picture: write a PNG, a TIFF or a Zarr store")
        stream = self.stream(target.what)
        if target.fmt == "png":
            check_png(stream.dtype, stream.about["largest_label"])
        if target.fmt == "zarr":
            check_chunks(self.options, stream)

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        if target.what == "distance2" and self.options.spacing is not None:
            step = self.image.sides.step
            self.run.note(f"squared distances are in squares of a step of {step}{unit_text(self.options.pixel_size)}")
        super().write(target, inputs=inputs)

    def stream(self, what: Any) -> Stream:
        """Labels or distances, band by band."""
        dtype, largest, frame = self.dtype, self.image.largest_label, self.image.frame
        if what == "distance":
            dtype, largest = np.dtype(np.float32), 0
        elif what == "distance2":
            dtype = self.image.square_dtype
            largest = int(np.iinfo(dtype).max)
        limit = self.options.max_distance if what == "labels" else None
        band = partial(self.image.band, what, dtype, max_distance=limit)
        scale = scale_of_squares(self.image.sides.step) if what == "distance2" else None
        about = {"grid": self.grid, "nodata": None if limit is None else 0, "scale": scale, "tiled": self.options.tiled}
        about["largest_label"] = largest
        return Stream(frame, partial(self._rows, band), dtype, band, list(band_limits(frame)), about)

    def _rows(self, band: Callable[[int, int], Band], first: int, rows: int) -> NDArray[Any]:
        show = self._progress
        with self.run.phase("tessellate"):
            made = band(first, rows).rows(threads=self.options.threads)
        if show is not None:
            show((first + rows) / self.image.frame.height)
        return made

    @cached_property
    def _progress(self) -> Progress:
        return self.run.progress("tessellate")

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        frame = self.image.frame
        with_sides: dict[str, Any] = {}
        if self.options.spacing is not None:
            with_sides = {"distance2_step": str(self.image.sides.step), "arithmetic": self.image.arithmetic}
        return {
            **with_sides,
            "seeds": self.image.pixels,
            "largest_label": self.image.largest_label,
            "frame": [frame.x, frame.y, frame.width, frame.height],
            "objects": self.image.source.mode,
            "method": "exact",
            "threads": self.options.threads,
        }
