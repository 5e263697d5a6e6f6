"""A volume as it was read, the seeds of one, and the labels of its voxels."""

from __future__ import annotations

from dataclasses import field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, LimitError, option
from vorotool.frozen import frozen
from vorotool.numeric.checks import whole_numbers
from vorotool.numeric.length_units import unit_name
from vorotool.products.formats import resolved
from vorotool.types import fields as f
from vorotool.types.fields import record
from vorotool.types.images import check_labels
from vorotool.types.pixels import ALIKE, MAX_SIDE, Elements, PixelSides, check_frame
from vorotool.types.points.seed_set import Seeds
from vorotool.types.values import Graph, Tabular, Value

if TYPE_CHECKING:
    from vorotool.types.features import Rows


@frozen
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


@frozen
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


def _size_text(value: Volume | LabelVolume, array: NDArray[Any]) -> str:
    """Give the size, the type and the sides of voxels in words."""
    depth, height, width = array.shape
    size = "" if value.grid is None else f", voxels of {value.grid.size_text()}"
    return f"{width} x {height} x {depth}, {array.dtype}{size}"


@frozen(eq=False, repr=False)
class Volume(Value):
    """A volume of one channel.

    Parameters
    ----------
    values : (D, H, W) array
        Truth values, integers or floats.
    grid : VoxelGrid, optional
        Sides of the voxels, where the file says them.

    Raises
    ------
    InputError
        If the array has another number of axes, no voxels, masked ones, or no numbers.

    Examples
    --------
    >>> Volume(np.zeros((2, 3, 4), dtype=np.uint8)).shape
    (2, 3, 4)
    """

    values: NDArray[Any]
    grid: VoxelGrid | None = None

    def __post_init__(self) -> None:
        if np.ma.isMaskedArray(self.values) and np.ma.getmaskarray(self.values).any():
            raise InputError("invalid volume: expected a value in each voxel, but some are masked; fill them first")
        values = np.asarray(self.values)
        if values.ndim != 3:
            raise InputError(f"a volume must have shape (D, H, W), but has shape {values.shape}")
        if values.dtype.kind not in "biuf":
            raise InputError(f"a volume must hold numbers, but has type {values.dtype}")
        if values.size == 0:
            raise InputError(f"the volume is empty: its shape is {values.shape}")
        object.__setattr__(self, "values", values)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""
        depth, height, width = self.values.shape
        return (depth, height, width)

    def _summary(self) -> str:
        return _size_text(self, self.values)


CUBE = PixelSides((1, 1, 1))
"""Sides of 1."""


@frozen(eq=False, repr=False)
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
    frame: VoxelFrame = f.filled_in()
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
        return resolved("engines.label_images.features:region_rows")(self)

    def _summary(self) -> str:
        return _size_text(self, self.labels)


FINEST_SCALE = 256
"""Lattice steps a voxel at most: coordinates are kept to 1/256 of a voxel."""


@record
class VolumeSeeds(Seeds):
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

    _axes = "xyz"

    places: NDArray[np.int64]
    labels: NDArray[np.uint32] = f.numbers(np.uint32, "seeds")
    scale: int = 1
    frame: VoxelFrame | None = None
    sites: NDArray[np.float64] = f.numbers(np.float64, "sites", 3, default=None)  # filled in where they are not given
    site_labels: NDArray[np.uint32] = f.numbers(np.uint32, "sites", default=None)
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
        super().__post_init__()

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
