"""Seeds: sites on the pixel lattice, or on a finer one."""

from __future__ import annotations

from dataclasses import field, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.numeric.checks import check_index, whole_numbers
from vorotool.types import fields as f
from vorotool.types.features import Rows, point_rows
from vorotool.types.fields import UNSTATED, YAxis, record
from vorotool.types.pixels import Frame, PixelGrid
from vorotool.types.values import Geometric, Pictured, Tabular, Value, counted

SCALES = tuple(2**k for k in range(41))
"""Lattice steps a pixel: up to those of the smallest frame, see `finest_scale`."""


class Seeds(Value):
    """Generators of a digital tessellation, in steps of a lattice."""

    labels: NDArray[np.uint32]
    scale: int
    sites: NDArray[np.float64]
    index: Any
    _axes: ClassVar[str] = "xy"

    def __post_init__(self) -> None:
        if self.sites is None:  # the first seed of each label
            labels, first = np.unique(self.labels, return_index=True)
            sites = np.stack([values[first] for values in self.coordinates], axis=1) / self.scale
            object.__setattr__(self, "sites", sites)
            object.__setattr__(self, "site_labels", labels)
        super().__post_init__()
        check_index(self.index, len(self.sites), "site")

    def __len__(self) -> int:
        return len(self.labels)

    @property
    def coordinates(self) -> tuple[NDArray[np.int64], ...]:
        """Columns, rows and maybe slices of the seeds, in steps."""
        return tuple(getattr(self, axis) for axis in self._axes)

    @cached_property
    def largest_label(self) -> int:
        """The largest label, 0 for no seeds."""
        return int(self.labels.max(initial=0))

    def _summary(self) -> str:
        sides = "pixel" if len(self._axes) == 2 else "voxel"
        sites = counted(len(self.sites), "site")
        return f"{counted(len(self), 'seed')} of {sites}, {self.scale} to a {sides} side"


@record
class SeedSet(Seeds, Tabular, Geometric, Pictured):
    """Generators of a digital Voronoi tessellation, several of which may share a label.

    Parameters
    ----------
    x, y : (n,) int64 arrays
        Coordinates in steps of 1 / ``scale`` pixel.
    labels : (n,) uint32 array
        Label of each seed, at least 1.
    scale : int
        Lattice steps a pixel: a power of two from 1 to 2^40, the smallest that holds the input.
    frame : Frame, optional
        The frame that the input brings along (an image's); points have none.
    sites : (k, 2) float64 array
        Position of each object in pixels: the point, or the centroid of a component or label.
    site_labels : (k,) uint32 array
        Label of each site, increasing.
    object_area : (k,) int64 array, optional
        Pixels of each object, for components and labels.
    properties : dict of str to sequence
        Other columns of the input, one value per site.
    snapped : int
        Seeds that were moved to the lattice.
    largest_move : float
        The largest of these moves, in pixels.
    y_axis : {"none", "up", "down"}
        Direction of y where the coordinates come from; "none" where nothing states it.
    grid : PixelGrid, optional
        Sides and places of the pixels of the image that the seeds come from.
    index : pandas Index, array or sequence, optional
        Names of the sites in the input, such as the row index of a data frame: one entry per site.

    Raises
    ------
    InputError
        If the shapes differ, a coordinate is no integer, or a label none from 1 to 4294967295.

    Examples
    --------
    >>> seeds = SeedSet(np.array([0, 5]), np.array([0, 1]), np.array([1, 2]))
    >>> seeds.scale, len(seeds)
    (1, 2)
    """

    x: NDArray[np.int64] = f.steps("seeds", along=0)
    y: NDArray[np.int64] = f.steps("seeds", along=1)
    labels: NDArray[np.uint32] = f.numbers(np.uint32, "seeds")
    scale: int = 1
    frame: Frame | None = f.position(default=None)
    sites: NDArray[np.float64] = f.position("sites", 2, default=None)  # filled in where they are not given
    site_labels: NDArray[np.uint32] = f.numbers(np.uint32, "sites", default=None)
    object_area: NDArray[np.int64] | None = f.numbers(np.int64, "sites", default=None)
    properties: dict[str, Any] = field(default_factory=dict)
    snapped: int = 0
    largest_move: float = 0.0
    y_axis: YAxis = f.y_axis(default=UNSTATED)
    grid: PixelGrid | None = None
    index: Any = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", whole_numbers(self.x, "x of seed", np.int64))
        object.__setattr__(self, "y", whole_numbers(self.y, "y of seed", np.int64))
        object.__setattr__(self, "labels", whole_numbers(self.labels, "label of seed", np.uint32, 1))
        if not (self.x.shape == self.y.shape == self.labels.shape and self.x.ndim == 1):
            raise InputError(
                f"x, y and labels must be 1-D of one length, but have shapes {self.x.shape}, {self.y.shape}, "
                f"{self.labels.shape}"
            )
        if self.scale not in SCALES:
            raise InputError(f"scale is {self.scale}: it must be a power of two from 1 to 2^40")
        super().__post_init__()

    @property
    def is_empty_image(self) -> bool:
        """Whether these are the seeds of an image without foreground: no list of points brings a frame."""
        return not len(self) and self.frame is not None

    def _rows(self, _what: str | None = None) -> Rows:
        x, y = np.ascontiguousarray(self.sites.T)
        made = self._features()
        label, *others = made.columns.items()
        return replace(made, columns=dict([label, ("x", x), ("y", y), *others]))

    def _features(self, _what: str | None = None, _flatten: float | None = None) -> Rows:
        area = {} if self.object_area is None else {"object_area": self.object_area}
        return point_rows({"label": self.site_labels, **area}, self, self.sites)
