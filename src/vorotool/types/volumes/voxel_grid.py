"""What the file of a volume says of its voxels: their sides and the unit."""

from __future__ import annotations

from fractions import Fraction
from typing import Literal

from vorotool.numeric.length_units import unit_name
from vorotool.plain import plain
from vorotool.types.pixel_grid import ALIKE

VolumeForm = Literal["tiff", "imagej", "ome", "zarr"]


@plain
class VoxelGrid:
    """The grid of the voxels of a volume, in units of the world.

    Parameters
    ----------
    width, height, depth : Fraction
        Sides of a voxel, more than 0: along x, y and z.
    unit : str, optional
        Of all three.
    form : {"tiff", "imagej", "ome", "zarr"}
        How the file says it, which is how outputs say it again; zarr is OME-Zarr.

    Examples
    --------
    >>> VoxelGrid(Fraction(13, 40), Fraction(13, 40), Fraction(3, 2), "um").size_text()
    '0.325 x 0.325 x 1.5 µm'
    """

    width: Fraction
    height: Fraction
    depth: Fraction
    unit: str | None = None
    form: VolumeForm = "imagej"

    def __post_init__(self) -> None:
        object.__setattr__(self, "unit", None if self.unit is None else unit_name(self.unit))

    @property
    def sides(self) -> tuple[Fraction, Fraction, Fraction]:
        """Depth, height and width, as arrays are ordered and as `pixel_sides` takes them."""
        return (self.depth, self.height, self.width)

    @property
    def is_cube(self) -> bool:
        """Whether all sides are as long as each other."""
        return max(self.sides) - min(self.sides) <= ALIKE * self.width

    def size_text(self) -> str:
        """Words for the size of a voxel, along x, y and z."""
        sides = " x ".join(f"{float(side):.10g}" for side in reversed(self.sides))
        return sides if self.unit is None else f"{sides} {self.unit}"
