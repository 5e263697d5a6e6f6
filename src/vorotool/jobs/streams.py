"""Images and volumes that are written as they are computed: into files, and into Zarr stores chunk by chunk."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property, partial
from math import prod
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.frames import band_limits, label_dtype, require_memory
from vorotool.engines.tessellation.tessellator import Band, SeedBands, Tessellator, with_neighbors
from vorotool.errors import LimitError
from vorotool.frozen import frozen
from vorotool.jobs.inputs import JobInput, check_columns, frame_of
from vorotool.jobs.job import Results
from vorotool.jobs.options import AUTO_LEVELS, Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.jobs.units import sides_of, table_in_units
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.types.images import LabelImage
from vorotool.types.pixels import CELL, SQUARE, Frame, PixelSides
from vorotool.types.table import Table
from vorotool.types.volumes.volume import LabelVolume, VoxelFrame

if TYPE_CHECKING:
    from pathlib import Path

    from vorotool.engines.label_images.measured_regions import Regions
    from vorotool.engines.tessellation.tessellate import PropagatedRows
    from vorotool.types.points.seed_set import SeedSet
    from vorotool.types.volumes.volume import VolumeSeeds

PartOf = Callable[[int, int], NDArray[Any]]
"""``part_of(first, count)`` gives some rows of an image, or slices of a volume."""
Limits = Sequence[tuple[int, int]]
"""First row or slice, and number of them, of each part."""

SAMPLES = 3
"""Parts that are encoded to learn how much room all need, where it may not be there."""

STREAMED = frozenset({"labels", "diagram", "distance", "distance2"})
"""Results that need not be in memory."""


@frozen
class Stream:
    """An image or a volume that need not be in memory."""

    frame: Frame | VoxelFrame
    part_of: PartOf
    dtype: np.dtype[Any]
    band: Callable[[int, int], Band]  # gives any part as what computes it anywhere
    limits: Limits  # parts that suit what computes them
    about: Mapping[str, Any]  # further options of `write_label_image` or `write_volume`

    def parts(self, limits: Limits) -> Iterator[NDArray[Any]]:
        """Give all of it, part by part."""
        return (self.part_of(first, count) for first, count in limits)

    def write(self, out: Any, fmt: Any, parts: Iterator[NDArray[Any]], count: int) -> None:
        """Write parts of so many rows or slices to a file."""
        is_flat = isinstance(self.frame, Frame)
        writer = "images.label_images:write_label_image" if is_flat else "images.tiff_writer:write_volume"
        shape = (count, *self.frame.shape[1:])
        resolved(f"formats.{writer}")(out, parts, shape=shape, dtype=self.dtype, fmt=fmt, **self.about)

    def expected(self, count: int, size_of: Callable[[NDArray[Any]], int]) -> int:
        """Estimate the bytes of the whole from those of some parts of so many rows or slices, which differ."""
        whole = self.frame.shape[0]
        parts = -(-whole // count)
        seen = size = 0
        for part in sorted({parts * (2 * k + 1) // (2 * SAMPLES) for k in range(SAMPLES)}):
            rows = min(count, whole - part * count)
            size += size_of(self.part_of(part * count, rows))
            seen += rows
        return size * whole // seen


class Tessellated(Results):
    """Results of one tessellation, of which any rows or slices can be computed."""

    def __init__(self, run: Run, options: Options, given: JobInput, sweep: Any, sides: PixelSides, grid: Any) -> None:
        super().__init__(run, options)
        self.sweep, self.frame, self.seeds = sweep, sweep.frame, sweep.seeds
        self.sides, self.grid = sides, grid
        self.is_held = False  # whether all labels are in memory: set before anything is written
        self.with_distances = given.has_page or "table" in options.what
        check_columns(options, self.seeds.properties)
        self.dtype = label_dtype(self.seeds.largest_label, options.dtype)

    @cached_property
    def whole(self) -> Any:
        """The whole label image or volume, in memory."""
        require_memory(self.frame, self.options.max_pixels)
        kind = LabelImage if len(self.frame.shape) == 2 else LabelVolume
        return kind(self.labels(), self.frame, self.seeds, sides=self.sides)

    @cached_property
    def colors(self) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """Labels, and the color class of each."""
        measures = self.regions.measures
        return resolved("engines.label_images.regions:region_colors")(self.whole, measures=measures)

    def labels(self, first: int = 0, count: int | None = None) -> NDArray[Any]:
        """Compute the labels of some rows or slices."""
        with self.run.phase("tessellate"):
            return self.sweep.labels(first, count, dtype=self.dtype)

    @cached_property
    def regions(self) -> Regions:
        """Areas, borders and boxes of the regions: one pass that tables and colors share."""
        given = (self._label_parts(), self.frame, self.sides, self.seeds)
        return self.call("engines.label_images.measured_regions:regions_of_parts", *given, phase=None)

    def _label_parts(self) -> Iterator[tuple[NDArray[Any], NDArray[Any] | None]]:
        """Give labels part by part, with squared distances where a table needs them."""
        has_squares = self.with_distances and len(self.seeds) and isinstance(self.sweep, Tessellator)
        for first, count in self.limits():
            if has_squares and not self.is_held:
                with self.run.phase("tessellate"):
                    both = self.sweep.measured(first, count, self.dtype)
                yield both
                continue
            labels = self.whole.labels[first : first + count] if self.is_held else self.labels(first, count)
            dtype = self.sweep.measured_dtype if has_squares else None
            yield labels, self.sweep.squared_distances(first, count, dtype=dtype) if has_squares else None

    @cached_property
    def _table(self) -> Table:
        return self.regions.table(threads=self.options.threads)

    def written(self, what: str, fmt: str) -> Table:
        """Give a table in the units of files; of a volume, it is in the unit of distances already."""
        from vorotool.types.identity import ends_of_regions

        table = self._table if what == "table" else self.regions.neighbors()
        if isinstance(self.frame, Frame):
            own = {"properties": self.seeds.properties, "has_rows": True} if what == "table" else {}
            table = table_in_units(self.options.pixel_size, table, **own)
        return table if what == "table" else ends_of_regions(table, self.seeds)

    def write_data(self, out: BinaryIO, target: Target) -> None:
        """Write an image or a volume part by part, if there is room for it; tables are made of the whole."""
        if target.what not in STREAMED:
            super().write_data(out, target)
            return
        from vorotool.formats.io.descriptors import check_space

        stream, fmt = self.stream(target.what), target.fmt
        whole = stream.frame.shape[0]

        def size_of(part: NDArray[Any]) -> int:
            sample = io.BytesIO()
            stream.write(sample, fmt, iter([part]), len(part))
            return sample.tell()

        most = prod(stream.frame.shape) * (11 if fmt == "text" else stream.dtype.itemsize)
        check_space(target.path, most, lambda: stream.expected(stream.limits[0][1], size_of))
        stream.write(out, fmt, stream.parts(stream.limits), whole)

    def write_store(self, target: Target, rules: Mapping[str, Any]) -> None:
        """Write an image or a volume to a Zarr store, if there is room for it: here, or on a cluster."""
        from vorotool.formats.io.descriptors import check_space
        from vorotool.formats.zarr.store import open_store
        from vorotool.formats.zarr.writer import add_levels, array_folder, create_array, write_chunks

        o, stream = self.options, self.stream(target.what)
        shape, dtype, chunks = stream.frame.shape, stream.dtype, check_chunks(o, stream)
        levels = _levels(o, shape)
        room = Fraction(8, 7) if levels else 1  # each copy has an eighth of the voxels of the one before

        def size_of(part: NDArray[Any]) -> int:
            files: dict[str, Any] = {}
            write_chunks(create_array(files, part.shape, dtype=dtype, chunks=chunks), 0, part, threads=o.threads)
            return sum(map(len, files.values()))

        most = int(room * prod(shape) * dtype.itemsize)
        check_space(target.path, most, lambda: int(room * stream.expected(chunks[0], size_of)))
        with open_store(target.path, **rules) as store:
            grid, is_labels = stream.about.get("grid"), target.what == "labels"
            folder = array_folder(store, target.path, len(shape), grid=grid, is_labels=is_labels)
            scale = stream.about.get("scale")
            about = None if scale is None else {"scale": scale}  # no name that readers would turn integers to floats by
            array = create_array(folder, shape, dtype=dtype, chunks=chunks, attributes=about)
            limits = _of_chunks(stream, chunks[0])
            if o.cluster is not None and o.out_dir is None:
                _write_on_cluster(self.run, folder, stream.band, limits, address=o.cluster, jobs=o.jobs)
            else:
                for (first, _), part in zip(limits, stream.parts(limits), strict=True):
                    write_chunks(array, first, part, threads=o.threads)
            add_levels(store, levels, threads=o.threads)

    def stream(self, what: str) -> Stream:
        """Give labels, the diagram or distances."""
        part_of: PartOf = {"labels": self.labels, "diagram": self._diagram}.get(what) or getattr(
            self.sweep, {"distance": "distances", "distance2": "squared_distances"}[what]
        )
        kinds = {"labels": self.dtype, "diagram": np.dtype(np.uint8), "distance": np.dtype(np.float32)}
        dtype = kinds.get(what) or self.sweep.square_dtype
        is_cut = what == "labels" and self.options.max_distance is not None
        about = {"grid": self.grid, "nodata": 0 if is_cut else None, **self.about(what, dtype)}
        return Stream(self.frame, part_of, dtype, partial(self.band, what, dtype), self.limits(), about)

    def _diagram(self, first: int, count: int) -> NDArray[Any]:
        """Compute some rows of the diagram, which the ones beside them have a part in."""
        begin, whole = with_neighbors(self.frame, first, count)
        labels = self.labels(begin, whole)
        made: NDArray[Any] = self.call("engines.label_images.regions:diagram_of", labels, phase=None)
        return made[first - begin :][:count]

    def band(self, what: Any, dtype: np.dtype[Any], first: int, count: int) -> Band:
        """Give some rows or slices as what computes them anywhere."""
        limit = self.options.max_distance
        return self._seed_bands.band(what, dtype, first, count, sides=self.sides, max_distance=limit)

    @cached_property
    def _seed_bands(self) -> SeedBands:
        return SeedBands(self.seeds, self.frame)

    def limits(self) -> Limits:
        """Give the parts in which it is streamed."""
        return band_limits(self.frame, len(self.seeds))

    def about(self, what: str, dtype: np.dtype[Any]) -> Mapping[str, Any]:
        """Give further options of the writer of a result."""
        return {}

    def verify(self, progress: Progress) -> None:
        """Check the labels of every part against an independent nearest-seed search."""
        self.call("engines.tessellation.tessellate:verify_rows", self.sweep, phase=None, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        seeds, frame, o = self.seeds, self.frame, self.options
        return {
            "seeds": len(seeds),
            "labels": len(seeds.site_labels) if seeds.site_labels is not None else 0,
            "largest_label": seeds.largest_label,
            "duplicates": self.sweep.duplicates,
            **{"snapped": seeds.snapped, "largest_move": seeds.largest_move},
            f"steps_per_{CELL[len(frame.shape)]}": seeds.scale,
            "frame": [*frame.origin, *reversed(frame.shape)],
            **{"method": o.method, "threads": o.threads},
        }


def tessellated_rows(run: Run, o: Options, seeds: SeedSet | VolumeSeeds) -> Tessellator | PropagatedRows:
    """Prepare what labels any rows or slices."""
    if len(seeds) > o.max_sites:
        raise LimitError(f"the input has {len(seeds)} seeds, more than --max-sites {o.max_sites}")
    is_square = o.method == "propagation" and o.spacing is None
    sides = SQUARE if is_square else sides_of(o, len(seeds.coordinates))
    how = {"method": o.method, "passes": o.passes or 2, "max_distance": o.max_distance, "sides": sides}
    how["progress"] = run.progress("tessellate")
    place = "engines.tessellation.tessellate:labeled_rows"
    rows: Tessellator | PropagatedRows = run.call(o, place, seeds, frame_of(o, seeds), phase=None, **how)
    if isinstance(rows, Tessellator) and {"distance", "distance2"} & set(o.what):
        rows.check_distances()
    return rows


def check_chunks(o: Options, stream: Stream) -> tuple[int, ...]:
    """Choose rows and columns of the chunks of a store, or slices, rows and columns."""
    from vorotool.formats.zarr.writer import chunks_of, zarr_module

    zarr_module()
    is_image = isinstance(stream.frame, Frame)
    chunks = chunks_of(stream.frame.shape, stream.dtype, None if o.chunk is None else o.chunk[::-1])
    held = (*reversed(stream.frame.shape[1:]), chunks[0])
    if prod(held) > o.max_pixels:
        layer, pixels = ("a row of chunks", "pixels") if is_image else ("a layer of chunks", "voxels")
        size = " x ".join(map(str, held))
        raise LimitError(f"{layer} has {size} {pixels}, more than --max-pixels {o.max_pixels}: use a lower --chunk")
    return chunks


def scale_of_squares(step: Fraction) -> float | None:
    """Return what squared distances are multiplied by; None where they are in pixels."""
    return None if step == 1 else float(step * step)


def _levels(o: Options, shape: tuple[int, ...]) -> int:
    """Return the number of coarser copies."""
    from vorotool.formats.zarr.writer import usual_levels

    assert o.levels is None or len(shape) == 3  # the command refuses copies of images
    return usual_levels(shape) if o.levels == AUTO_LEVELS else o.levels or 0


def _of_chunks(stream: Stream, count: int) -> Limits:
    """Parts of whole chunks so high: of a row of them, or of layers about as many as suit what computes them."""
    each = count if isinstance(stream.frame, Frame) else max(1, stream.limits[0][1] // count) * count
    whole = stream.frame.shape[0]
    return [(first, min(each, whole - first)) for first in range(0, whole, each)]


def _write_on_cluster(
    run: Run, folder: Path, band_of: Callable[[int, int], Band], limits: Limits, *, address: str, jobs: int | None
) -> None:
    """Let a cluster compute the parts of an image or a volume, and write them into a store."""
    from vorotool.batch.cluster import write_bands

    show = run.progress("tessellate")
    bands = ((first, band_of(first, count)) for first, count in limits)
    for done, _ in enumerate(write_bands(folder, bands, address=address, jobs=jobs), start=1):
        if show is not None:
            show(done / len(limits))
