"""How many images a file holds."""

from __future__ import annotations

import io
from pathlib import Path

from vorotool.errors import VorotoolError
from vorotool.formats.images.magic import picture_format
from vorotool.formats.images.picture_reader import picture_pages
from vorotool.formats.images.tiff_reader import count_pages, opened_tiff
from vorotool.formats.io.limits import decoding
from vorotool.formats.io.sources import GZIP, Source, read_source
from vorotool.formats.recognition import image_format

_HEAD = 4096
"""Bytes that tell the format."""


def page_count(path: str) -> int | None:
    """Count the pages of a TIFF or the pictures of an animation; other images have one, and what is none has none."""
    try:
        if Path(path).is_dir():
            return 1
        with Path(path).open("rb") as file:
            head = file.read(_HEAD)
        source = read_source(path) if head.startswith(GZIP) else Source(path, head)
        kind = image_format(source)
        if kind == "tiff":
            content = io.BytesIO(source.data) if source.is_unpacked else path
            with opened_tiff(path, content) as tiff, decoding(path, "TIFF"):
                return max(1, count_pages(tiff))
        if kind is not None and picture_format(source.data) == kind:
            return picture_pages(source if source.is_unpacked else read_source(path), kind)
        return None if kind is None else 1
    except (OSError, ValueError, VorotoolError):
        return 1
