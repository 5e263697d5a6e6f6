"""Sizes that JPEG pictures state, and by which they would be decoded: within a TIFF for themselves."""

from __future__ import annotations

from vorotool.errors import InputError
from vorotool.formats.images.tiff_layout import TiffLayout

_LARGEST_UNIT = 32
"""Pixels: 8 x 8 values, of up to 4 x 4 pixels each; a picture is filled up to whole units."""


def check_jpegs(layout: TiffLayout, data: bytes) -> None:
    """Refuse pictures that are larger than the strip or tile that they fill."""
    wide, high = (-(-side // _LARGEST_UNIT) * _LARGEST_UNIT for side in (layout.columns, layout.rows))
    for index, (offset, count) in enumerate(zip(layout.offsets, layout.counts, strict=True)):
        _, width, height = jpeg_frame(data[offset : offset + count])
        if width > wide or height > high:
            raise InputError(
                f"{layout.name} is damaged: {layout.kind} {index} holds a JPEG of {width} x {height} pixels, but has "
                f"room for {layout.columns} x {layout.rows}"
            )


def jpeg_frame(data: bytes) -> tuple[int, int, int]:
    """Marker, width and height of the first frame header; zeros if there is none."""
    at = 2
    while at + 9 <= len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if marker == 0xFF:  # fills
            at += 1
        elif 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            return marker, int.from_bytes(data[at + 7 : at + 9], "big"), int.from_bytes(data[at + 5 : at + 7], "big")
        else:
            at += 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return 0, 0, 0
