"""PBM, PGM and PPM files, with the values as stored.

Pillow, and so imageio, spread them over the full range: ``P2 3 1 9 1 5 9`` is read as 28, 142, 255, and of colors of
more than 8 bits the lower ones are lost (`tests/benchmarks/libraries.py pnm`).
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.limits import check_pixels
from vorotool.formats.io.sources import Source
from vorotool.formats.recognition import GAP

_LARGEST_MAXIMUM = 65_535
_HEADERS = {
    True: re.compile(rb"P[14]" + GAP + rb"(\d{1,18})" + GAP + rb"(\d{1,18})()(?:\s|(?=#)|$)"),
    False: re.compile(rb"P[2356]" + (GAP + rb"(\d{1,18})") * 3 + rb"(?:\s|(?=#)|$)"),
}
_COMMENT = re.compile(rb"#[^\n\r]*")


class PnmHeader(NamedTuple):
    """Kind (1 to 6), size, largest value, and where the pixels begin."""

    kind: int
    width: int
    height: int
    maximum: int
    offset: int


def pnm_header(source: Source) -> PnmHeader:
    """Read the header alone."""
    start = source.data[:65_536]
    kind = start[1] - ord("0") if re.match(rb"P[1-6]", start) else 0
    match = _HEADERS[kind in (1, 4)].match(start)
    if match is None:
        raise InputError(
            f"{source.name} has no complete PBM, PGM or PPM header: P1 to P6, width, height, largest value"
        )
    maximum = int(match[3] or 1)
    if not 1 <= maximum <= _LARGEST_MAXIMUM:
        raise InputError(
            f"{source.name} states {maximum} as the largest value: it must be from 1 to {_LARGEST_MAXIMUM}"
        )
    return PnmHeader(kind, int(match[1]), int(match[2]), maximum, match.end())


def read_pnm(source: Source, max_pixels: int) -> NDArray[Any]:
    """Return (H, W), or (H, W, 3) values of type uint8, or uint16 where the largest value needs it."""
    header = pnm_header(source)
    check_pixels(source.name, header.width, header.height, max_pixels)
    channels = 3 if header.kind in (3, 6) else 1
    values = (_packed if header.kind > 3 else _written)(source, header, channels * header.width)
    above = np.flatnonzero(values > header.maximum)
    if above.size:
        row, column = divmod(int(above[0]) // channels, header.width)
        raise InputError(
            f"{source.name} has {values[above[0]]} in row {row}, column {column}, "
            f"above its largest value {header.maximum}"
        )
    values = values.astype(np.uint8 if header.maximum < 256 else np.uint16, copy=False)
    return values.reshape(header.height, header.width, *([3] if channels == 3 else []))


def _packed(source: Source, header: PnmHeader, columns: int) -> NDArray[Any]:
    """Values of bytes, of P4 of bits."""
    row = -(-columns // 8) if header.kind == 4 else columns
    dtype = np.dtype(np.uint8 if header.maximum < 256 else ">u2")
    needed, present = row * header.height * dtype.itemsize, len(source.data) - header.offset
    if present < needed:
        raise InputError(f"{source.name} is cut off: its pixels need {needed} bytes, it has {present}")
    values = np.frombuffer(source.data, dtype, row * header.height, header.offset)
    return (
        np.unpackbits(values.view(np.uint8).reshape(-1, row), axis=1, count=columns).ravel()
        if header.kind == 4
        else values
    )


def _written(source: Source, header: PnmHeader, columns: int) -> NDArray[Any]:
    """Values of text; of P1 digits, which need no space between them."""
    words = _COMMENT.sub(b" ", source.data[header.offset :]).split()
    if header.kind == 1:
        values: NDArray[Any] = np.frombuffer(b"".join(words), np.uint8) - np.uint8(ord("0"))
    else:
        bad = next((place for place, word in enumerate(words) if not word.isdigit() or len(word) > 18), None)
        if bad is not None:
            word = words[bad][:40].decode("latin-1")
            raise InputError(f"{source.name} has {word!r} as value {bad + 1}: it must be an integer")
        values = np.array(words, dtype="S18").astype(np.int64)
    needed = columns * header.height
    if len(values) < needed:
        raise InputError(f"{source.name} is cut off: it has {len(values)} of {needed} values")
    return values[:needed]
