"""The exact digital tessellation of a volume (section 2.1, with one more axis), slice by slice."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.tessellation.frames import check_out, label_dtype, simd_level, squared_limit
from vorotool.errors import LimitError, UsageError
from vorotool.geometry.checks import checked_threads
from vorotool.geometry.spacing import PixelSides

MOST_VOXELS_A_SIDE = 2**30
"""Voxels along an axis at most: they are counted in 32-bit integers."""


class VolumeSweep:
    """The exact tessellation of a volume, ready to give any of its slices.

    Parameters
    ----------
    places : (n, 3) int array
        Voxels of the seeds, at least one: slice, row, column.
    labels : (n,) uint32 array
        From 1. Where several seeds are equally near, the smallest is taken.
    shape : (D, H, W)
        Slices, rows, columns.
    sides : PixelSides
        Of a voxel, in whose unit distances are.
    max_distance : float or Fraction, optional
        Voxels farther than this from every seed get label 0.
    threads : int
        0 uses all.
    way : str
        By ``"rows"``, by ``"bricks"``, or the ``"quicker"`` one, which changes the time alone.

    Raises
    ------
    InputError
        If the volume is too wide for exact arithmetic.

    Notes
    -----
    On a row seeds are nearest in the order of their columns, and what hides one there hides it on a half-plane of rows
    and slices. So each waits until it may be nearest again. Where seeds are dense, each tells the voxels around it in
    its slice, and a voxel takes the least over the slices near it. Results depend neither on that, nor on threads, nor
    on instruction sets.

    Examples
    --------
    >>> places, labels = np.array([[0, 0, 0], [1, 0, 3]]), np.array([1, 2], dtype=np.uint32)
    >>> VolumeSweep(places, labels, (2, 1, 4)).labels().tolist()
    [[[1, 1, 2, 2]], [[1, 1, 2, 2]]]
    """

    def __init__(
        self,
        places: NDArray[np.integer[Any]],
        labels: NDArray[np.uint32],
        shape: tuple[int, int, int],
        *,
        sides: PixelSides | None = None,
        max_distance: float | Fraction | None = None,
        threads: int = 0,
        way: str = "quicker",
    ) -> None:
        self.shape = shape
        self.sides = sides or PixelSides((1, 1, 1))
        if max(shape) > MOST_VOXELS_A_SIDE:
            raise LimitError(f"the volume is {' x '.join(map(str, shape))}: a side has at most 2^30 voxels")
        self._threads = checked_threads(threads)
        self._most_squared = squared_limit(max_distance, 1 / self.sides.step)
        self._largest_label = int(labels.max())
        z, y, x = (np.ascontiguousarray(axis, dtype=np.int64) for axis in places.T)
        depth, height, width = shape
        unit_z, unit_y, unit_x = self.sides.units
        try:
            self._core = _core.volumes.VolumeTessellation(
                x,
                y,
                z,
                labels,
                (0, 0, 0),
                (width, height, depth),
                1,
                (unit_x, unit_y, unit_z),
                simd_level(),
                way,
            )
        except _core.tessellation.SeedTooFarError:
            raise LimitError(
                f"a volume of {' x '.join(map(str, shape))} voxels of {' x '.join(map(str, self.sides.units))} steps "
                "is too wide for exact arithmetic, 2^40 steps: round the sides to fewer digits"
            ) from None

    @property
    def step(self) -> Fraction:
        """The length whose square is the unit of squared distances."""
        return self.sides.step

    @property
    def arithmetic(self) -> str:
        """The narrowest arithmetic that is exact for these seeds."""
        if self._core.is_wide:
            return "int128"
        return "float64" if self._core.products_exact else "float64 with int128"

    def labels(
        self, first: int = 0, slices: int | None = None, *, dtype: Any = None, out: NDArray[Any] | None = None
    ) -> NDArray[Any]:
        """Labels of some slices.

        Parameters
        ----------
        first, slices : int
            The first slice and the number of slices; by default all.
        dtype : dtype, optional
            As in `vorotool.tessellate`.
        out : (slices, H, W) array, optional
            Written instead of a new array; C-contiguous, of one of these types.

        Returns
        -------
        (slices, H, W) array
            `out` if it was given.

        Raises
        ------
        UsageError
            If the labels do not fit the type, or `out` has another shape or layout.
        """
        kind = label_dtype(self._largest_label, getattr(out, "dtype", dtype))
        array = self._output(first, slices, kind, out)
        limit = None if self._most_squared is None else divmod(self._most_squared, 2**64)
        written = array.view(np.uint32) if kind == np.int32 else array
        self._core.labels(written, first, limit, self._threads, None)
        return array

    def squared_distances(
        self, first: int = 0, slices: int | None = None, *, out: NDArray[Any] | None = None
    ) -> NDArray[Any]:
        """Exact squared distances to the nearest seed, in squares of a step.

        Parameters
        ----------
        first, slices : int
            The first slice and the number of slices; by default all.
        out : (slices, H, W) array, optional
            Written instead of a new array; C-contiguous, of the same type.

        Raises
        ------
        LimitError
            If a squared distance may exceed 64 bits.
        UsageError
            If `out` has another shape, type or layout.
        """
        extent = [side * unit for side, unit in zip(self.shape, self.sides.units, strict=True)]
        largest = sum(each * each for each in extent)
        if largest >= 2**64:
            raise LimitError("squared distances of this volume may exceed 64 bits: round the sides to fewer digits")
        array = self._output(first, slices, np.dtype(np.uint32 if largest < 2**32 else np.uint64), out)
        self._core.squared_distances(array, first, self._threads, None)
        return array

    def _output(self, first: int, slices: int | None, dtype: np.dtype[Any], out: NDArray[Any] | None) -> NDArray[Any]:
        """Make an array for slices, or check the one that was given."""
        depth, height, width = self.shape
        shape = (depth - first if slices is None else slices, height, width)
        if out is None:
            return np.empty(shape, dtype)
        check_out(out, shape)
        if out.dtype != dtype:
            raise UsageError(f"out must be of type {dtype}, but is of type {out.dtype}")
        return out


def outer_voxels(volume: NDArray[Any]) -> NDArray[np.bool_]:
    """Nonzero voxels that have not their own value on all six sides: no other voxel needs more of them.

    From a voxel that its own value surrounds, one step towards any other voxel leads to one that is strictly nearer.

    Parameters
    ----------
    volume : (D, H, W) array
        0 is background.

    Examples
    --------
    >>> int(outer_voxels(np.ones((3, 3, 3), np.uint8)).sum())
    26
    """
    outer: NDArray[np.bool_] = volume != 0
    inner = np.ones(tuple(max(side - 2, 0) for side in volume.shape), dtype=bool)
    centre = volume[1:-1, 1:-1, 1:-1]
    for axis in range(3):
        for end in (slice(None, -2), slice(2, None)):
            window = [slice(1, -1)] * 3
            window[axis] = end
            inner &= centre == volume[tuple(window)]
    outer[1:-1, 1:-1, 1:-1] &= ~inner
    return outer
