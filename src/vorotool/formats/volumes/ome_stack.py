"""OME-XML of stacks: how many slices there are, on which pages they are, and how large a voxel is."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

from vorotool.errors import InputError
from vorotool.formats.images.ome_xml import decimal_side, parse_ome
from vorotool.formats.volumes.source import refuse_axes
from vorotool.numeric.length_units import ratio
from vorotool.types.volumes.voxel_frame import VoxelGrid

PIXEL = "pixel"
"""What OME calls a length that is in no unit."""

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
            first, page = (_whole(name, plane.get(key, "0"), key) for key in ("FirstZ", "IFD"))
            planes = _whole(name, plane.get("PlaneCount", "1" if "IFD" in plane else str(depth)), "PlaneCount")
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
        size = _whole(name, self.attributes.get(f"Size{axis}", "1"), f"Size{axis}")
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


def _whole(name: str, text: str, what: str) -> int:
    plain = text.strip()
    if not (plain.isascii() and plain.isdecimal() and len(plain) <= _MOST_DIGITS):
        raise InputError(f"{name} is damaged: its {what} is {text[:40]!r}, which is not an integer")
    return int(plain)
