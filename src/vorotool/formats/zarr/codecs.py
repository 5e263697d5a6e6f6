"""Decoding chunks of Zarr arrays, none of them beyond what its values need."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError
from vorotool.formats.compression import unpacking
from vorotool.plain import plain

SPARE = 2**12
"""Bytes that a chunk may have beyond its values before it is undone: headers, and what did not compress."""

BYTES_CODECS: dict[str, unpacking.Unpacker] = {
    "zstd": unpacking.unpack_zstd,
    "gzip": unpacking.unpack_gzip,
    "zlib": unpacking.unpack_zlib,
    "bz2": unpacking.unpack_bz2,
    "lzma": unpacking.unpack_lzma,
    "lz4": unpacking.unpack_lz4,
    "blosc": unpacking.unpack_blosc,
}
"""Compressions by their names."""

_MISSING = 2**64 - 1
_CHECKSUM_BYTES = 4


@plain
class Compression:
    """One of `BYTES_CODECS`."""

    name: str

    def decoded(self, data: bytes, most: int) -> bytes:
        """Undo it."""
        unpacked: bytes = BYTES_CODECS[self.name](data, most)
        if len(unpacked) > most:
            raise ValueError(f"a chunk unpacks to more than {most} bytes, which is more than its values need")
        return unpacked


@plain
class Checksum:
    """CRC-32C in the last four bytes."""

    def decoded(self, data: bytes, most: int) -> bytes:
        """Check and drop it."""
        try:
            import google_crc32c
        except ImportError:
            raise UsageError("checksums of Zarr stores need google-crc32c: pip install 'vorotool[zarr]'") from None
        body, stated = data[:-_CHECKSUM_BYTES], data[-_CHECKSUM_BYTES:]
        if google_crc32c.value(bytes(body)) != int.from_bytes(stated, "little"):
            raise ValueError("a chunk has a wrong checksum")
        return body


@plain
class Shuffle:
    """Bytes of values apart: all first ones, all second ones, and so on."""

    size: int

    def decoded(self, data: bytes, most: int) -> bytes:
        """Undo it."""
        whole = len(data) // self.size * self.size
        mixed = np.frombuffer(data, np.uint8, whole).reshape(self.size, -1).T
        return mixed.tobytes() + bytes(data[whole:])


@plain
class Delta:
    """Differences of values."""

    dtype: np.dtype[Any]
    stored: np.dtype[Any]

    def decoded(self, data: bytes, most: int) -> bytes:
        """Undo it."""
        return np.cumsum(np.frombuffer(data, self.stored), dtype=self.dtype).astype(self.dtype).tobytes()


Codec = Compression | Checksum | Shuffle | Delta


@plain
class Pipeline:
    """How values become the bytes of a chunk."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    fill: Any  # of what is left out
    orders: tuple[tuple[int, ...], ...]  # orders of axes in which the values are laid down, one after the other
    shard: Shard | None  # if the chunk is made of smaller ones
    codecs: tuple[Codec, ...]  # of bytes, in the order of encoding

    @property
    def size(self) -> int:
        """Bytes of the values."""
        return math.prod(self.shape) * self.dtype.itemsize

    @property
    def most_bytes(self) -> int:
        """Bytes that a chunk takes at most, however it is stored."""
        size = self.size + self.size // 16 + SPARE
        return size if self.shard is None else size + math.prod(self.shard.counts) * (SPARE // 4)

    def decoded(self, data: bytes, region: tuple[slice, ...]) -> NDArray[Any]:
        """Decode a chunk, and give a region of it."""
        for codec in reversed(self.codecs):
            data = codec.decoded(data, self.most_bytes)
        if self.shard is not None:
            return self.shard.decoded(data, region, self)
        if len(data) != self.size:
            raise ValueError(f"a chunk of shape {self.shape} needs {self.size} bytes, but has {len(data)}")
        shape = self.shape
        for order in self.orders:
            shape = tuple(shape[axis] for axis in order)
        values = np.frombuffer(data, self.dtype).reshape(shape)
        for order in reversed(self.orders):
            values = values.transpose(np.argsort(order, kind="stable"))
        return values[region]


@plain
class Shard:
    """A chunk that is made of smaller ones, with an index of where they are."""

    counts: tuple[int, ...]  # how many along each axis
    # of a smaller chunk, and of the index: offset and size of each, both 2^64 - 1 where it is left out
    inner: Pipeline
    # of a smaller chunk, and of the index: offset and size of each, both 2^64 - 1 where it is left out
    index: Pipeline
    is_first: bool  # the index comes before the chunks

    def decoded(self, data: bytes, region: tuple[slice, ...], whole: Pipeline) -> NDArray[Any]:
        """Decode those smaller chunks that have some of a region of the shard."""
        places = self._places(data)
        result = np.full([part.stop - part.start for part in region], whole.fill, whole.dtype)
        for place in self._stored_within(region, places, len(data)):
            offset, size = (int(number) for number in places[place])
            if offset + size > len(data) or size > self.inner.most_bytes:
                raise ValueError(f"chunk {place} of a shard has {size} bytes at byte {offset} of {len(data)}")
            target, source = overlap(region, place, self.inner.shape)
            result[target] = self.inner.decoded(data[offset : offset + size], source)
        return result

    def _stored_within(self, region: tuple[slice, ...], places: NDArray[np.uint64], size: int) -> list[tuple[int, ...]]:
        """List the places of those chunks that are stored and have some of a region; they share no bytes."""
        is_stored = (places != _MISSING).any(axis=-1)
        if float(places[..., 1][is_stored].sum(dtype=np.float64)) > size:
            raise ValueError(f"the chunks of a shard of {size} bytes have more bytes than it")
        starts = [part.start // side for part, side in zip(region, self.inner.shape, strict=True)]
        ends = [-(-part.stop // side) for part, side in zip(region, self.inner.shape, strict=True)]
        within = np.argwhere(is_stored[tuple(map(slice, starts, ends))]) + starts
        return [tuple(place) for place in within.tolist()]

    def _places(self, data: bytes) -> NDArray[np.uint64]:
        size = self.index.size + _CHECKSUM_BYTES * len(self.index.codecs)
        if len(data) < size:
            raise ValueError(f"a shard has {len(data)} bytes, but its index {size}")
        index = data[:size] if self.is_first else data[len(data) - size :]
        return self.index.decoded(index, tuple(slice(0, side) for side in self.index.shape))


def places_within(region: tuple[slice, ...], chunk: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
    """Places in the grid of the chunks that have some of a region."""
    return product(
        *(range(part.start // side, -(-part.stop // side)) for part, side in zip(region, chunk, strict=True))
    )


def overlap(
    region: tuple[slice, ...], place: tuple[int, ...], chunk: tuple[int, ...]
) -> tuple[tuple[slice, ...], tuple[slice, ...]]:
    """Give what a chunk at a place of the grid and a region share: within the region, and within the chunk."""
    target, source = [], []
    for part, number, side in zip(region, place, chunk, strict=True):
        first, last = max(part.start, number * side), min(part.stop, (number + 1) * side)
        target.append(slice(first - part.start, last - part.start))
        source.append(slice(first - number * side, last - number * side))
    return tuple(target), tuple(source)


def checked_bytes_codec(name: str, options: dict[str, Any], dtype: np.dtype[Any]) -> Codec:
    """Give a codec of bytes by its name."""
    short = name.removeprefix("numcodecs.")
    if short in BYTES_CODECS:
        return Compression(short)
    if short == "shuffle":
        size = options.get("elementsize", 4)
        if type(size) is not int or not 1 <= size <= 256:
            raise InputError(f"its shuffle has elements of {size!r:.40} bytes: expected a number from 1 to 256")
        return Shuffle(size)
    if short == "delta":
        values = [options.get(key) or options.get("dtype") or dtype.str for key in ("dtype", "astype")]
        kinds = [np.dtype(value) if isinstance(value, str) and value[-2:-1] in "biuf" else None for value in values]
        if kinds[0] != dtype or kinds[1] is None:
            raise InputError(f"its delta is of {values[0]!r:.40}, but its values are {dtype.str}")
        return Delta(kinds[0], kinds[1])
    known = ", ".join([*BYTES_CODECS, "shuffle", "delta", "crc32c"])
    raise InputError(f"its codec {name!r:.60} is not supported: use one of {known}")
