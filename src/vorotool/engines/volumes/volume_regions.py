"""Regions of a tessellation of a volume with their sites: what tables are made of, of voxels that pass by in slabs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import label_array, largest_by_label, rows_of
from vorotool.engines.volumes.volume_measures import VolumeMeasures, measure_slabs
from vorotool.engines.volumes.volume_tessellator import VolumeSweep
from vorotool.plain import plain
from vorotool.types.spacing import PixelSides
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame


@plain(eq=False)
class VolumeRegions:
    """Measures of regions, and their sites."""

    measures: VolumeMeasures  # of the regions
    frame: VoxelFrame  # where they lie
    sides: PixelSides
    # whose sites are those of the regions; without them the centroids of the regions are
    seeds: VolumeSeeds | None = None
    # (n,) uint64 array: the largest squared distance in the region of each site
    largest_squares: NDArray[np.uint64] | None = None

    @property
    def labels(self) -> NDArray[np.uint32]:
        """Of the sites, increasing."""
        if self.seeds is None:
            return self.measures.labels
        assert self.seeds.site_labels is not None  # VolumeSeeds has filled them in
        return self.seeds.site_labels

    @cached_property
    def sites(self) -> NDArray[np.float64]:
        """(n, 3) positions x, y and z, in steps of the sides."""
        if self.seeds is not None:
            assert self.seeds.sites is not None
            return self.seeds.sites * self.steps
        centroids = self.measures.sums / self.measures.voxels[:, None] + self.corner
        placed: NDArray[np.float64] = centroids * self.steps
        return placed

    @property
    def steps(self) -> NDArray[np.int64]:
        """Width, height and depth of a voxel, in steps."""
        return np.array(self.sides.units[::-1], dtype=np.int64)

    @property
    def corner(self) -> NDArray[np.int64]:
        """The first voxel: x, y and z."""
        return np.array([self.frame.x, self.frame.y, self.frame.z], dtype=np.int64)

    @cached_property
    def rows(self) -> NDArray[np.intp]:
        """The site of each label that occurs."""
        return rows_of(self.measures.labels, self.labels)[0]

    @property
    def stranger(self) -> int | None:
        """The first label that occurs and is of no site."""
        return rows_of(self.measures.labels, self.labels)[1]


def regions_of_sweep(
    sweep: VolumeSweep, slabs: Iterable[tuple[int, NDArray[Any]]], *, distances: bool = False, threads: int = 0
) -> VolumeRegions:
    """Measure the regions of a tessellation from its labels, which come slab by slab and need not be in memory."""
    wanted = sweep.seeds.site_labels
    assert wanted is not None  # VolumeSeeds has filled them in
    largest = np.zeros(len(wanted), np.uint64)

    def passing() -> Iterator[NDArray[Any]]:
        for first, labels in slabs:
            if distances:
                squares = sweep.squared_distances(first, len(labels))
                found = largest_by_label(label_array(labels, "voxel"), squares, wanted, threads, None)
                np.maximum(largest, found, out=largest)
            yield labels

    measures = measure_slabs(passing(), threads=threads)
    return VolumeRegions(measures, sweep.frame, sweep.sides, sweep.seeds, largest if distances else None)
