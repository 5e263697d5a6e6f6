"""The box of voxels that a digital diagram covers, and the sides and unit of its voxels."""

from __future__ import annotations

from fractions import Fraction
from typing import Literal

from vorotool.errors import LimitError, option
from vorotool.numeric.length_units import unit_name
from vorotool.plain import plain
from vorotool.types.pixels import ALIKE, MAX_SIDE, check_frame


@plain
class VoxelFrame:
    """A box of voxels: voxel (0, 0, 0) of the volume has its center at (``x``, ``y``, ``z``).

    Parameters
    ----------
    x, y, z : int
        Coordinates of the center of the first voxel.
    width, height, depth : int
        Size in voxels, each at least 1.

    Raises
    ------
    InputError
        If the frame is empty, or begins farther than 2^44 voxels from the origin.
    LimitError
        If a side has more than 2^30 voxels.
    UsageError
        If a number is not an integer.

    Examples
    --------
    >>> VoxelFrame(0, 0, 0, 640, 480, 20).shape
    (20, 480, 640)
    """

    x: int
    y: int
    z: int
    width: int
    height: int
    depth: int

    def __post_init__(self) -> None:
        check_frame(self, "voxels", option("--size WxHxD", "shape=(D, H, W)"))
        if max(self.shape) > MAX_SIDE:
            text = " x ".join(map(str, self.shape[::-1]))
            raise LimitError(f"the frame is {text}: a side has at most 2^30 voxels")

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns, as NumPy orders them."""
        return (self.depth, self.height, self.width)

    @property
    def origin(self) -> tuple[int, int, int]:
        """Column, row and slice of the first voxel."""
        return (self.x, self.y, self.z)

    def part(self, first: int, count: int) -> VoxelFrame:
        """Return the frame of some slices."""
        return VoxelFrame(self.x, self.y, self.z + first, self.width, self.height, count)

    @property
    def voxels(self) -> int:
        """Number of voxels."""
        return self.width * self.height * self.depth


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
