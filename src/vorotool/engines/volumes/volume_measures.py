"""Measures of a label volume: its regions and their neighbours in one pass, and the digital Voronoi diagram."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common.label_arrays import described, label_array, next_row, refuse_negative
from vorotool.errors import InputError
from vorotool.geometry.arguments.descriptions import naming
from vorotool.geometry.arguments.volumes import as_volume
from vorotool.geometry.checks import checked_threads
from vorotool.geometry.progress import Progress
from vorotool.geometry.volumes.label_volume import LabelVolume
from vorotool.geometry.volumes.volume import Volume

if TYPE_CHECKING:
    from vorotool.typing import VolumeLike


@dataclass(frozen=True)
class VolumeMeasures:
    """Measures of the regions of a label volume; what `measure_volume` gives. All are counts, along x, y and z.

    Parameters
    ----------
    labels : (k,) uint32 array
        The labels that occur, increasing, without 0.
    voxels, components : (k,) int64 array
        Voxels of each region, and its 6-connected parts.
    faces : (k, 3) int64 array
        Faces of voxels across each axis, between the region and anything else, the outside of the volume included.
    sums : (k, 3) int64 array
        Of columns, rows and slices, which count from the corner of the volume.
    low, high : (k, 3) int64 array
        First and last column, row and slice.
    borders : (b, 2) uint32 array
        Indices of two regions that share a face, the smaller first, in lexicographic order.
    border_faces : (b, 3) int64 array
        Faces that the two share, across each axis.
    """

    labels: NDArray[np.uint32]
    voxels: NDArray[np.int64]
    components: NDArray[np.int64]
    faces: NDArray[np.int64]
    sums: NDArray[np.int64]
    low: NDArray[np.int64]
    high: NDArray[np.int64]
    borders: NDArray[np.uint32]
    border_faces: NDArray[np.int64]

    def touches_frame(self, shape: tuple[int, int, int]) -> NDArray[np.bool_]:
        """(k,) whether each region has voxels at a border of the volume, whose shape is (D, H, W).

        Examples
        --------
        >>> measure_volume(np.pad([[[3]]], 1, constant_values=2)).touches_frame((3, 3, 3)).tolist()
        [True, False]
        """
        last = np.array(shape[::-1]) - 1
        touches: NDArray[np.bool_] = ((self.low == 0) | (self.high == last)).any(axis=1)
        return touches


def measure_volume(volume: VolumeLike, *, threads: int = 0, progress: Progress = None) -> VolumeMeasures:
    """Measure all regions of a label volume in one pass.

    The tables and the colouring take the result as ``measures``, so that several of them cost one pass.

    Parameters
    ----------
    volume : LabelVolume, or (D, H, W) array of integers or truth values
        Label 0 is background and no region.
    threads : int
        0 for all, which share whole slices; the result is the same for any number.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    VolumeMeasures

    Raises
    ------
    InputError
        If a label is negative or above 4294967295.

    Examples
    --------
    >>> measures = measure_volume(np.array([[[1, 1, 2]], [[1, 2, 2]]], dtype=np.uint16))
    >>> measures.voxels.tolist(), measures.border_faces.tolist()
    ([3, 3], [[2, 0, 1]])
    """
    return measure_slabs([labelled(volume).labels], threads=threads, progress=progress)


def measure_slabs(slabs: Iterable[NDArray[Any]], *, threads: int = 0, progress: Progress = None) -> VolumeMeasures:
    """Measure all regions of a label volume that comes slab by slab: it need not be in memory.

    Memory: some 200 bytes a region and 100 a pair of neighbours, and for each thread the runs of equal labels of a few
    slices.

    Parameters
    ----------
    slabs : iterable of (d, H, W) integer array
        One after the other along z, of any depths.
    threads, progress
        As of `measure_volume`; progress is that of each slab.

    Raises
    ------
    InputError
        If there is no slab, slabs differ in height or width, or a label is negative or above 4294967295.

    Examples
    --------
    >>> measure_slabs(np.full((1, 2, 2), 7, np.uint8) for _ in range(3)).faces.tolist()
    [[12, 12, 8]]
    """
    threads = checked_threads(threads)
    measurer, size = None, (0, 0)
    negative: list[np.dtype[Any]] = []
    for slab in slabs:
        if measurer is None:
            size = (slab.shape[1], slab.shape[2])
            measurer = _core.volumes.VolumeMeasurer(size[1], size[0])
        if slab.shape[1:] != size:
            raise InputError(
                f"slabs must have one height and width, but a slab of {slab.shape} follows those of {size}"
            )
        negative.append(slab.dtype)
        measurer.add(label_array(slab, "voxel"), threads, progress)
    if measurer is None:
        raise InputError("there is no slab to measure")
    found = measurer.finish(progress)
    for dtype in set(negative):
        refuse_negative(dtype, int(found["labels"].max(initial=0)), "voxel")
    borders = np.stack([found.pop("border_a"), found.pop("border_b")], axis=1)
    return VolumeMeasures(borders=borders, **found)


def volume_diagram(
    labels: VolumeLike,
    *,
    before: NDArray[Any] | None = None,
    after: NDArray[Any] | None = None,
    out: NDArray[np.uint8] | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[np.uint8]:
    """Mark the digital Voronoi diagram: voxels of which a neighbour across a face has a larger label (section 2.1).

    Parameters
    ----------
    labels : LabelVolume, or (D, H, W) array of integers or truth values
        Voxels of label 0 are never marked, and as neighbours never larger.
    before, after : (H, W) integer array, optional
        The slices next to a slab of a larger volume, which then can be streamed in slabs of any depth.
    out : (D, H, W) uint8 array, optional
        C-contiguous array to write to; it must not overlap the labels.
    threads : int
        0 for all; the result is the same for any number.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    (D, H, W) uint8 array
        1 on the diagram, else 0.

    Raises
    ------
    InputError
        If the shapes do not fit.

    Examples
    --------
    >>> volume_diagram(np.array([[[1, 1, 2]], [[3, 1, 0]]], dtype=np.uint16)).tolist()
    [[[1, 1, 0]], [[0, 1, 0]]]
    """
    own = label_array(labelled(labels).labels, "voxel")
    if out is None:
        out = np.empty(own.shape, dtype=np.uint8)
    elif described(out) != f"uint8 of shape {own.shape}" or not out.flags.c_contiguous:
        raise InputError(f"out must be a C-contiguous uint8 array of shape {own.shape}, but is {described(out)}")
    slices = [next_row(each, name, own) for each, name in ((before, "before"), (after, "after"))]
    _core.volumes.mark_diagram(own, slices[0], slices[1], out, checked_threads(threads), progress)
    return out


def labelled(volume: Any) -> LabelVolume:
    """Give a label volume: of truth values the 26-connected components are numbered, integers are labels.

    Raises
    ------
    InputError
        If it is no volume of labels.

    Examples
    --------
    >>> labelled(np.array([[[True, False, True]]])).labels.tolist()
    [[[1, 0, 2]]]
    """
    if isinstance(volume, LabelVolume):
        return volume
    made: Volume = as_volume(volume, "volume")
    values = made.values
    if values.dtype.kind == "f":
        with naming("volume"):
            raise InputError(f"expected labels, a 3-D array of integers, but got {described(values)}")
    return LabelVolume(_numbered(values) if values.dtype == bool else values, grid=made.grid)


def _numbered(mask: NDArray[np.bool_]) -> NDArray[np.uint32]:
    depth, height, width = mask.shape
    components = _core.volumes.VolumeComponents(width, height, True)
    provisional = np.empty((depth, height, width), np.uint32)
    components.add(np.ascontiguousarray(mask).view(np.uint8), provisional, None)
    number = np.empty(components.size + 1, np.uint32)
    components.settle(number)
    return number[provisional]
