"""A look at the tags of a TIFF before tifffile reads them: it calculates with what it finds, numbers or not."""

from __future__ import annotations

import io
import struct
from typing import BinaryIO

from vorotool.errors import InputError, LimitError

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

_SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 6: 1, 7: 1, 8: 2, 9: 4, 10: 8, 11: 4, 12: 8, 13: 4, 16: 8, 17: 8, 18: 8}
"""Bytes of a value of each type."""

_READ_AT_ONCE = {258, 270, 273, 277, 279, 282, 283, 305, 324, 325, 330, 338, 339, 347, 513, 514, 530}
_READ_AT_ONCE |= {33628, 42113, 50838, 50839}
"""Tags whose values tifffile reads with the page, wherever they are in the file."""

_UIC1, _UIC2 = 33628, 33629
"""Tags of MetaMorph: of each value of the first one there may be as many as the second one counts."""

_MOST_TAGS = 4096
"""Of a page; tifffile takes one with more for the end of the pages."""

MOST_ENTRIES = 2**21
"""Pages and tags of a file: of each tifffile makes an object."""

_SPARE = 2**24
"""Bytes that may be read from the tags of any file, beyond four times its size: pages may share values."""

_FIRST_BYTES = {b"II*\0": "<", b"MM\0*": ">", b"II+\0": "<", b"MM\0+": ">"}


class _Walk:
    """The chain of the pages of a file, as tifffile follows it."""

    def __init__(self, name: str, file: BinaryIO, order: str, *, is_big: bool) -> None:
        self.name, self.file = name, file
        self.size = file.seek(0, io.SEEK_END)
        self.count_form, entry_form, self.next_form = (
            struct.Struct(order + form) for form in (("Q", "HHQ8x", "Q") if is_big else ("H", "HHI4x", "I"))
        )
        self.entry_form = entry_form
        self.stated = 0  # bytes that are read with the pages so far
        self.entries = 0

    def follow(self, place: int) -> None:
        """Go from page to page, and check the tags of each."""
        seen: dict[int, int] = {}
        while place:
            page = len(seen)
            if place in seen:
                raise InputError(
                    f"{self.name} is damaged: its pages form a cycle, since page {page - 1} is followed by page "
                    f"{seen[place]}; save it again with the program that wrote it"
                )
            if place >= self.size:
                raise InputError(f"{self.name} is cut off after {self.size} bytes: page {page} begins at byte {place}")
            seen[place] = page
            place = self._check_page(place, page)

    def _check_page(self, place: int, page: int) -> int:
        """Check the tags of a page; where the next page begins, 0 behind the last."""
        form = self.entry_form
        self.file.seek(place)
        head = self.file.read(self.count_form.size)
        count = self.count_form.unpack(head)[0] if len(head) == self.count_form.size else 0
        if count > _MOST_TAGS:
            return 0
        length = count * form.size + self.next_form.size
        data = self.file.read(length)
        if len(head) + len(data) < self.count_form.size + length:
            raise InputError(f"{self.name} is cut off after {self.size} bytes, within the tags of page {page}")
        tags = list(form.iter_unpack(data[: count * form.size]))
        for tag, kind, values in tags:
            if tag in _NUMBERS and (values != 1 or kind not in _WHOLE):
                raise InputError(
                    f"{self.name} is damaged: its {_NUMBERS[tag]} has {values} values of type {kind}, which are not "
                    "one integer"
                )
        self.entries += 1 + count
        self.stated += length + self._value_bytes(tags)
        self._check_totals(page)
        return int(self.next_form.unpack_from(data, count * form.size)[0])

    def _value_bytes(self, tags: list[tuple[int, int, int]]) -> int:
        """Count the bytes that are read elsewhere in the file with a page; what ends behind the file is not read."""
        sizes = [(tag, values * _SIZES.get(kind, 1)) for tag, kind, values in tags if tag in _READ_AT_ONCE]
        planes = max((values for tag, _, values in tags if tag == _UIC2), default=0)
        return sum(size * (1 + planes * (tag == _UIC1)) for tag, size in sizes if size <= self.size)

    def _check_totals(self, page: int) -> None:
        if self.entries > MOST_ENTRIES:
            raise LimitError(
                f"{self.name} has more than {page} pages, and their tags are more than {MOST_ENTRIES}: "
                "split it into files of fewer pages"
            )
        if self.stated > 4 * self.size + _SPARE:
            raise InputError(
                f"{self.name} is damaged: it has {self.size} bytes, but the tags of its first {page + 1} pages refer "
                f"to {self.stated}"
            )


def check_tags(name: str, file: BinaryIO) -> None:
    """Follow the chain of pages before tifffile does; the file is left at its beginning."""
    head = file.read(16).ljust(16, b"\0")
    order = _FIRST_BYTES.get(head[:4])
    if order is not None:
        is_big = b"+" in head[2:4]
        place = struct.unpack_from(f"{order}{'Q' if is_big else 'I'}", head, 8 if is_big else 4)[0]
        _Walk(name, file, order, is_big=is_big).follow(place)
    file.seek(0)
