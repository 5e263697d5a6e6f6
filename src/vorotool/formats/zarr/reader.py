"""Reading Zarr arrays chunk by chunk, from folders."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.zarr.codecs import overlap, places_within
from vorotool.formats.zarr.metadata import ZarrMetadata, array_metadata, read_metadata
from vorotool.geometry.parallel import in_order

_WORTH_THREADS = 2**20
"""Bytes from which threads take less time than they cost."""


class StoredArray:
    """An array in a folder, of format 2 or 3; its values are read when they are asked for.

    Parameters
    ----------
    name : str
        For messages.
    path : str or path
        The folder.

    Raises
    ------
    InputError
        If there is no array, or it is stored in a way that is not known.
    """

    def __init__(self, name: str, path: str | os.PathLike[str]) -> None:
        made = read_metadata(path)
        if made is None or made.get("node_type") != "array":
            raise InputError(f"{name} holds no Zarr array")
        self.folder = Path(path)
        self.metadata: ZarrMetadata = array_metadata(name, made)
        self._rows: frozenset[int] | None = None  # rows of chunks of which some are stored, when they have been listed

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of each axis."""
        return self.metadata.shape

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the values, in the order of bytes of this machine."""
        return self.metadata.pipeline.dtype.newbyteorder("=")

    def read(self, region: tuple[slice, ...], *, threads: int = 0) -> NDArray[Any]:
        """Read a region: each slice has a start and a stop within its axis.

        Raises
        ------
        ValueError
            If a chunk is damaged.
        """
        chunk = self.metadata.pipeline.shape
        result = np.empty([part.stop - part.start for part in region], self.dtype)

        def put(place: tuple[int, ...]) -> None:
            target, source = overlap(region, place, chunk)
            data = self._chunk(place)
            if data is None:
                result[target] = self.metadata.pipeline.fill
            else:
                result[target] = self.metadata.pipeline.decoded(data, source)

        for _ in in_order(put, places_within(region, chunk), 1 if result.nbytes < _WORTH_THREADS else threads):
            pass
        return result

    def _chunk(self, place: tuple[int, ...]) -> bytes | None:
        """Bytes of a chunk; None if it is left out.

        The first that is left out has the folder listed: a sparse array may lack millions of rows of chunks.
        """
        if place and self._rows is not None and place[0] not in self._rows:
            return None
        key, most = self.metadata.key(place), self.metadata.pipeline.most_bytes
        path = self.folder / key
        try:
            status = path.stat()
        except FileNotFoundError:
            if self._rows is None:
                self._rows = self._stored_rows()
            return None
        if not stat.S_ISREG(status.st_mode) or status.st_size > most:
            raise ValueError(f"chunk {key} is no file of at most {most} bytes")
        return path.read_bytes()

    def _stored_rows(self) -> frozenset[int]:
        """Numbers of the rows of chunks of which some may be stored."""
        within, start = os.path.split(self.metadata.prefix)
        try:
            with os.scandir(self.folder / within) as entries:
                names = (entry.name.removeprefix(start).split(self.metadata.separator)[0] for entry in entries)
                return frozenset(int(name) for name in names if name.isascii() and name.isdigit())
        except FileNotFoundError:
            return frozenset()
