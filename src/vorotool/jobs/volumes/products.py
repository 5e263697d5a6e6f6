"""What the tessellation of a volume can be written as: each from slabs, or from the label volume held in memory."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.label_images.regions import region_colors
from vorotool.engines.tessellation.frames import require_memory
from vorotool.engines.volumes.slabs import SeedSlab, SeedSlabs, with_neighbors
from vorotool.engines.volumes.verify_volume import verify_label_volume
from vorotool.engines.volumes.volume_frames import slab_limits
from vorotool.engines.volumes.volume_measures import volume_diagram
from vorotool.engines.volumes.volume_regions import VolumeRegions, regions_of_sweep
from vorotool.engines.volumes.volume_tables import neighbors_of_regions, table_of_regions
from vorotool.engines.volumes.volume_tessellator import VolumeSweep
from vorotool.errors import LimitError
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.options import Options
from vorotool.jobs.picture_world import world_of
from vorotool.jobs.run_log import Run
from vorotool.jobs.streams import Limits, Tessellated, check_chunks
from vorotool.jobs.targets import Target
from vorotool.jobs.units import PixelSize, unit_columns
from vorotool.jobs.volumes.inputs import ReadVolume, read_volume_seeds
from vorotool.numeric.length_units import unit_name
from vorotool.numeric.parallel import Progress
from vorotool.products.registry import VOLUME_PRODUCTS, Product
from vorotool.render.label_images.slices import SlicePicture
from vorotool.types.table import Table
from vorotool.types.volumes.label_volume import LabelVolume

if TYPE_CHECKING:
    from vorotool.render.label_images.picture import LabelPicture
    from vorotool.render.looks import World


def products(run: Run, o: Options, given: JobInput) -> VolumeProducts:
    """Read points or a volume, and prepare what labels any slices."""
    with run.phase("read"):
        o, read = read_volume_seeds(run, o, given)
    if len(read.seeds) > o.max_sites:
        raise LimitError(f"the input has {len(read.seeds)} seeds, more than --max-sites {o.max_sites}")
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


class VolumeProducts(Tessellated):
    """Results of one tessellation."""

    def __init__(
        self, run: Run, options: Options, read: ReadVolume, sweep: VolumeSweep, *, has_page: bool = False
    ) -> None:
        super().__init__(run, options, sweep, read.grid)
        self.read = read
        self._is_held = has_page or "color" in options.what
        self._with_distances = (has_page or "table" in options.what) and len(read.seeds) > 0

    @cached_property
    def products(self) -> Mapping[str, Product]:
        """All results of volumes."""
        return VOLUME_PRODUCTS

    @cached_property
    def volume(self) -> LabelVolume:
        """The whole label volume, in memory."""
        require_memory(self.frame, self.options.max_pixels)
        return LabelVolume(self.labels(), self.frame, self.seeds, self.read.sides, self.grid)

    def _slabs(self) -> Iterator[tuple[int, NDArray[Any]]]:
        """The first slice of each slab, and its labels: of the volume where it is held."""
        for first, slices in slab_limits(self.frame, len(self.seeds)):
            if self._is_held:
                yield first, self.volume.labels[first : first + slices]
            else:
                yield first, self.labels(first, slices)

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
        return SlicePicture(self.frame, self.read.sides.units, self.options.slice)

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, before anything is."""
        from vorotool.render.pages.html import check_volume_page

        what, fmt = target.what, target.fmt
        if fmt == "html":
            check_volume_page(self.frame.shape)
        elif what == "color":
            self._views.check(self.options.max_pixels)
        if what == "distance2" or self._with_distances:
            _ = self.sweep.square_dtype
        if what == "color" or fmt == "html":
            require_memory(self.frame, self.options.max_pixels)
        elif fmt == "zarr":
            check_chunks(self.options, self.stream(what))
        elif self.frame.width * self.frame.height > self.options.max_pixels:
            size = f"{self.frame.width} x {self.frame.height}"
            raise LimitError(f"a slice has {size} voxels, more than --max-pixels {self.options.max_pixels}")

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        if target.what == "distance2" and self.sweep.step != 1:
            self.run.note(f"squared distances are in units of {self._unit_of_squares}")
        super().write(target, inputs=inputs)

    @property
    def _unit_of_squares(self) -> str:
        """What squared distances are counted in, exactly: ``(1/40 µm)²``."""
        size, step = self.options.pixel_size, self.sweep.step
        unit = "voxel" if size is None else size.unit
        return f"{step}²" if unit is None else f"({step} {unit_name(unit)})²"

    # ---- what is streamed
    def limits(self) -> Limits:
        """Give slabs of slices."""
        return list(slab_limits(self.frame, len(self.seeds)))

    def diagram_of(self, labels: NDArray[Any]) -> NDArray[Any]:
        """Mark voxels beside others of other labels."""
        return volume_diagram(labels, threads=self.options.threads)

    def band(self, what: Any, dtype: np.dtype[Any], first: int, count: int) -> SeedSlab:
        """Give some slices as what computes them anywhere."""
        own = with_neighbors(self.frame, first, count) if what == "diagram" else (first, count)
        seeds, o = self._seed_slabs.seeds_of(*own), self.options
        return SeedSlab(seeds, self.frame, first, count, what, dtype, self.read.sides, o.max_distance)

    @cached_property
    def _seed_slabs(self) -> SeedSlabs:
        return SeedSlabs(self.seeds, self.frame)

    # ---- what is made of the whole
    @cached_property
    def _table(self) -> Table:
        return table_of_regions(self.regions, threads=self.options.threads)

    def written(self, what: str, fmt: str) -> Table:
        """Give a table, whose lengths are in the unit of distances."""
        from vorotool.types.identity import ends_of_regions

        return self._table if what == "table" else ends_of_regions(neighbors_of_regions(self.regions), self.seeds)

    def write_page(self, out: BinaryIO) -> None:
        """Write a page that shows all slices."""
        from vorotool.render.pages.html import columns_of, write_volume_html

        columns = columns_of(self._table, self.colors[0]) | unit_columns(self._size, len(self.colors[0]))
        first, units = self.frame.z, self.read.sides.units
        write_volume_html(out, self.volume.labels, self.colors, columns, first=first, units=units)

    @property
    def _size(self) -> PixelSize | None:
        """The side of a pixel of pictures, which is the shortest of a voxel."""
        size = self.options.pixel_size
        return None if size is None else PixelSize(min(self.read.sides.lengths), size.unit)

    def drawing(self, what: str, fmt: str) -> LabelPicture:
        """Prepare a picture of slices."""
        from vorotool.render.label_images.picture import label_picture

        image = self._views.image(self.volume)
        return label_picture(image, self.colors, self.products[what], self.wanted, sites=self.seeds)

    @cached_property
    def world(self) -> World:
        """Where the slices lie in a picture."""
        from vorotool.types.pixel_frame import Frame

        height, width = self._views.shape
        return world_of(self.run, self.options, frame=Frame(0, 0, width, height).box, size=self._size)

    def verify(self, progress: Progress) -> None:
        """Check the labels of every slab against an independent nearest-seed search."""
        sweep, read, frame = self.sweep, self.read, self.frame
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
        frame = self.frame
        return {
            **super().stats(),
            "steps_per_voxel": self.seeds.scale,
            "frame": [frame.x, frame.y, frame.z, frame.width, frame.height, frame.depth],
            "voxels": frame.voxels,
            "unit_of_distance2": self._unit_of_squares,
            "method": "exact",
            "threads": self.options.threads,
            "arithmetic": self.sweep.arithmetic,
        }
