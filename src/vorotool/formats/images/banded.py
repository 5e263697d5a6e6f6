"""Images that can be read band by band: what reads them is imported once there is one."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from vorotool.errors import InputError, option
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.zarr.store import is_folder, is_store

if TYPE_CHECKING:
    from vorotool.formats.images.band_reader import TiffRows, ZarrRows

TIFF_MAGIC = (b"II*\x00", b"MM\x00*", b"II+\x00", b"MM\x00+")


def open_tiff(name: str, input_format: str | None = None, page: int | None = None) -> TiffRows | None:
    """Open a page of a TIFF file that can be read band by band; None if it is none, or comes through a stream."""
    if input_format not in (None, "tiff") or not _begins_as_tiff(name):
        return None
    from vorotool.formats.images.band_reader import TiffRows

    rows = TiffRows(name, str(Path(name).absolute()), page)
    return rows if rows.is_plain else None


def _begins_as_tiff(name: str) -> bool:
    """Whether a file begins as a TIFF does; streams, which have one beginning only, are read whole elsewhere."""
    try:
        if stream_kind(name) is not None:
            return False
        with Path(name).open("rb") as file:
            return file.read(4) in TIFF_MAGIC
    except (OSError, ValueError):  # who reads it says why
        return False


def open_zarr(name: str, input_format: str | None = None, page: int | None = None) -> ZarrRows | None:
    """Open what is, or should be, a Zarr array: a folder that holds one, or is named or said to; None if it is none."""
    if input_format not in (None, "zarr") or not is_folder(name):
        return None
    if input_format is None and not is_store(name) and not name.rstrip(os.sep).lower().endswith(".zarr"):
        return None
    if page not in (None, 0):
        raise InputError(f"{name} has a single page: {option(f'--page {page}')} does not exist")
    from vorotool.formats.images.band_reader import ZarrRows

    return ZarrRows(name, str(Path(name).absolute()))
