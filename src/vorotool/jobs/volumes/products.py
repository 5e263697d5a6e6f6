"""What the tessellation of a volume can be written as: each from slabs, or from the label volume held in memory."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.label_images.regions import region_colors
from vorotool.engines.tessellation.frames import label_dtype
from vorotool.engines.volumes.slabs import Quantity, SeedSlab, SeedSlabs, with_neighbors
from vorotool.engines.volumes.verify_volume import verify_label_volume
from vorotool.engines.volumes.volume_frames import slab_limits
from vorotool.engines.volumes.volume_measures import volume_diagram
from vorotool.engines.volumes.volume_regions import VolumeRegions, regions_of_sweep
from vorotool.engines.volumes.volume_tables import neighbors_of_regions, table_of_regions
from vorotool.engines.volumes.volume_tessellator import VolumeSweep
from vorotool.errors import LimitError
from vorotool.jobs.checked_columns import check_columns
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.options import Options
from vorotool.jobs.picture_world import world_of
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.jobs.units import PixelSize, unit_columns
from vorotool.jobs.volumes.inputs import ReadVolume, read_volume_seeds
from vorotool.jobs.volumes.output import VolumeStream, check_volume_chunks, write_volume_file, write_volume_store
from vorotool.jobs.volumes.pictures import SlicePicture, write_slices
from vorotool.numeric.length_units import unit_name
from vorotool.numeric.progress import Progress
from vorotool.products.registry import VOLUME_PRODUCTS
from vorotool.products.writing import write_product
from vorotool.types.table import Table
from vorotool.types.volumes.label_volume import LabelVolume

if TYPE_CHECKING:
    from vorotool.render.canvas.styles import PictureStyle

_TABLES = ("table", "neighbors")


def products(run: Run, o: Options, given: JobInput) -> VolumeProducts:
    """Read points or a volume, and prepare what labels any slices."""
    with run.phase("read"):
        o, read = read_volume_seeds(run, o, given)
    if len(read.seeds) > o.max_sites:
        raise LimitError(f"there are {len(read.seeds)} seeds, more than --max-sites {o.max_sites}")
    with run.phase("prepare"):
        sweep = VolumeSweep(
            read.seeds,
            read.frame,
            sides=read.sides,
            max_distance=o.max_distance,
            threads=o.threads,
            strict=o.strict,
            progress=run.progress("tessellate"),
        )
        if {"distance", "distance2"} & set(o.what):
            sweep.check_distances()
    return VolumeProducts(run, o, read, sweep, has_page=given.has_page)


class VolumeProducts:
    """Results of one tessellation."""

    def __init__(
        self, run: Run, options: Options, read: ReadVolume, sweep: VolumeSweep, *, has_page: bool = False
    ) -> None:
        self.run, self.options, self.read, self.sweep = run, options, read, sweep
        self._is_held = has_page or "color" in options.what
        self._with_distances = (has_page or "table" in options.what) and len(read.seeds) > 0
        check_columns(options, read.seeds.properties)
        self.dtype = label_dtype(read.seeds.largest_label, options.dtype)

    @cached_property
    def volume(self) -> LabelVolume:
        """The whole label volume, in memory."""
        self._require_memory()
        read, sweep = self.read, self.sweep
        return LabelVolume(self._labels(0, sweep.frame.depth), sweep.frame, read.seeds, read.sides, read.grid)

    def _require_memory(self) -> None:
        frame, most = self.sweep.frame, self.options.max_pixels
        if frame.voxels > most:
            size = f"{frame.width} x {frame.height} x {frame.depth} = {frame.voxels}"
            raise LimitError(f"the volume has {size} voxels, more than --max-pixels {most}")

    def _labels(self, first: int, slices: int) -> NDArray[Any]:
        with self.run.phase("tessellate"):
            return self.sweep.labels(first, slices, dtype=self.dtype)

    def _slabs(self) -> Iterator[tuple[int, NDArray[Any]]]:
        """The first slice of each slab, and its labels: of the volume where it is held."""
        for first, slices in slab_limits(self.sweep.frame, len(self.sweep.seeds)):
            if self._is_held:
                yield first, self.volume.labels[first : first + slices]
            else:
                yield first, self._labels(first, slices)

    @cached_property
    def regions(self) -> VolumeRegions:
        """Volumes, faces and boxes of the regions: one pass that tables and colors share."""
        return regions_of_sweep(self.sweep, self._slabs(), distances=self._with_distances, threads=self.options.threads)

    @cached_property
    def colors(self) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """Labels, and the color class of each."""
        return region_colors(self.volume, measures=self.regions.measures)

    @cached_property
    def _views(self) -> SlicePicture:
        return SlicePicture(self.sweep.frame, self.read.sides.units, self.options.slice)

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, before anything is."""
        from vorotool.render.pages.volume_html import check_volume_page

        what, fmt = target.what, target.fmt
        if fmt == "html":
            check_volume_page(self.sweep.frame.shape)
        elif what == "color":
            self._views.check(self.options.max_pixels)
        if what == "distance2" or self._with_distances:
            _ = self.sweep.square_dtype
        if what == "color" or fmt == "html":
            self._require_memory()
        elif fmt == "zarr":
            stream = self._stream(what)
            check_volume_chunks(self.options, stream.frame, stream.dtype)
        elif self.sweep.frame.width * self.sweep.frame.height > self.options.max_pixels:
            size = f"{self.sweep.frame.width} x {self.sweep.frame.height}"
            raise LimitError(f"a slice has {size} voxels, more than --max-pixels {self.options.max_pixels}")

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        from vorotool.formats.io.atomic_output import open_output

        what, o = target.what, self.options
        if what == "distance2" and self.sweep.step != 1:
            self.run.note(f"squared distances are in units of {self._unit_of_squares}")
        if target.fmt == "zarr":
            write_volume_store(self.run, o, target, self._stream(what), inputs)
            return
        with open_output(target.path, binary=target.is_binary, no_clobber=o.no_clobber, inputs=inputs) as out:
            if target.fmt == "html":
                self._write_page(out)
            elif what == "color":
                self._write_picture(out, target.fmt)
            elif what in _TABLES:
                table = self._table if what == "table" else self._neighbors()
                write_product(
                    out,
                    table,
                    VOLUME_PRODUCTS[what],
                    target.fmt,
                    precision=o.precision,
                    threads=o.threads,
                    path=target.path,
                )
            else:
                write_volume_file(out, o, target, self._stream(what))

    @property
    def _unit_of_squares(self) -> str:
        """What squared distances are counted in, exactly: ``(1/40 µm)²``."""
        size, step = self.options.pixel_size, self.sweep.step
        unit = "voxel" if size is None else size.unit
        return f"{step}²" if unit is None else f"({step} {unit_name(unit)})²"

    # ---- what is streamed
    def _stream(self, what: str) -> VolumeStream:
        """Labels, the diagram or distances, which need not be in memory."""
        sweep = self.sweep
        made: dict[str, tuple[Callable[[int, int], NDArray[Any]], Any]] = {
            "labels": (self._labels, self.dtype),
            "diagram": (self._diagram, np.uint8),
            "distance": (sweep.distances, np.float32),
            "distance2": (sweep.squared_distances, None),
        }
        slices_of, dtype = made[what]
        is_cut = what == "labels" and self.options.max_distance is not None
        return VolumeStream(
            sweep.frame,
            slices_of,
            sweep.square_dtype if dtype is None else np.dtype(dtype),
            lambda first, slices: self._slab(what, first, slices),  # type: ignore[arg-type]  # it is one of these
            list(slab_limits(sweep.frame, len(sweep.seeds))),
            self.read.grid,
            0 if is_cut else None,
        )

    def _diagram(self, first: int, slices: int) -> NDArray[Any]:
        begin, count = with_neighbors(self.sweep.frame, first, slices)
        lines = volume_diagram(self._labels(begin, count), threads=self.options.threads)
        return lines[first - begin : first - begin + slices]

    def _slab(self, what: Quantity, first: int, slices: int) -> SeedSlab:
        """Give some slices as what computes them anywhere."""
        read, frame = self.read, self.sweep.frame
        own = with_neighbors(frame, first, slices) if what == "diagram" else (first, slices)
        seeds, dtype = self._seed_slabs.seeds_of(*own), self._stream(what).dtype
        return SeedSlab(seeds, frame, first, slices, what, dtype, read.sides, self.options.max_distance)

    @cached_property
    def _seed_slabs(self) -> SeedSlabs:
        return SeedSlabs(self.read.seeds, self.sweep.frame)

    # ---- what is made of the whole
    @cached_property
    def _table(self) -> Table:
        return table_of_regions(self.regions, threads=self.options.threads)

    def _neighbors(self) -> Table:
        from vorotool.types.identity import ends_of_regions

        return ends_of_regions(neighbors_of_regions(self.regions), self.read.seeds)

    def _write_page(self, out: BinaryIO) -> None:
        from vorotool.render.pages.volume_html import write_volume_html

        table, labels = self._table, self.colors[0]
        rows = {int(label): row for row, label in enumerate(table["label"])}
        chosen = [rows[int(label)] for label in labels]
        columns = {name: [table[name][row] for row in chosen] for name in table if name != "label"}
        columns |= unit_columns(self._size, len(labels))
        first, units = self.sweep.frame.z, self.read.sides.units
        write_volume_html(out, self.volume.labels, self.colors, columns, first=first, units=units)

    @property
    def _size(self) -> PixelSize | None:
        """The side of a pixel of pictures, which is the shortest of a voxel."""
        size = self.options.pixel_size
        return None if size is None else PixelSize(min(self.read.sides.lengths), size.unit)

    def _write_picture(self, out: BinaryIO, fmt: str) -> None:
        from vorotool.jobs.label_pictures import site_texts

        o, seeds = self.options, self.read.seeds
        write_slices(
            out,
            self.volume,
            self._views,
            self.colors,
            fmt=fmt,
            layers=o.drawn(VOLUME_PRODUCTS["color"].usual_layers),
            style=self._style,
            width=o.width or 1000,
            texts=None if o.label_by is None else site_texts(seeds, o.label_by),
            threads=o.threads,
        )

    @property
    def _style(self) -> PictureStyle:
        from vorotool.types.pixel_frame import Frame

        height, width = self._views.shape
        looks = self.options.looks
        return looks.style(world_of(self.run, looks, frame=Frame(0, 0, width, height).box, size=self._size).scale_bar)

    def verify(self, progress: Progress) -> None:
        """Check the labels of every slab against an independent nearest-seed search."""
        sweep, read, frame = self.sweep, self.read, self.sweep.frame
        for first, slices in slab_limits(frame, len(sweep.seeds)):
            verify_label_volume(
                sweep.labels(first, slices),
                read.seeds,
                replace(frame, z=frame.z + first, depth=slices),
                sides=read.sides,
                max_distance2=sweep.most_squared,
                threads=self.options.threads,
            )
            if progress is not None:
                progress((first + slices) / frame.depth)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        sweep, seeds, frame = self.sweep, self.read.seeds, self.sweep.frame
        return {
            "seeds": len(seeds),
            "labels": len(seeds.site_labels) if seeds.site_labels is not None else 0,
            "largest_label": seeds.largest_label,
            "duplicates": sweep.duplicates,
            "snapped": seeds.snapped,
            "largest_move": seeds.largest_move,
            "steps_per_voxel": seeds.scale,
            "frame": [frame.x, frame.y, frame.z, frame.width, frame.height, frame.depth],
            "voxels": frame.voxels,
            "unit_of_distance2": self._unit_of_squares,
            "method": "exact",
            "threads": self.options.threads,
            "arithmetic": sweep.arithmetic,
        }
