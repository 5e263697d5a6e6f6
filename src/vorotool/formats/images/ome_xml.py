"""The sizes of pixels in OME-XML, which a parser without entities reads, and the XML of a single image."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

import numpy as np

from vorotool.numeric.length_units import ratio
from vorotool.numeric.numbers import shown_number

LARGEST_XML = 2**25
"""Bytes that are parsed at most; of an image with many planes they are some millions."""

PIXEL = "pixel"
"""What OME calls a length that is in no unit."""

_SIZES = ("PhysicalSizeX", "PhysicalSizeY")
_TYPES = {"uint8", "uint16", "uint32", "int8", "int16", "int32"}

_XML = (
    '<?xml version="1.0" encoding="UTF-8"?>'
    '<OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06" '
    'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation='
    '"http://www.openmicroscopy.org/Schemas/OME/2016-06 http://www.openmicroscopy.org/Schemas/OME/2016-06/ome.xsd">'
    '<Image ID="Image:0"><Pixels ID="Pixels:0" DimensionOrder="XYCZT" Type="{type}" SizeX="{width}" SizeY="{height}" '
    'SizeC="1" SizeZ="{depth}" SizeT="1"{sides}>'
    '<Channel ID="Channel:0:0" SamplesPerPixel="1"/><TiffData IFD="0" PlaneCount="{depth}"/>'
    "</Pixels></Image></OME>"
)


class _Refused(Exception):  # noqa: N818, nothing is wrong with the image
    """What is no OME-XML that is read."""


def ome_sizes(text: str) -> tuple[Fraction, Fraction, str] | None:
    """Read both sides of a pixel and their unit; None where they are not stated, or not the same for all images."""
    found = {_sizes_of(attributes) for attributes in _pixels_of(text)}
    return found.pop() if len(found) == 1 else None


def states_one_side(text: str) -> str:
    """Return the name of the one side of a pixel that is stated where the other is not; empty where both are."""
    found = {each for attributes in _pixels_of(text) for each in _SIZES if each in attributes}
    return found.pop() if len(found) == 1 else ""


def _pixels_of(text: str) -> list[dict[str, str]]:
    """Read the attributes of all images, none where the text is not safe XML."""
    found: list[dict[str, str]] = []

    def start(name: str, attributes: dict[str, str]) -> None:
        if name == "Pixels":
            found.append(attributes)

    return found if parse_ome(text, start) else []


def parse_ome(text: str, start: Callable[[str, dict[str, str]], None]) -> bool:
    """Call a function with the name and the attributes of each element; return whether the text is safe XML."""
    from xml.parsers import expat

    def refuse(*_: Any) -> None:
        raise _Refused

    data = text.encode("utf-8", "replace")
    if len(data) > LARGEST_XML:
        return False
    parser = expat.ParserCreate("utf-8")
    parser.StartDoctypeDeclHandler = refuse
    parser.StartElementHandler = lambda name, attributes: start(name.rpartition(":")[2], attributes)
    try:
        parser.Parse(data, True)
    except (expat.ExpatError, _Refused):
        return False
    return True


def _sizes_of(attributes: dict[str, str]) -> tuple[Fraction, Fraction, str] | None:
    """Sides of the pixels of one image, in the unit of the width; one that is not stated is that of a square."""
    stated = {
        name: (side, attributes.get(f"{name}Unit", "µm"))
        for name in _SIZES
        if (side := decimal_side(attributes.get(name, ""))) is not None
    }
    if not stated or any(name in attributes and name not in stated for name in _SIZES):
        return None
    either = next(iter(stated.values()))
    (width, unit), (height, other) = (stated.get(name, either) for name in _SIZES)
    factor = ratio(other, unit)
    if factor is None or unit in ("pixel", "reference frame"):
        return None
    return width, height * factor, unit


def decimal_side(text: str) -> Fraction | None:
    """Give the side of a pixel that a text states, exactly; None if it states none."""
    try:
        if not 1e-100 < float(text) < 1e100:
            return None
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        return None


def ome_xml(shape: tuple[int, int], dtype: np.dtype[Any], width: Fraction, height: Fraction, unit: str) -> bytes | None:
    """Write the XML of one image of one channel; None where OME has no such type of pixels."""
    return ome_document((1, *shape), dtype, {"X": width, "Y": height}, unit)


def ome_document(
    shape: tuple[int, int, int], dtype: np.dtype[Any], sides: Mapping[str, Fraction], unit: str
) -> bytes | None:
    """Write the XML of slices that are the pages of a file, in order; None where OME has no such type of pixels."""
    from xml.sax.saxutils import quoteattr  # imports urllib and http, which take a tenth of a short run

    kind = ome_type(dtype)
    if kind is None:
        return None
    depth, height, width = shape
    told = "".join(
        f' PhysicalSize{axis}="{shown_side(side)}" PhysicalSize{axis}Unit={quoteattr(unit)}'
        for axis, side in sides.items()
    )
    values = {"type": kind, "width": width, "height": height, "depth": depth, "sides": told}
    return _XML.format(**values).encode("ascii", "xmlcharrefreplace")


def ome_type(dtype: np.dtype[Any]) -> str | None:
    """Give the name that OME has for a type of pixels; None where it has none."""
    kind = "float" if dtype == np.float32 else dtype.name
    return kind if kind == "float" or kind in _TYPES else None


def shown_side(side: Fraction) -> str:
    """Write the side of a pixel in decimal digits, with which a double is found again."""
    return shown_number(float(side)).removesuffix(".0")
