"""A look at the tags of a TIFF before tifffile reads them: it calculates with what it finds, numbers or not."""

from __future__ import annotations

import struct
from typing import BinaryIO

from vorotool.errors import InputError

_NUMBERS = {
    256: "ImageWidth",
    257: "ImageLength",
    259: "Compression",
    262: "PhotometricInterpretation",
    266: "FillOrder",
    277: "SamplesPerPixel",
    284: "PlanarConfiguration",
    317: "Predictor",
    322: "TileWidth",
    323: "TileLength",
    32997: "ImageDepth",
    32998: "TileDepth",
}
"""Tags of one whole number."""

_WHOLE = {1, 3, 4, 6, 8, 9, 13, 16, 17, 18}
"""Types of whole numbers: BYTE, SHORT, LONG, those with a sign, those of 8 bytes, and offsets."""

_MOST_TAGS = 4096
_FIRST_BYTES = {b"II*\0": "<", b"MM\0*": ">", b"II+\0": "<", b"MM\0+": ">"}


def check_tags(name: str, file: BinaryIO) -> None:
    """Refuse tags that should be one whole number and are not; the file is left at its beginning.

    Raises
    ------
    InputError
        If there is one; it is named.
    """
    head = file.read(16)
    order = _FIRST_BYTES.get(head[:4])
    if order is not None:
        is_big = b"+" in head[2:4]
        place = struct.unpack_from(f"{order}{'Q' if is_big else 'I'}", head.ljust(16, b"\0"), 8 if is_big else 4)[0]
        seen: set[int] = set()
        while place and place not in seen:
            seen.add(place)
            place = _check_directory(name, file, place, order, is_big)
    file.seek(0)


def _check_directory(name: str, file: BinaryIO, place: int, order: str, is_big: bool) -> int:
    """Check the tags of a page; where the next page begins, 0 behind the last."""
    count_form, entry_form, next_form = ("Q", "HHQ8x", "Q") if is_big else ("H", "HHI4x", "I")
    entries = struct.Struct(order + entry_form)
    count = _number(file, place, order + count_form)
    if not 0 < count <= _MOST_TAGS:
        return 0
    start = place + struct.calcsize(order + count_form)
    file.seek(start)
    data = file.read(count * entries.size)
    for tag, kind, values in entries.iter_unpack(data[: len(data) // entries.size * entries.size]):
        if tag in _NUMBERS and (values != 1 or kind not in _WHOLE):
            raise InputError(
                f"{name} is damaged: its {_NUMBERS[tag]} has {values} values of type {kind}, "
                "which are not one whole number"
            )
    return _number(file, start + count * entries.size, order + next_form)


def _number(file: BinaryIO, place: int, form: str) -> int:
    """A number of the file; 0 where it ends before."""
    if place >= 2**62:
        return 0
    file.seek(place)
    data = file.read(struct.calcsize(form))
    return int(struct.unpack(form, data)[0]) if len(data) == struct.calcsize(form) else 0
