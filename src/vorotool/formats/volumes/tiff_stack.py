"""TIFF files as volumes: a page is a slice, and of uncompressed ones nothing is read before it is looked at."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, option
from vorotool.formats.images.band_reader import plain_values
from vorotool.formats.images.nodata import missing_values
from vorotool.formats.images.tiff_grid import grid_of
from vorotool.formats.images.tiff_layout import TiffLayout
from vorotool.formats.images.tiff_reader import opened_tiff, page_layout
from vorotool.formats.images.tiff_segments import decode_band, is_decoded_here
from vorotool.formats.io.limits import decoding
from vorotool.formats.volumes.mapping import Spool, mapped
from vorotool.formats.volumes.stack_axes import StackAxes, stack_axes
from vorotool.numeric.parallel import in_order
from vorotool.plain import plain
from vorotool.types.volumes.voxel_grid import VoxelGrid

_WORTH_THREADS = 2**20
"""Bytes of slices from which threads take less time than they cost."""


@plain
class _Stack:
    """Where the voxels are."""

    pages: Sequence[TiffLayout]
    axes: StackAxes  # what the file says of them
    nodata: float | None  # voxels with this value have none
    step: int | None  # bytes from slice to slice where each is one array and they are equally far apart


@plain
class TiffStack:
    """The slices of a TIFF file with one value a pixel."""

    name: str  # as the user wrote it
    path: str  # absolute, for processes in other folders
    spool: Spool | None = None  # keeps the file, where it is a temporary one

    @cached_property
    def _stack(self) -> _Stack:
        size = len(self._bytes)
        with opened_tiff(self.name, self.path) as file, decoding(self.name, "TIFF"):
            pages = list(_full_pages(file))
            if not pages:
                raise InputError(f"{self.name} is damaged: it begins as a TIFF, but holds no image")
            axes = stack_axes(self.name, file, len(pages))
            first = page_layout(self.name, size, pages[0])
            _check_values(first, pages[0])
            if len(pages) == 1 and (axes.slices or 1) > 1:
                layouts = _behind_each_other(first, axes.slices or 1, size)
            else:
                order = axes.pages or range(_count_of(self.name, axes, len(pages)))
                layouts = list(_alike(self.name, size, first, pages, order))
            return _Stack(layouts, axes, grid_of(self.name, file, pages[0]).nodata, _step_of(layouts))

    @cached_property
    def _bytes(self) -> bytes:
        with decoding(self.name, "TIFF"):
            return mapped(self.path)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""
        pages = self._stack.pages
        return len(pages), pages[0].height, pages[0].width

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of what is read."""
        kind = self._stack.pages[0].dtype
        assert kind is not None
        return np.dtype(np.uint8) if kind.kind == "b" else kind.newbyteorder("=")

    @property
    def grid(self) -> VoxelGrid | None:
        """Sides of the voxels."""
        return self._stack.axes.grid

    @property
    def note(self) -> str:
        """What of its description is not used."""
        return self._stack.axes.note

    @property
    def chunk_depth(self) -> int:
        """Each slice is read by itself."""
        return 1

    def slices(self, first: int, count: int) -> NDArray[Any]:
        """Read some slices; bool becomes uint8, and what has no value is 0."""
        stack = self._stack
        _, height, width = self.shape
        with decoding(self.name, "TIFF"):
            if stack.step is not None:
                values = self._mapped(first, count)
            else:
                values = np.empty((count, height, width), stack.pages[0].dtype)
                threads = 0 if values.nbytes >= _WORTH_THREADS else 1

                def put(index: int) -> None:
                    values[index] = decode_band(stack.pages[first + index], self._read, 0, height)

                for _ in in_order(put, range(count), threads):
                    pass
        values = plain_values(values)
        missing = missing_values(values, stack.nodata)
        return values if missing is None else np.where(missing, values.dtype.type(0), values)

    def _mapped(self, first: int, count: int) -> NDArray[Any]:
        """A view of the file."""
        stack = self._stack
        page = stack.pages[first]
        assert page.dtype is not None
        assert stack.step is not None
        return np.ndarray(
            (count, page.height, page.width),
            page.dtype.newbyteorder(page.byte_order),
            self._bytes,
            int(page.offsets[0]),
            (stack.step, page.row_bytes, page.dtype.itemsize),
        )

    def _read(self, offset: int, size: int) -> bytes:
        return self._bytes[offset : offset + size]

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is open."""
        return {"name": self.name, "path": self.path, "spool": None}


def _full_pages(file: Any) -> Iterator[Any]:
    """Pages that are no smaller copies of others."""
    for index, page in enumerate(file.pages):
        if index == 0 or not page.is_reduced:
            yield page


def _count_of(name: str, axes: StackAxes, pages: int) -> int:
    if axes.slices not in (None, pages):
        raise InputError(f"{name} has {pages} pages, but its description states {axes.slices} slices: is it cut off?")
    return pages


def _check_values(layout: TiffLayout, page: Any) -> None:
    """Refuse what is no single number a voxel."""
    name = layout.name
    if layout.samples != 1:
        raise InputError(
            f"{name} has {layout.samples} values per pixel: a volume has one; save one channel, or a label image, alone"
        )
    if not is_decoded_here(layout):
        compression = getattr(page.compression, "name", str(page.compression))
        raise InputError(
            f"{name} holds {page.dtype} in {compression} compression, which is not read slice by slice: save it with "
            "deflate, LZW, zstd or no compression, as integers or floating-point numbers"
        )


def _alike(name: str, size: int, first: TiffLayout, pages: Sequence[Any], order: Iterable[int]) -> Iterator[TiffLayout]:
    """The layout of each slice; all are of one size and type."""
    for index in order:
        layout = page_layout(name, size, pages[index])
        _check_values(layout, pages[index])
        if _kind_of(layout) != _kind_of(first):
            one, other = map(_words, (first, layout))
            raise InputError(
                f"{name} has pages that differ, {one} on page 0 and {other} on page {index}: slices of a volume are of "
                f"one size and type; choose a page with {option('--page N', 'page=N')}"
            )
        yield layout


def _kind_of(layout: TiffLayout) -> tuple[int, int, Any]:
    return layout.width, layout.height, layout.dtype


def _words(layout: TiffLayout) -> str:
    return f"{layout.width} x {layout.height} {layout.dtype}"


def _behind_each_other(layout: TiffLayout, slices: int, size: int) -> Sequence[TiffLayout]:
    """Slices that only the first page describes, as ImageJ writes them beyond 4 GiB."""
    each = layout.height * layout.row_bytes
    if not layout.is_one_array:
        raise InputError(f"{layout.name} has 1 page, but its description states {slices} slices: is it cut off?")
    end = int(layout.offsets[0]) + slices * each
    if end > size:
        raise InputError(f"{layout.name} is cut off after {size} bytes: its {slices} slices end at byte {end}")
    return [replace(layout, offsets=layout.offsets + index * each) for index in range(slices)]


def _step_of(pages: Sequence[TiffLayout]) -> int | None:
    """Bytes from slice to slice, where a view of the file has them all."""
    if not all(page.is_one_array for page in pages):
        return None
    steps = {int(after.offsets[0] - before.offsets[0]) for before, after in pairwise(pages)}
    return 0 if not steps else steps.pop() if len(steps) == 1 else None
