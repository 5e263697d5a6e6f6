"""Tessellations of volumes: stacks, read slab by slab, or points of space; and what can be written of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.engines.tessellation.cleaned_masks import Cleaning
from vorotool.engines.tessellation.frames import require_memory
from vorotool.engines.tessellation.volume_seeding import (
    SLAB_VOXELS,
    objects_of_volume,
    seeds_from_xyz,
)
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.formats.io.descriptors import STANDARD, stream_kind
from vorotool.formats.io.sources import NPY, reading
from vorotool.formats.volumes.opening import kind_of_head, open_volume
from vorotool.formats.volumes.source import VolumeSource
from vorotool.formats.zarr.store import is_folder
from vorotool.jobs.inputs import JobInput, frame_of, read_voxel_points, report_no_seeds
from vorotool.jobs.options import OF_FRAMES, Options, changed
from vorotool.jobs.outlined_images import report_cleaning
from vorotool.jobs.picture_world import world_of
from vorotool.jobs.pixel_sizes import lengths_of_voxels, spacing_of
from vorotool.jobs.refusals import check_voxel_size, refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.streams import Tessellated, check_chunks, tessellated_rows
from vorotool.jobs.targets import Target
from vorotool.jobs.units import PixelSize, shows_units, sides_of, unit_columns, unit_stats
from vorotool.numeric.length_units import unit_name
from vorotool.products.inputs import VOLUME_NAMES
from vorotool.render.label_images.slices import SlicePicture
from vorotool.types.pixels import Frame, PixelSides
from vorotool.types.volumes.volume import VolumeSeeds, VoxelGrid

if TYPE_CHECKING:
    from vorotool.render.drawing import World
    from vorotool.render.label_images.picture import LabelPicture

_OF_VOLUMES = ("seeds", "connectivity", "threshold", "invert", "min_area", "fill_holes")
"""Options that images and volumes have, and points have not."""


class VolumeProducts(Tessellated):
    """Results of one tessellation."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        with run.phase("read"):
            options, seeds = read_volume_seeds(run, options, given)
        with run.phase("prepare"):
            sweep = tessellated_rows(run, options, seeds)
        sides, grid = sides_of(options, 3), _written_grid(options.pixel_size, sides_of(options, 3), seeds.grid)
        super().__init__(run, options, given, sweep, sides, grid)
        self.is_held = given.has_page or "color" in options.what

    @cached_property
    def _views(self) -> SlicePicture:
        return SlicePicture(self.frame, self.sides.units, self.options.slice)

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, before anything is."""
        from vorotool.render.pages.html import check_volume_page

        what, fmt = target.what, target.fmt
        if fmt == "html":
            check_volume_page(self.frame.shape)
        elif what == "color":
            self._views.check(self.options.max_pixels)
        if what == "distance2" or (self.with_distances and len(self.seeds)):
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

    def write_page(self, out: BinaryIO) -> None:
        """Write a page that shows all slices."""
        from vorotool.render.pages.html import columns_of, write_volume_html

        columns = columns_of(self._table, self.colors[0]) | unit_columns(self._size, len(self.colors[0]))
        first, units = self.frame.z, self.sides.units
        write_volume_html(out, self.whole.labels, self.colors, columns, first=first, units=units)

    @property
    def _size(self) -> PixelSize | None:
        """The side of a pixel of pictures, which is the shortest of a voxel."""
        size = self.options.pixel_size
        return None if size is None else PixelSize(min(self.sides.lengths), size.unit)

    def drawing(self, what: str, fmt: str) -> LabelPicture:
        """Prepare a picture of slices."""
        from vorotool.render.label_images.picture import label_picture

        image = self._views.image(self.whole)
        return label_picture(image, self.colors, self.products[what], self.wanted, sites=self.seeds)

    @cached_property
    def world(self) -> World:
        """Where the slices lie in a picture."""
        frame = Frame(0, 0, *reversed(self._views.shape))
        return world_of(self.run, self.options, frame=frame.box, size=self._size)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        more = {"unit_of_distance2": self._unit_of_squares, "arithmetic": self.sweep.arithmetic}
        return {**super().stats(), "voxels": self.frame.voxels, **more}


# ---- input
def read_volume_seeds(run: Run, o: Options, given: JobInput) -> tuple[Options, VolumeSeeds]:
    """Read a volume, or points of space; options with a unit are in that of the voxels then."""
    if not _is_volume(o, given.path):
        return _read_points(run, o, given)
    refuse(o, ("columns", *OF_FRAMES), "applies to lists of points, but the input is a volume with its own frame")
    with reading(given.path):
        source = open_volume(given.path, input_format=o.input_format)
        if source.note:
            run.note(source.note)
        check_voxel_size(run, o, given.name, source.grid)
        o = with_voxel_sides(run, lengths_of_voxels(o, source.grid), given, source.grid)
        threshold, invert = _foreground(run, o, source)
        how = {"mode": o.seeds, "connectivity": int(o.connectivity or 26), "threshold": threshold, "invert": invert}
        how |= {"cleaning": Cleaning.of(o.min_area, o.fill_holes), "slices": _slices_at_a_time(source)}
        how |= {"report": lambda mask: report_cleaning(run, o, mask.filled, (mask.removed, mask.objects), "voxels")}
        place, progress = "engines.tessellation.volume_seeding:seeds_of_slabs", run.progress("read")
        seeds: VolumeSeeds = run.call(o, place, source, phase=None, progress=progress, **how)
    return o, seeds


def _read_points(run: Run, o: Options, given: JobInput) -> tuple[Options, VolumeSeeds]:
    if o.pixel_size is not None and o.pixel_size.is_auto:
        raise UsageError(
            "--spacing auto needs a volume whose file states its voxel size: give numbers and their unit, such as "
            "0.325,0.325,1.5um"
        )
    o = lengths_of_voxels(o, None)
    refuse(o, _OF_VOLUMES, "applies to volumes, but the input is a list of points")
    run.stats |= unit_stats(o.pixel_size)
    with reading(given.path):
        points = read_voxel_points(run, o, given, properties="table" in o.what or o.names_columns or given.has_page)
        seeds = seeds_from_xyz(points, strict=o.strict, check=lambda seeds: frame_of(o, seeds))
    if not len(seeds):
        frame = frame_of(o, seeds)
        report_no_seeds(run, o, frame)
        seeds = replace(seeds, frame=frame)
    return o, seeds


def _is_volume(o: Options, path: str) -> bool:
    """Whether an input is a stack, not points: by what is said, else by how it begins, of streams by other options."""
    if o.input_format is not None:
        kind = VOLUME_NAMES.get(o.input_format.lower())
        return kind is not None and not (kind == "npy" and o.columns is not None)
    if is_folder(path):
        return True
    if path == STANDARD or stream_kind(path) is not None:
        return o.columns is None and o.size is None and o.window is None
    try:
        with Path(path).open("rb") as file:
            head = file.read(len(NPY))
    except (OSError, ValueError):
        return False  # who reads it says what is wrong
    kind = kind_of_head(head)
    return kind == "tiff" or (kind == "npy" and o.columns is None)


def _foreground(run: Run, o: Options, source: VolumeSource) -> tuple[float | None, bool]:
    """Give the threshold, which is in the statistics, and whether foreground is what is not above it."""
    threshold, invert = o.threshold, o.invert
    if threshold == "otsu":
        found = objects_of_volume(source, "otsu", invert=invert, slices=_slices_at_a_time(source))
        threshold, invert = found.threshold, found.invert
        run.note(f"threshold {threshold:.17g}, by Otsu's method")
    if threshold is not None:
        run.stats["threshold"] = threshold
    return threshold, invert


def _slices_at_a_time(source: VolumeSource) -> int:
    """Whole layers of the chunks of the file, which are decoded once."""
    _, height, width = source.shape
    layer = source.chunk_depth
    return layer * max(1, SLAB_VOXELS // (layer * height * width))


# ---- sides of voxels
def with_voxel_sides(run: Run, o: Options, given: JobInput, grid: VoxelGrid | None) -> Options:
    """Give options with the sides of voxels: as the user says, or what the file says where that is asked for."""
    asked = o.pixel_size
    if asked is None:
        if grid is not None and not grid.is_cube:
            run.note(
                f"{given.name} has voxels of {grid.size_text()}, which are not cubes: distances are in voxels; "
                "--spacing auto measures with these sides"
            )
        elif grid is not None and (o.scale_bar or shows_units(given.targets)):
            run.note(f"{given.name} states voxels of {grid.size_text()}: --spacing auto uses that")
        return o
    if asked.is_auto:
        asked = _of_file(grid)
        o = changed(o, pixel_size=asked)
    run.stats |= unit_stats(asked)
    return o


def _of_file(grid: VoxelGrid | None) -> PixelSize:
    instead = "give numbers and their unit, such as --spacing 0.325,0.325,1.5um"
    if grid is None:
        raise InputError(f"the volume states no voxel size: {instead}")
    return spacing_of(grid, grid.sides, "volume has voxels", instead)


def _written_grid(size: PixelSize | None, sides: PixelSides, grid: VoxelGrid | None) -> VoxelGrid | None:
    """What files say of the voxels: the spacing that is given, else what the input says."""
    if size is None:
        return grid
    depth, height, width = sides.lengths
    form = "imagej" if grid is None else grid.form
    return VoxelGrid(width, height, depth, size.unit, form)
