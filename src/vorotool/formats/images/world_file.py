"""World files: six numbers in a text file beside an image, which place it on a map."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from pathlib import Path

from vorotool.errors import InputError
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.sources import STANDARD_INPUT
from vorotool.types.pixels import PixelGrid, Transform, map_grid

_LARGEST = 4096
"""Bytes; six numbers need some hundred."""


def world_grid(name: str) -> PixelGrid | None:
    """Read the grid of an image from the world file beside it; None where there is none, or the image is a stream."""
    if name == STANDARD_INPUT or stream_kind(name) is not None:
        return None
    for path in _candidates(Path(name)):
        try:
            with path.open("rb") as file:
                data = file.read(_LARGEST + 1)
        except (OSError, ValueError):
            continue
        return _parsed(str(path), data)
    return None


def world_text(transform: Transform) -> bytes:
    """Write the six numbers of a world file, whose place is that of the center of the first pixel."""
    a, b, x, d, e, y = map(float, transform)
    numbers = (a, d, b, e, x + (a + b) / 2, y + (d + e) / 2)
    return "".join(f"{number!r}\n" for number in numbers).encode("ascii")


def _candidates(image: Path) -> Iterator[Path]:
    letters = image.suffix[1:]
    endings = [f"{letters[0]}{letters[-1]}w", f"{letters}w"] if letters else []
    for ending in dict.fromkeys([*endings, "wld"]):
        for each in dict.fromkeys((ending.lower(), ending.upper())):
            yield image.with_suffix(f".{each}")


def _parsed(name: str, data: bytes) -> PixelGrid:
    try:
        numbers = [float(text) for text in data.decode("ascii").replace(",", ".").split()]
    except ValueError:
        numbers = []
    if len(data) > _LARGEST or len(numbers) != 6 or not all(map(isfinite, numbers)):
        raise InputError(
            f"{name} is not a world file: it should have six lines of one number each; correct or remove it"
        )
    a, d, b, e, x, y = numbers  # the place is that of the center of the first pixel
    if a * e == b * d:
        raise InputError(f"{name} states pixels without an area: correct or remove it")
    return map_grid((a, b, x - (a + b) / 2, d, e, y - (d + e) / 2))
