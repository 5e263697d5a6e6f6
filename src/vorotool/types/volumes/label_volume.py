"""A label volume: the result of a digital tessellation in three dimensions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from vorotool.plain import plain
from vorotool.products.formats import resolved
from vorotool.types.elements import Elements
from vorotool.types.images import check_labels
from vorotool.types.pixels import PixelSides
from vorotool.types.values import Graph, Tabular, Value
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame, VoxelGrid

if TYPE_CHECKING:
    from vorotool.types.features import Rows

CUBE = PixelSides((1, 1, 1))
"""Sides of 1."""


@plain(eq=False, repr=False)
class LabelVolume(Value, Tabular, Graph, Elements):
    """Labels of the voxels of a frame.

    Parameters
    ----------
    labels : (D, H, W) array of uint8, uint16, uint32 or int32
        Label of each voxel; 0 where there is none.
    frame : VoxelFrame, optional
        Where the voxels lie; by default voxel (0, 0, 0) is at the origin.
    seeds : VolumeSeeds, optional
        The seeds that the labels come from.
    sides : PixelSides
        Sides of a voxel, in whose unit distances are.
    grid : VoxelGrid, optional
        Sides of the voxels as the file says them; by default those of the volume that the seeds come from.

    Raises
    ------
    InputError
        If the labels are no volume of integers, or the frame has another shape.

    Examples
    --------
    >>> import numpy as np
    >>> LabelVolume(np.array([[[1, 1, 2]]], dtype=np.uint16)).frame.shape
    (1, 1, 3)
    """

    labels: NDArray[Any]
    frame: VoxelFrame | None = None
    seeds: VolumeSeeds | None = None
    sides: PixelSides = CUBE
    grid: VoxelGrid | None = None

    def __post_init__(self) -> None:
        check_labels(self, 3, VoxelFrame)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""
        depth, height, width = self.labels.shape
        return (depth, height, width)

    def _array(self) -> NDArray[Any]:
        return self.labels

    def _rows(self, _what: str | None = None) -> Rows:
        rows: Rows = resolved("engines.label_images.features:region_rows")(self)
        return rows

    def _summary(self) -> str:
        depth, height, width = self.shape
        size = "" if self.grid is None else f", voxels of {self.grid.size_text()}"
        return f"{width} x {height} x {depth}, {self.labels.dtype}{size}"
