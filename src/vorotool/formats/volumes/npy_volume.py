"""Volumes in NPY files, which are mapped: in any order of bytes and of axes."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import InputError
from vorotool.formats.images.band_reader import plain_values
from vorotool.formats.images.npy import stored
from vorotool.formats.io.npy_arrays import NpyHeader, npy_header, npy_values
from vorotool.formats.io.sources import Source
from vorotool.formats.volumes.source import Spool, checked_slabs, mapped
from vorotool.plain import plain
from vorotool.types.volumes.voxel_frame import VoxelGrid


@plain
class NpyVolume:
    """The slices of an array of three axes; in Fortran order each slice is scattered over the whole file."""

    name: str  # as of `vorotool.formats.volumes.tiff_stack.TiffStack`
    path: str  # as of `vorotool.formats.volumes.tiff_stack.TiffStack`
    spool: Spool | None = None  # as of `vorotool.formats.volumes.tiff_stack.TiffStack`

    @cached_property
    def _source(self) -> Source:
        return Source(self.name, mapped(self.path))

    @cached_property
    def _header(self) -> NpyHeader:
        header = npy_header(self._source)
        if len(header.shape) != 3:
            raise InputError(
                f"{self.name} has {len(header.shape)} axes, shape {header.shape}: a volume has three, slices, rows and "
                "columns; save a part of it that has three"
            )
        return header

    @cached_property
    def _values(self) -> NDArray[Any]:
        return npy_values(self._source, self._header)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""
        depth, height, width = self._values.shape  # which says if the file ends before
        return depth, height, width

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of what is read."""
        kind = self._header.dtype
        return np.dtype(np.uint8) if kind.kind == "b" else kind.newbyteorder("=")

    @property
    def grid(self) -> VoxelGrid | None:
        """Such files say nothing of it."""
        return None

    @property
    def note(self) -> str:
        """That the order of the axes costs time."""
        if not self._header.fortran_order or 1 in self.shape:
            return ""
        return f"{self.name} is in Fortran order, which is read slowly: save it in C order"

    @property
    def chunk_depth(self) -> int:
        """Each slice is read by itself."""
        return 1

    def slices(self, first: int, count: int) -> NDArray[Any]:
        """Read some slices; bool becomes uint8."""
        return plain_values(np.ascontiguousarray(self._values[first : first + count]))

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is open."""
        return {"name": self.name, "path": self.path, "spool": None}


def write_npy_volume(
    out: BinaryIO, slabs: Iterable[NDArray[Any]], shape: tuple[int, int, int], *, dtype: DTypeLike
) -> None:
    """Write an array from slabs of slices: the header first, then each slab as it comes."""
    kind = np.dtype(dtype).newbyteorder("<")
    header = {"descr": np.lib.format.dtype_to_descr(kind), "fortran_order": False, "shape": tuple(map(int, shape))}
    np.lib.format.write_array_header_1_0(out, header)
    for slab in checked_slabs(slabs, shape):
        out.write(stored(slab, kind).data)
