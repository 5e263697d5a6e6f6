"""Seeds of volumes: from points of space, masks and label volumes, which are read slab by slab."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.volumes import as_volume, as_volume_points, is_volume
from vorotool.engines.tessellation.cleaned_masks import CleanedSlices, Cleaning
from vorotool.engines.tessellation.raster_objects import (
    Note,
    PartwiseObjects,
    check_objects,
    report_no_foreground,
)
from vorotool.engines.tessellation.seeding import (
    SeedMode,
    moved_to,
    numbered,
    parts,
    report_snapped,
    sites_of_points,
    snapped_places,
    sums,
)
from vorotool.engines.tessellation.tessellator import inner_runs, surrounded
from vorotool.errors import LimitError, option
from vorotool.numeric.checks import MAX_PIXELS
from vorotool.numeric.numbers import finite_double, whole_number
from vorotool.numeric.parallel import Progress
from vorotool.types.points.point_set import VolumePoints
from vorotool.types.volumes.volume import LabelVolume, Volume, VolumeSeeds, VoxelFrame

if TYPE_CHECKING:
    from vorotool.typing import RealLike, VolumeLike, VolumePointsLike

Check = Callable[[VolumeSeeds], object] | None
"""Raises an error for seeds that cannot be used: called before notes about them."""

MOST_SEEDS = 2**31 - 1
"""Seeds that a sweep takes: they are numbered in 31 bits."""

NO_CLEANING = Cleaning()

SLAB_VOXELS = 2**23
"""Voxels that are read at a time, or one slice: each takes up to some 16 bytes while its slab is looked at."""

CHUNK = 1 << 22
"""Seeds that are placed at a time."""

_CENTROIDS = option("--seeds centroids", 'mode="centroids"')


def as_volume_seeds(
    source: Any, name: str = "seeds", *, max_pixels: int = MAX_PIXELS, check: Check = None
) -> VolumeSeeds:
    """Give seeds from whatever `tessellate` accepts in three dimensions."""
    if isinstance(source, VolumeSeeds):
        seeds = source
    elif isinstance(source, LabelVolume):
        seeds = moved_to(seeds_from_volume(source, mode="labels"), source.frame)
    elif isinstance(source, Volume) or is_volume(source) or len(getattr(source, "shape", ())) == 3:
        seeds = seeds_from_volume(as_volume(source, name, max_pixels=max_pixels))  # the last axis is not that of colors
    else:
        return seeds_from_xyz(source, check=check, name=name)
    if check is not None:
        check(seeds)
    return seeds


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
        as_volume(volume, "volume", is_gray=True),
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
    source: Any,
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
    check_objects(mode, get_args(SeedMode), connectivity, axes=3)
    depth, height, width = source.shape
    frame = VoxelFrame(0, 0, 0, width, height, depth)
    objects = objects_of_volume(source, threshold, invert=invert, slices=slices)
    kind = objects.kind(note=note) if mode in (None, "centroids") else mode
    objects = replace(objects, mode=kind, connectivity=connectivity)
    if cleaning:
        cleaning.require_mask(str(kind), "volume")
        mask = CleanedSlices(objects, cleaning)
        objects = replace(objects, source=mask, threshold=None, invert=False)
        if report is not None:
            report(mask)
    most = min(whole_number(max_sites, "max_sites"), MOST_SEEDS)
    is_alone = mode == "centroids"
    made = OuterSeeds(objects, None if is_alone else most).read(frame, progress)
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


def objects_of_volume(
    source: Any, threshold: float | Literal["otsu"] | None, *, invert: bool = False, slices: int | None = None
) -> PartwiseObjects:
    """Settle the threshold, for which ``otsu`` reads the volume, and how many slices are read at a time."""
    _, height, width = source.shape
    made = PartwiseObjects(source, invert=invert, step=slices or max(1, SLAB_VOXELS // (height * width)))
    if threshold is None:
        return made
    if isinstance(threshold, str) and threshold == "otsu":
        return made.with_otsu()
    finite_double(threshold, "threshold")
    return replace(made, threshold=threshold)


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


class OuterSeeds:
    """The seeds of a volume: all foreground voxels where each has its own label, else the outer ones of objects."""

    def __init__(self, objects: PartwiseObjects, most: int | None = None) -> None:
        self._objects, self._kind, self._most = objects, objects.mode, most
        _, height, width = objects.source.shape
        self._plane = height * width
        self._components = (
            _core.volumes.VolumeComponents(width, height, objects.corners) if self._kind == "components" else None
        )
        self._waiting = np.empty((0, height, width), np.uint32)  # the last two slices that were read
        self._read = self._done = 0  # slices that were read, and whose seeds are known
        self._places: list[NDArray[np.int64]] = []
        self._labels: list[NDArray[np.uint32]] = []
        self._filled: list[NDArray[np.bool_]] = []
        self._count = 0

    def read(self, frame: VoxelFrame, progress: Progress = None) -> VolumeSeeds:
        """Read the volume, and give its seeds, without sites."""
        depth = frame.depth
        for first, count in self._objects.limits():
            if self._kind == "pixels":
                self._keep(first, np.flatnonzero(self._objects.values(first, count)), None, None)
            else:
                self._add(self._fields(first, count), is_last=first + count == depth)
            if progress is not None:
                progress((first + count) / depth)
        return self._seeds(frame)

    def _fields(self, first: int, count: int) -> NDArray[Any]:
        """Labels of some slices, or provisional numbers of components."""
        if self._components is None:
            return self._objects.labels(first, count)
        mask = self._objects.mask(first, count)
        numbers = np.empty(mask.shape, np.uint32)
        self._components.add(mask, numbers, None)
        return numbers

    def _add(self, slab: NDArray[Any], *, is_last: bool) -> None:
        block = np.concatenate([self._waiting, slab]) if len(self._waiting) else slab
        begin = self._done - (self._read - len(self._waiting))  # slices of the block that are only there as neighbors
        self._read += len(slab)
        end = len(block) if is_last else len(block) - 1
        self._waiting = block[-2:].copy()
        # Provisional numbers differ within a component, whose voxels side by side are of one: the mask tells.
        is_outer = ~surrounded(block != 0 if self._components is not None else block)[begin:end]
        chosen = block[begin:end]
        is_outer &= chosen != 0
        places = np.flatnonzero(is_outer)
        is_inner = np.logical_and(chosen != 0, ~is_outer).reshape(-1)
        after = np.minimum(places + 1, max(is_inner.size - 1, 0))  # the last voxel of a row is outer
        self._keep(self._done, places, chosen.reshape(-1)[places].astype(np.uint32), is_inner[after])
        self._done += end - begin

    def _keep(
        self,
        first: int,
        places: NDArray[np.intp],
        labels: NDArray[np.uint32] | None,
        filled: NDArray[np.bool_] | None,
    ) -> None:
        self._count += len(places)
        if self._most is not None and self._count > self._most:
            what = "foreground voxels" if labels is None else "outer voxels of objects"
            raise LimitError(
                f"the volume has at least {self._count} {what}, more than {option(f'--max-sites {self._most}')}: use "
                f"{_CENTROIDS}, or a larger limit"
            )
        places += first * self._plane
        self._places.append(places)
        if labels is not None and filled is not None:
            self._labels.append(labels)
            self._filled.append(filled)

    def _seeds(self, frame: VoxelFrame) -> VolumeSeeds:
        """Put what was kept together; each list goes as soon as it is used."""
        labels = self._numbers()
        places = np.empty((self._count, 3), np.int64, order="F")
        start = 0
        self._places.reverse()
        while self._places:
            flat = self._places.pop()
            for part in parts(len(flat), CHUNK):
                rows, x = np.divmod(flat[part], frame.width)
                z, y = np.divmod(rows, frame.height)
                for axis, values in enumerate((x, y, z)):
                    places[start : start + len(x), axis] = values
                start += len(x)
        filled = np.concatenate(self._filled) if self._filled else np.zeros(0, bool)
        return VolumeSeeds(
            places,
            labels,
            frame=frame,
            sites=np.empty((0, 3)),
            site_labels=np.empty(0, np.uint32),
            filled=filled if filled.any() else None,
        )

    def _numbers(self) -> NDArray[np.uint32]:
        if self._kind == "pixels":
            return np.arange(1, self._count + 1, dtype=np.uint32)
        labels = np.concatenate(self._labels) if self._labels else np.empty(0, np.uint32)
        self._labels.clear()
        if self._components is None:
            return labels
        number = np.empty(self._components.size + 1, np.uint32)
        self._components.settle(number)
        return number[labels]
