"""TIFF files as volumes: a page is a slice, read only when it is looked at; what ImageJ and OME say of the stack."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, option
from vorotool.formats.images.image_grids import grid_of, missing_values, side_of_imagej, unescaped
from vorotool.formats.images.ome_xml import PIXEL, decimal_side, parse_ome
from vorotool.formats.images.tiff_layout import TiffLayout, decode_rows, is_decoded_here
from vorotool.formats.images.tiff_reader import opened_tiff, page_layout
from vorotool.formats.io.arrays import plain_values
from vorotool.formats.io.sources import decoding
from vorotool.formats.volumes.source import VolumeSource, mapped, refuse_axes
from vorotool.frozen import frozen
from vorotool.numeric.length_units import ratio
from vorotool.numeric.parallel import in_order
from vorotool.types.values import counted
from vorotool.types.volumes.volume import VoxelGrid

_WORTH_THREADS = 2**20
"""Bytes of slices from which threads take less time than they cost."""


@frozen
class _Stack:
    """Where the voxels are."""

    pages: Sequence[TiffLayout]
    axes: StackAxes  # what the file says of them
    nodata: float | None  # voxels with this value have none
    step: int | None  # bytes from slice to slice where each is one array and they are equally far apart


@frozen
class TiffStack(VolumeSource):
    """The slices of a TIFF file with one value a pixel."""

    @cached_property
    def _stack(self) -> _Stack:
        size = len(self._bytes)
        with opened_tiff(self.name, self.path) as file, decoding(self.name, "TIFF"):
            pages = [page for index, page in enumerate(file.pages) if index == 0 or not page.is_reduced]
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
    def stored_dtype(self) -> np.dtype[Any]:
        """Type of the values in the file."""
        kind = self._stack.pages[0].dtype
        assert kind is not None
        return kind

    @property
    def grid(self) -> VoxelGrid | None:
        """Sides of the voxels."""
        return self._stack.axes.grid

    @property
    def note(self) -> str:
        """What of its description is not used."""
        return self._stack.axes.note

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
                    values[index] = decode_rows(stack.pages[first + index], self._read, 0, height)[:, :, 0]

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


def _count_of(name: str, axes: StackAxes, pages: int) -> int:
    if axes.slices not in (None, pages):
        advice = (
            "is it cut off?" if pages < (axes.slices or 0) else f"choose a page with {option('--page N', 'page=N')}"
        )
        raise InputError(
            f"{name} has {pages} pages, but its description states {counted(axes.slices or 0, 'slice')}: {advice}"
        )
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


# ---- what ImageJ and tifffile say of a stack -----------------------------------------------------
_NO_UNIT = 1
"""Of resolution."""

_NAMES = {"T": "time steps", "C": "channels", "S": "samples"}
_MOST_IMAGES = 2**31


@frozen
class StackAxes:
    """A stack as a file describes it."""

    slices: int | None = None  # how many there are, where it says so
    pages: tuple[int, ...] | None = None  # of each slice; by default they come in order
    grid: VoxelGrid | None = None
    note: str = ""  # what of it is not used


def stack_axes(name: str, file: Any, count: int) -> StackAxes:
    """Read what the first page of a file of so many pages says of all of them."""
    if file.is_ome:
        stack = ome_stack(file.pages[0].description)
        if stack is not None:
            pages = stack.pages(name, count)
            return StackAxes(len(pages), pages, stack.grid(), stack.note(name))
    if file.is_imagej:
        return _of_imagej(name, file.imagej_metadata or {}, file.pages[0])
    if file.is_shaped:
        return StackAxes(_slices_of_shape(name, _shape_of(file.pages[0].shaped_description)))
    return StackAxes()


def _of_imagej(name: str, said: Mapping[str, Any], page: Any) -> StackAxes:
    numbers = {key: _whole(name, said.get(key, 1), key) for key in ("images", "channels", "slices", "frames")}
    refuse_axes(name, {"channels": numbers["channels"], "time steps (frames)": numbers["frames"]})
    slices = numbers["images"] if "images" in said else numbers["slices"]
    return StackAxes(slices, None, _imagej_grid(said, page))


def _whole(name: str, value: Any, key: str) -> int:
    if type(value) is not int or not 0 < value < _MOST_IMAGES:
        raise InputError(
            f"{name} is damaged: its description states {key}={value!r:.40}, which is not a number of images"
        )
    return value


def _imagej_grid(said: Mapping[str, Any], page: Any) -> VoxelGrid | None:
    """Sides of the voxels: ImageJ has pixels a unit in the resolution, and the distance of slices as ``spacing``."""
    named = unescaped(str(said.get("unit", ""))).strip()
    unit = None if named in ("", "pixel", "pixels") else named
    width = height = Fraction(1)
    ratios = [page.tags.valueof(tag) for tag in ("XResolution", "YResolution")]
    is_used = unit is not None or page.tags.valueof("ResolutionUnit", default=2) == _NO_UNIT
    if is_used and all(_is_ratio(each) for each in ratios):
        width, height = (side_of_imagej(*each) for each in ratios)
    depth = decimal_side(str(said.get("spacing", 1)).removeprefix("-")) or Fraction(1)
    if unit is None and width == height == depth == 1:
        return None
    return VoxelGrid(width, height, depth, unit, "imagej")


def _is_ratio(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 2 and all(type(each) is int and each > 0 for each in value)


def _shape_of(text: str) -> Mapping[str, Any]:
    """Read what tifffile wrote; it would do so itself only with all pages, and with all below them."""
    said = json.loads(text) if text.startswith("{") else {}
    return said if isinstance(said, dict) else {}


def _slices_of_shape(name: str, said: Mapping[str, Any]) -> int | None:
    """Slices of what tifffile wrote: it tells the shape of the array, and axes where its user did."""
    shape, axes = said.get("shape"), said.get("axes")
    if not isinstance(shape, list) or len(shape) < 2 or not all(type(side) is int and side > 0 for side in shape):
        return None
    if isinstance(axes, str) and len(axes) == len(shape):
        refuse_axes(name, {_NAMES[axis]: side for axis, side in zip(axes, shape, strict=True) if axis in _NAMES})
    leading: list[int] = [side for side in shape[:-2] if side > 1]
    if len(leading) > 1:
        raise InputError(
            f"{name} has the shape {tuple(shape)}: a volume has three axes; save a part of it that has three"
        )
    return prod(leading)


# ---- OME -----------------------------------------------------------------------------------------
_NO_LENGTH = "reference frame"
_MOST_DIGITS = 12
_MOST_REPEATS = 4
"""How often a slice may be given a page: once, but for careless writers."""


@dataclass
class OmeStack:
    """The image of an OME-TIFF."""

    attributes: dict[str, str] = field(default_factory=dict)
    planes: list[dict[str, str]] = field(default_factory=list)
    files: set[str] = field(default_factory=set)  # that hold its planes, as far as they are named
    images: int = 0  # how many images there are; this is the first

    def pages(self, name: str, count: int) -> tuple[int, ...]:
        """Give the page of each slice, of a file of so many pages."""
        if self.images > 1:
            raise InputError(f"{name} holds {self.images} images of OME: save one of them alone, or name its pages")
        if len(self.files) > 1:
            raise InputError(
                f"{name} has its planes in {len(self.files)} files, such as {min(self.files)}: save them in one, for "
                "example with bfconvert"
            )
        refuse_axes(name, {"channels": self._size(name, "C"), "time steps": self._size(name, "T")})
        depth = self._size(name, "Z")
        if depth > count:
            raise InputError(f"{name} has {count} pages, but its XML states {depth} slices")
        if not self.planes:
            return tuple(range(depth))
        place: dict[int, int] = {}
        stated = 0
        for plane in self.planes:
            first, page = (_whole_text(name, plane.get(key, "0"), key) for key in ("FirstZ", "IFD"))
            planes = _whole_text(name, plane.get("PlaneCount", "1" if "IFD" in plane else str(depth)), "PlaneCount")
            stated += min(planes, depth)
            if stated > _MOST_REPEATS * depth:
                raise InputError(
                    f"{name} is damaged: its XML has {len(self.planes)} TiffData, which name the pages of its {depth} "
                    f"slices more than {_MOST_REPEATS} times"
                )
            place |= {first + k: page + k for k in range(min(planes, depth))}
        missing = next((k for k in range(depth) if not 0 <= place.get(k, -1) < count), None)
        if missing is not None:
            raise InputError(
                f"{name} has no page for slice {missing}, counted from 0: its XML names no page that exists"
            )
        return tuple(place[k] for k in range(depth))

    def _size(self, name: str, axis: str) -> int:
        size = _whole_text(name, self.attributes.get(f"Size{axis}", "1"), f"Size{axis}")
        if not size:
            raise InputError(f"{name} is damaged: its Size{axis} is 0")
        return size

    def grid(self) -> VoxelGrid | None:
        """Sides of the voxels; None where not all three are stated in units that can be compared."""
        sides = self._sides()
        if len(sides) < 3:
            return None
        (width, unit), others = sides["X"], [sides["Y"], sides["Z"]]
        factors = [ratio(each, unit) for _, each in others]
        if None in factors or any(each == _NO_LENGTH for _, each in sides.values()):
            return None
        height, depth = (side * (factor or 1) for (side, _), factor in zip(others, factors, strict=True))
        return VoxelGrid(width, height, depth, None if unit == PIXEL else unit, "ome")

    def note(self, name: str) -> str:
        """Say that the depth of a voxel is missing where the rest is there."""
        sides = self._sides()
        if "Z" in sides or "X" not in sides:
            return ""
        return f"{name} states the width of its voxels, but not their depth: it has no PhysicalSizeZ"

    def _sides(self) -> dict[str, tuple[Fraction, str]]:
        """Sides by axes, each with its unit."""
        found: dict[str, tuple[Fraction, str]] = {}
        for axis in "XYZ":
            side = decimal_side(self.attributes.get(f"PhysicalSize{axis}", ""))
            if side is not None:
                found[axis] = (side, self.attributes.get(f"PhysicalSize{axis}Unit", "µm"))
        return found


def ome_stack(text: str) -> OmeStack | None:
    """Read the description of an OME-TIFF; None where it describes no image."""
    stack = OmeStack()

    def start(name: str, attributes: dict[str, str]) -> None:
        if name == "Pixels":
            stack.images += 1
            stack.attributes = stack.attributes or attributes
        elif stack.images == 1 and name == "TiffData":
            stack.planes.append(attributes)
        elif stack.images == 1 and name == "UUID" and "FileName" in attributes:
            stack.files.add(attributes["FileName"])

    return stack if parse_ome(text, start) and stack.images else None


def _whole_text(name: str, text: str, what: str) -> int:
    plain = text.strip()
    if not (plain.isascii() and plain.isdecimal() and len(plain) <= _MOST_DIGITS):
        raise InputError(f"{name} is damaged: its {what} is {text[:40]!r}, which is not an integer")
    return int(plain)
