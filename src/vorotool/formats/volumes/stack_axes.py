"""What a TIFF says of its pages as a stack: ImageJ's hyperstacks, OME-XML, and the shapes that tifffile writes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from fractions import Fraction
from math import prod
from typing import Any

from vorotool.errors import InputError
from vorotool.formats.images.ome_xml import decimal_side
from vorotool.formats.images.tiff_grid import side_of_imagej, unescaped
from vorotool.formats.volumes.ome_stack import ome_stack
from vorotool.formats.volumes.source import refuse_axes
from vorotool.plain import plain
from vorotool.types.volumes.voxel_grid import VoxelGrid

_NO_UNIT = 1
"""Of resolution."""

_NAMES = {"T": "time steps", "C": "channels", "S": "samples"}
_MOST_IMAGES = 2**31


@plain
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
