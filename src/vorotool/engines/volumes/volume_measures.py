"""Measures of a label volume: its regions and their neighbors in one pass, and the digital Voronoi diagram."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.volumes import as_volume
from vorotool.engines.common import described, label_array, next_row, refuse_negative
from vorotool.errors import InputError
from vorotool.numeric.checks import checked_threads, naming
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.volumes.label_volume import LabelVolume
from vorotool.types.volumes.volume import Volume

if TYPE_CHECKING:
    from vorotool.typing import VolumeLike


@plain
class VolumeMeasures:
    """Measures of the regions of a label volume; what `measure_volume` gives. All are counts, along x, y and z."""

    labels: NDArray[np.uint32]  # (k,) uint32 array: the labels that occur, increasing, without 0
    voxels: NDArray[np.int64]  # (k,) int64 array: voxels of each region, and its 6-connected parts
    components: NDArray[np.int64]  # (k,) int64 array: voxels of each region, and its 6-connected parts
    # (k, 3) int64 array: faces of voxels across each axis, between the region and anything else, the outside of the
    # volume included
    faces: NDArray[np.int64]
    # (k, 3) int64 array: of columns, rows and slices, which count from the corner of the volume
    sums: NDArray[np.int64]
    low: NDArray[np.int64]  # (k, 3) int64 array: first and last column, row and slice
    high: NDArray[np.int64]  # (k, 3) int64 array: first and last column, row and slice
    # (b, 2) uint32 array: indices of two regions that share a face, the smaller first, in lexicographic order
    borders: NDArray[np.uint32]
    border_faces: NDArray[np.int64]  # (b, 3) int64 array: faces that the two share, across each axis

    def touches_frame(self, shape: tuple[int, int, int]) -> NDArray[np.bool_]:
        """(k,) whether each region has voxels at a border of the volume, whose shape is (D, H, W)."""
        last = np.array(shape[::-1]) - 1
        touches: NDArray[np.bool_] = ((self.low == 0) | (self.high == last)).any(axis=1)
        return touches


def measure_volume(volume: VolumeLike, *, threads: int = 0, progress: Progress = None) -> VolumeMeasures:
    """Measure all regions of a label volume in one pass."""
    return measure_slabs([labeled(volume).labels], threads=threads, progress=progress)


def measure_slabs(slabs: Iterable[NDArray[Any]], *, threads: int = 0, progress: Progress = None) -> VolumeMeasures:
    """Measure all regions of a label volume that comes slab by slab: it need not be in memory."""
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
        raise InputError("the sequence of slabs is empty: give at least one")
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
    """Mark the digital Voronoi diagram: voxels of which a neighbor across a face has a larger label (section 2.1)."""
    own = label_array(labeled(labels).labels, "voxel")
    if out is None:
        out = np.empty(own.shape, dtype=np.uint8)
    elif described(out) != f"uint8 of shape {own.shape}" or not out.flags.c_contiguous:
        raise InputError(f"out must be a C-contiguous uint8 array of shape {own.shape}, but is {described(out)}")
    slices = [next_row(each, name, own) for each, name in ((before, "before"), (after, "after"))]
    _core.volumes.mark_diagram(own, slices[0], slices[1], out, checked_threads(threads), progress)
    return out


def labeled(volume: Any) -> LabelVolume:
    """Give a label volume: of truth values the 26-connected components are numbered, integers are labels."""
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
