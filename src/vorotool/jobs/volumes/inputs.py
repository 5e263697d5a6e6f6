"""The input of a tessellation of a volume: a stack, read slab by slab, or points of space; and its voxels' sides."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from vorotool.convert.spacings import sides_of_voxels
from vorotool.engines.tessellation.cleaned_masks import Cleaning
from vorotool.engines.volumes.volume_frames import default_voxel_frame
from vorotool.engines.volumes.volume_objects import SLAB_VOXELS, VolumeObjects
from vorotool.engines.volumes.volume_seeding import seeds_from_xyz, seeds_of_slabs
from vorotool.errors import InputError, UsageError
from vorotool.formats.io.descriptors import STANDARD, stream_kind
from vorotool.formats.io.npy_arrays import MAGIC
from vorotool.formats.io.sources import reading
from vorotool.formats.volumes.opening import open_volume
from vorotool.formats.volumes.points import read_xyz
from vorotool.formats.volumes.source import VolumeSource
from vorotool.formats.zarr.store import is_folder
from vorotool.jobs.inputs import JobInput, report_no_seeds
from vorotool.jobs.masks import report_cleaning
from vorotool.jobs.options import Options, changed
from vorotool.jobs.pixel_sizes import lengths_of_voxels
from vorotool.jobs.refusals import check_voxel_size, refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.units import PixelSize, sides_of, unit_stats
from vorotool.plain import plain
from vorotool.products.inputs import VOLUME_NAMES
from vorotool.types.spacing import PixelSides
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame, VoxelGrid

_TIFF_HEADS = (b"II*\x00", b"MM\x00*", b"II+\x00", b"MM\x00+")


@plain
class ReadVolume:
    """Seeds, and what else an input says."""

    seeds: VolumeSeeds
    frame: VoxelFrame | None  # what is tessellated; None where there are no seeds
    sides: PixelSides  # of a voxel, in whose unit distances are
    grid: VoxelGrid | None  # sides of the voxels, for files that are written


def read_volume_seeds(run: Run, o: Options, given: JobInput) -> tuple[Options, ReadVolume]:
    """Read a volume, or points of space; options with a unit are in that of the voxels then."""
    if not _is_volume(o, given.path):
        return _read_points(run, o, given)
    refuse(
        {"columns": o.columns, **o.of_frame}, "applies to lists of points, but the input is a volume with its own frame"
    )
    with reading(given.path):
        source = open_volume(given.path, input_format=o.input_format)
        if source.note:
            run.note(source.note)
        check_voxel_size(run, o, given.name, source.grid)
        o = with_voxel_sides(run, lengths_of_voxels(o, source.grid), given, source.grid)
        threshold, invert = _foreground(run, o, source)
        seeds = seeds_of_slabs(
            source,
            mode=o.seeds,
            connectivity=int(o.connectivity or 26),
            threshold=threshold,
            invert=invert,
            cleaning=Cleaning.of(o.min_area, o.fill_holes),
            max_sites=o.max_sites,
            strict=o.strict,
            note=run.note,
            progress=run.progress("read"),
            slices=_slices_at_a_time(source),
            report=lambda mask: report_cleaning(run, o, mask.filled, (mask.removed, mask.objects), "voxels"),
        )
    sides = sides_of(o, 3)
    return o, ReadVolume(seeds, seeds.frame, sides, _written_grid(o.pixel_size, sides, source.grid))


def _read_points(run: Run, o: Options, given: JobInput) -> tuple[Options, ReadVolume]:
    if o.pixel_size is not None and o.pixel_size.is_auto:
        raise UsageError(
            "--spacing auto needs a volume whose file states its voxel size: give numbers and their unit, such as "
            "0.325,0.325,1.5um"
        )
    o = lengths_of_voxels(o, None)
    of_volumes = {key: value for key, value in o.for_images.items() if key in _OF_VOLUMES}
    refuse(of_volumes, "applies to volumes, but the input is a list of points")
    run.stats |= unit_stats(o.pixel_size)
    with reading(given.path):
        points = read_xyz(
            given.path,
            input_format=o.input_format,
            columns=o.columns,
            max_sites=o.max_sites,
            properties=("table" in o.what or o.names_columns or given.has_page) and not o.no_properties,
            note=run.note,
        )
        seeds = seeds_from_xyz(points, strict=o.strict, check=lambda seeds: _frame_of(o, seeds))
    sides, frame = sides_of(o, 3), _frame_of(o, seeds)
    if not len(seeds):
        report_no_seeds(run, o, frame)
        seeds = replace(seeds, frame=frame)
    return o, ReadVolume(seeds, frame, sides, _written_grid(o.pixel_size, sides, None))


_OF_VOLUMES = frozenset({"seeds", "connectivity", "threshold", "invert", "min-area", "fill-holes"})
"""Options that images and volumes have, and points have not."""


def _frame_of(o: Options, seeds: VolumeSeeds) -> VoxelFrame | None:
    if o.window is not None:
        return VoxelFrame(*o.window)
    if o.size is not None:
        return VoxelFrame(0, 0, 0, *o.size)
    if not len(seeds):
        return None
    return default_voxel_frame(seeds, how="give one with --size WxHxD or --window X,Y,Z,W,H,D")


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
            head = file.read(len(MAGIC))
    except (OSError, ValueError):
        return False  # who reads it says what is wrong
    return head.startswith(_TIFF_HEADS) or (head == MAGIC and o.columns is None)


def _foreground(run: Run, o: Options, source: VolumeSource) -> tuple[float | None, bool]:
    """Give the threshold, which is in the statistics, and whether foreground is what is not above it."""
    threshold, invert = o.threshold, o.invert
    if threshold == "otsu":
        found = VolumeObjects.of(source, "otsu", invert=invert, slices=_slices_at_a_time(source))
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
        elif grid is not None and given.has_units:
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
    sides = sides_of_voxels(grid)
    if sides is None:
        raise InputError(
            f"the volume has voxels of {grid.size_text()}, whose sides have no common step that is coarse enough for "
            f"exact distances: {instead}"
        )
    return PixelSize(Fraction(1), grid.unit, is_spacing=True, sides=sides)


def _written_grid(size: PixelSize | None, sides: PixelSides, grid: VoxelGrid | None) -> VoxelGrid | None:
    """What files say of the voxels: the spacing that is given, else what the input says."""
    if size is None:
        return grid
    depth, height, width = sides.lengths
    form = "imagej" if grid is None else grid.form
    return VoxelGrid(width, height, depth, size.unit, form)
