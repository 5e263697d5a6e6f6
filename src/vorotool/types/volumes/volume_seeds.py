"""Seeds of a volume: sites on the lattice of voxels, or on a lattice up to 256 times finer."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.numeric.checks import check_index, whole_numbers
from vorotool.types import fields as f
from vorotool.types.fields import record
from vorotool.types.values import Value, counted
from vorotool.types.volumes.voxel_frame import VoxelFrame, VoxelGrid

FINEST_SCALE = 256
"""Lattice steps a voxel at most: coordinates are kept to 1/256 of a voxel."""


@record
class VolumeSeeds(Value):
    """Generators of the digital Voronoi tessellation of a volume, several of which may share a label.

    Parameters
    ----------
    places : (n, 3) int64 array
        Coordinates x, y and z in steps of 1 / ``scale`` voxel; stored column by column.
    labels : (n,) uint32 array
        Label of each seed, at least 1.
    scale : int
        Lattice steps a voxel: a power of two from 1 to 256, the smallest that holds the input.
    frame : VoxelFrame, optional
        The frame that the input brings along (a volume's); points have none.
    sites : (k, 3) float64 array
        Position of each object in voxels, x, y and z: the point, or the centroid of a component or label.
    site_labels : (k,) uint32 array
        Label of each site, increasing.
    object_volume : (k,) int64 array, optional
        Voxels of each object, for components and labels.
    properties : dict of str to sequence
        Other columns of the input, one value per site.
    snapped : int
        Seeds that were moved to the lattice.
    largest_move : float
        The largest of these moves, in voxels.
    grid : VoxelGrid, optional
        Sides of the voxels of the volume that the seeds come from.
    index : pandas Index, array or sequence, optional
        Names of the sites in the input, such as the row index of a data frame: one entry per site.
    filled : (n,) bool array, optional
        Of the outer voxels of objects, in the order of z, y and x: whether voxels inside the object, which are no
        seeds, follow a seed on its row, up to the next seed. None where all voxels of the objects are seeds.

    Raises
    ------
    InputError
        If the shapes differ, a coordinate is no integer, or a label none from 1 to 4294967295.

    Examples
    --------
    >>> seeds = VolumeSeeds(np.array([[0, 0, 0], [5, 1, 2]]), np.array([1, 2]))
    >>> seeds.scale, len(seeds)
    (1, 2)
    """

    places: NDArray[np.int64]
    labels: NDArray[np.uint32] = f.numbers(np.uint32, "seeds")
    scale: int = 1
    frame: VoxelFrame | None = None
    sites: NDArray[np.float64] | None = f.numbers(np.float64, "sites", 3, default=None)
    site_labels: NDArray[np.uint32] | None = f.numbers(np.uint32, "sites", default=None)
    object_volume: NDArray[np.int64] | None = f.numbers(np.int64, "sites", default=None)
    properties: dict[str, Any] = field(default_factory=dict)
    snapped: int = 0
    largest_move: float = 0.0
    grid: VoxelGrid | None = None
    index: Any = None
    filled: NDArray[np.bool_] | None = None

    def __post_init__(self) -> None:
        # Turned, columns that lie one after the other are not copied.
        places = whole_numbers(np.transpose(self.places), "coordinate of seeds", np.int64).T
        object.__setattr__(self, "places", places)
        object.__setattr__(self, "labels", whole_numbers(self.labels, "label of seed", np.uint32, 1))
        if self.labels.ndim != 1 or self.places.shape != (len(self.labels), 3):
            raise InputError(
                f"places must have shape (n, 3) and labels (n,), but they have {self.places.shape} and "
                f"{self.labels.shape}"
            )
        if self.scale not in (1, 2, 4, 8, 16, 32, 64, 128, 256):
            raise InputError(f"scale is {self.scale}: it must be a power of two from 1 to {FINEST_SCALE}")
        if self.filled is not None and (np.shape(self.filled) != self.labels.shape or self.scale != 1):
            raise InputError(f"filled must have shape {self.labels.shape} and need scale 1")
        if self.sites is None:
            labels, first = np.unique(self.labels, return_index=True)
            object.__setattr__(self, "sites", self.places[first] / self.scale)
            object.__setattr__(self, "site_labels", labels)
        super().__post_init__()
        assert self.sites is not None
        check_index(self.index, len(self.sites), "site")

    def __len__(self) -> int:
        return len(self.labels)

    @property
    def x(self) -> NDArray[np.int64]:
        """Columns of the seeds, in steps."""
        return self.places[:, 0]

    @property
    def y(self) -> NDArray[np.int64]:
        """Rows of the seeds, in steps."""
        return self.places[:, 1]

    @property
    def z(self) -> NDArray[np.int64]:
        """Slices of the seeds, in steps."""
        return self.places[:, 2]

    @property
    def coordinates(self) -> tuple[NDArray[np.int64], ...]:
        """Columns, rows and slices of the seeds, in steps."""
        return (self.x, self.y, self.z)

    @property
    def is_empty_volume(self) -> bool:
        """Whether these are the seeds of a volume without foreground: no list of points brings a frame."""
        return not len(self) and self.frame is not None

    @cached_property
    def largest_label(self) -> int:
        """The largest label, 0 for no seeds."""
        return int(self.labels.max(initial=0))

    def _summary(self) -> str:
        sites = 0 if self.sites is None else len(self.sites)
        return f"{counted(len(self), 'seed')} of {counted(sites, 'site')}, {self.scale} to a voxel side"
