"""Seeds of volumes: from points of space, masks and label volumes, which are read slab by slab."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.volumes import as_volume, as_volume_points
from vorotool.engines.tessellation.cleaned_masks import Cleaning
from vorotool.engines.tessellation.label_sums import numbered, parts, sums
from vorotool.engines.tessellation.raster_objects import Note, report_no_foreground
from vorotool.engines.tessellation.seed_lattice import report_snapped, sites_of_points, snapped_places
from vorotool.engines.tessellation.seeding import SeedMode
from vorotool.engines.volumes.cleaned_slices import CleanedSlices
from vorotool.engines.volumes.inner_voxels import inner_runs
from vorotool.engines.volumes.outer_seeds import OuterSeeds
from vorotool.engines.volumes.volume_objects import HeldSlices, SlicesSource, VolumeObjects
from vorotool.errors import LimitError, UsageError, option
from vorotool.numeric.checks import is_choice
from vorotool.numeric.numbers import shown_number, whole_number
from vorotool.numeric.parallel import Progress
from vorotool.types.volumes.volume_points import VolumePoints
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame

if TYPE_CHECKING:
    from vorotool.typing import RealLike, VolumeLike, VolumePointsLike

Check = Callable[[VolumeSeeds], object] | None
"""Raises an error for seeds that cannot be used: called before notes about them."""

MOST_SEEDS = 2**31 - 1
"""Seeds that a sweep takes: they are numbered in 31 bits."""

NO_CLEANING = Cleaning()

_CONNECTIVITY = (26, 6)


def seeds_from_xyz(
    points: VolumePointsLike, *, strict: bool = False, check: Check = None, name: str = "points"
) -> VolumeSeeds:
    """Convert points in space to seeds on a lattice.

    Parameters
    ----------
    points : VolumePoints, (n, 3) array, data frame with x, y and z, …
        Coordinates x, y and z in voxels. Multiples of 1/256 are kept exactly; finer ones move to the nearest multiple.
    strict : bool
        Refuse points that would have to move.
    check : callable, optional
        Called with the seeds before the snapping warning; may raise an error instead.
    name : str
        Name of the parameter, for messages.

    Returns
    -------
    VolumeSeeds
        One seed a point, on the coarsest lattice that holds all of them; 28 bytes a seed, and 24 for its site.

    Raises
    ------
    InputError
        If a coordinate is beyond 2^44, or ``strict`` and a point is finer than 1/256 voxel.

    Warns
    -----
    VorotoolWarning
        If points were moved: how many, and the largest move.

    Examples
    --------
    >>> seeds = seeds_from_xyz([[0.5, 2, 0], [7, 5, 3]])
    >>> seeds.scale, seeds.places.tolist()
    (2, [[1, 4, 0], [14, 10, 6]])
    """
    points = as_volume_points(points, name)
    snapped = snapped_places(points.xyz)
    labels = points.label_array.astype(np.uint32)
    seeds = VolumeSeeds(
        snapped.steps,
        labels,
        scale=snapped.scale,
        snapped=snapped.moves,
        largest_move=snapped.largest_move,
        **sites_of_points(snapped.steps / snapped.scale, labels, points, strict=strict),
    )
    if check is not None:
        check(seeds)
    report_snapped(points.xyz, snapped, strict=strict)
    return seeds


def seeds_from_volume(
    volume: VolumeLike,
    *,
    mode: SeedMode | None = None,
    connectivity: int = 26,
    threshold: float | Literal["otsu"] | None = None,
    invert: bool = False,
    min_area: RealLike | None = None,
    fill_holes: bool | RealLike = False,
    strict: bool = False,
    max_sites: int = MOST_SEEDS,
    note: Note = None,
) -> VolumeSeeds:
    """Extract seeds from a volume.

    Parameters
    ----------
    volume : Volume, LabelVolume, or (D, H, W) array of any library
        Nonzero voxels are foreground.
    mode : {"pixels", "components", "labels", "centroids"}, optional
        What shares a label: nothing, a connected component, or all voxels of one value; or one seed at the centroid of
        each component or label. By default components of a mask, whose only value besides 0 is 1, 255, the largest of
        its type, or True; else labels.
    connectivity : {26, 6}
        Neighborhood of components: by corners, too, or by faces.
    threshold : float or "otsu", optional
        Voxels above the threshold are foreground.
    invert : bool
        Exchange foreground and background.
    min_area : number, optional
        Leave out objects of a mask with fewer voxels, their filled holes included.
    fill_holes : bool or number
        Whether to fill the holes of the objects of a mask first; a number fills those of at most so many voxels.
    strict : bool
        Refuse a volume without foreground, and centroids that would have to move to the lattice of 1/256 voxel.
    max_sites : int
        More seeds are refused.
    note : callable, optional
        Called with a text if an image was taken for a mask or for labels and that may surprise.

    Returns
    -------
    VolumeSeeds
        Seeds with the volume's frame. Voxels and components are numbered by raster order of their first voxel. Of
        components and labels the outer voxels are seeds, 29 bytes each: those that have not their own object on all six
        sides. Labels, distances and ties are those of all voxels.

    Raises
    ------
    InputError
        If the volume looks like gray values and no threshold is given, or holds labels where a mask is to be cleaned;
        or there is no foreground, and `strict`.
    LimitError
        If there are more seeds than `max_sites`.
    UsageError
        If options contradict each other.

    Warns
    -----
    VorotoolWarning
        If there is no foreground, hence no seed.

    Examples
    --------
    >>> seeds_from_volume(np.array([[[1, 0, 1]], [[0, 0, 1]]])).labels.tolist()
    [1, 2, 2]
    """
    return seeds_of_slabs(
        HeldSlices(as_volume(volume, "volume", is_gray=True)),
        mode=mode,
        connectivity=connectivity,
        threshold=threshold,
        invert=invert,
        cleaning=Cleaning.of(min_area, fill_holes),
        max_sites=max_sites,
        strict=strict,
        note=note,
    )


def seeds_of_slabs(
    source: SlicesSource,
    *,
    mode: SeedMode | None = None,
    connectivity: int = 26,
    threshold: float | Literal["otsu"] | None = None,
    invert: bool = False,
    cleaning: Cleaning = NO_CLEANING,
    max_sites: int = MOST_SEEDS,
    strict: bool = False,
    note: Note = None,
    progress: Progress = None,
    slices: int | None = None,
    report: Callable[[CleanedSlices], None] | None = None,
) -> VolumeSeeds:
    """Take seeds from a volume that is read slab by slab, and never held; the rest is as of `seeds_from_volume`."""
    if not is_choice(connectivity, _CONNECTIVITY):
        of_images = "; 8 and 4 apply to images" if is_choice(connectivity, (8, 4)) else ""
        raise UsageError(f"connectivity is {shown_number(connectivity)}: it must be 26 or 6 in a volume{of_images}")
    if not is_choice(mode, (None, *get_args(SeedMode))):
        raise UsageError(f"mode is {mode!r}: it must be one of {', '.join(get_args(SeedMode))}")
    depth, height, width = source.shape
    frame = VoxelFrame(0, 0, 0, width, height, depth)
    objects = VolumeObjects.of(source, threshold, invert=invert, slices=slices)
    kind = objects.kind(note=note) if mode in (None, "centroids") else mode
    if cleaning:
        cleaning.require_mask(str(kind), "volume")
        mask = CleanedSlices(objects, cleaning, connectivity)
        objects = replace(objects, source=mask, threshold=None, invert=False)
        if report is not None:
            report(mask)
    most = min(whole_number(max_sites, "max_sites"), MOST_SEEDS)
    is_alone = mode == "centroids"
    outer = OuterSeeds(objects, kind, connectivity, None if is_alone else most)
    made = outer.read(frame, progress)
    if not len(made):
        report_no_foreground(strict=strict, what="volume")
        volume = None if kind == "pixels" else np.empty(0, np.int64)
        return replace(made, object_volume=volume, grid=source.grid)
    if kind == "pixels":
        return replace(made, sites=made.places.astype(np.float64), site_labels=made.labels, grid=source.grid)
    known = {"frame": frame, "grid": source.grid, **_measured(made)}
    if not is_alone:
        return replace(made, **known)
    if len(known["sites"]) > most:
        raise LimitError(f"the volume has {len(known['sites'])} objects, more than {option(f'--max-sites {most}')}")
    seeds = seeds_from_xyz(VolumePoints(known["sites"], known["site_labels"].astype(np.int64)), strict=strict)
    return replace(seeds, properties={}, index=None, **known)


def _measured(seeds: VolumeSeeds) -> dict[str, Any]:
    """Centroids and volumes of objects, of their outer voxels and the runs of inner ones that follow these."""
    lengths: NDArray[np.int64] = np.ones(len(seeds), np.int64)
    for part in parts(len(seeds) if seeds.filled is not None else 0, 1 << 22):
        seed, start, end = inner_runs(seeds, part)
        lengths[seed] += end - start
    distinct, index = numbered(seeds.labels)
    volume = sums(index, len(distinct), lengths)
    # Sums of coordinates stay below 2^53, so the centroid is the rounded quotient of two exact integers.
    twice = seeds.x * 2
    twice += lengths
    twice -= 1
    twice *= lengths  # the sum of the columns of a seed and its run, twice
    total = [sums(index, len(distinct), twice) / 2]
    total += [sums(index, len(distinct), values * lengths) for values in (seeds.y, seeds.z)]
    return {
        "sites": np.stack([each / volume for each in total], axis=1),
        "site_labels": distinct.astype(np.uint32),
        "object_volume": volume.astype(np.int64),
    }
