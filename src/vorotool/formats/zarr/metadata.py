"""Metadata of Zarr arrays of format 2 or 3: checked and turned into values of our own.

No codec is looked up by its name in a registry, as the zarr package does: a registry may hold one that runs code.
"""

from __future__ import annotations

import json
import math
import os
import re
import struct
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError
from vorotool.formats.io import unpacking
from vorotool.formats.io.sources import check_nesting
from vorotool.frozen import frozen

LARGEST_METADATA = 2**20
"""Bytes; of an array they are some hundred."""

LARGEST_CHUNK = 2**26
"""Bytes of a chunk; only a larger array may have larger ones."""

_MOST_AXES, _MOST_CODECS = 32, 32
"""Arrays have a few of either; each codec goes over all bytes of a chunk."""

_VERSION_3, _VERSION_2 = "zarr.json", ".zarray"
_NAMED_TYPE = re.compile(r"bool|u?int(8|16|32|64)|float(16|32|64)|complex(64|128)")
_CODED_TYPE = re.compile(r"[<>|](b1|[iu][1248]|f[248]|c(8|16))")
_KNOWN_KEYS = {
    "zarr_format",
    "node_type",
    "shape",
    "data_type",
    "chunk_grid",
    "chunk_key_encoding",
    "fill_value",
    "codecs",
    "attributes",
    "storage_transformers",
    "dimension_names",
    "consolidated_metadata",
}
_SPECIAL = {"NaN": math.nan, "Infinity": math.inf, "-Infinity": -math.inf}


@frozen
class ZarrMetadata:
    """An array in a store."""

    shape: tuple[int, ...]
    # how a chunk is stored; it knows the shape of chunks, the type and the value of what is left out
    pipeline: Pipeline
    prefix: str  # of the names of chunks, as in `c/0/1`
    separator: str  # of the names of chunks, as in `c/0/1`

    @property
    def chunks(self) -> tuple[int, ...]:
        """Shape of a chunk."""
        return self.pipeline.shape

    def key(self, place: tuple[int, ...]) -> str:
        """Name of the file of a chunk."""
        return self.prefix + self.separator.join(map(str, place))


def read_metadata(path: str | os.PathLike[str]) -> dict[str, Any] | None:
    """Read the JSON that says what a folder holds; None if it holds no Zarr array or group."""
    folder = Path(path)
    for name in (_VERSION_3, _VERSION_2, ".zgroup"):
        file = folder / name
        if not file.is_file():
            continue
        made = read_json(file)
        if name != _VERSION_3:
            made = made | {"zarr_format": 2, "node_type": "array" if name == _VERSION_2 else "group"}
        return made
    return None


def read_json(file: Path) -> dict[str, Any]:
    """Read a file of metadata."""
    with file.open("rb") as opened:
        text = opened.read(LARGEST_METADATA + 1)
    if len(text) > LARGEST_METADATA:
        raise InputError(f"{file} has more than {LARGEST_METADATA} bytes: the metadata of an array are far shorter")
    check_nesting(text, name=str(file))
    try:
        made = json.loads(text)
    except ValueError as error:
        raise InputError(f"{file} is not JSON: {error}") from None
    if not isinstance(made, dict):
        raise InputError(f"{file} holds no JSON object, which the metadata should be")
    return made


def array_metadata(name: str, made: dict[str, Any]) -> ZarrMetadata:
    """Check metadata of an array that `read_metadata` gave."""
    try:
        metadata = _version_2(made) if made["zarr_format"] == 2 else _version_3(made)
    except InputError as error:
        raise InputError(f"{name}: {error.marked}") from None
    except (KeyError, TypeError, ValueError, OverflowError, struct.error) as error:
        missing = f"there is no {error}" if isinstance(error, KeyError) else str(error)
        raise InputError(f"{name} cannot be read as Zarr: {missing}; is its metadata damaged?") from None
    array, chunk = (math.prod(shape) * metadata.pipeline.dtype.itemsize for shape in (metadata.shape, metadata.chunks))
    if chunk > max(LARGEST_CHUNK, 4 * array):
        raise InputError(
            f"{name} is damaged: it has chunks of shape {metadata.chunks} for an array of shape {metadata.shape}"
        )
    return metadata


def _version_2(made: dict[str, Any]) -> ZarrMetadata:
    shape, chunks, dtype = _layout(made["shape"], made["chunks"], made["dtype"], _CODED_TYPE)
    steps = [*(made.get("filters") or ()), *([made["compressor"]] if made.get("compressor") else ())]
    _check_count(steps)
    codecs = tuple(checked_bytes_codec(*_named(step, "id"), dtype) for step in steps)
    orders = (tuple(range(len(shape)))[::-1],) if _choice(made, "order", ("C", "F")) == "F" else ()
    separator = _choice(made, "dimension_separator", (".", "/"))
    fill = _fill_value(made.get("fill_value"), dtype)
    return ZarrMetadata(shape, Pipeline(chunks, dtype, fill, orders, None, codecs), "", separator)


def _version_3(made: dict[str, Any]) -> ZarrMetadata:
    if made["zarr_format"] != 3:
        raise InputError(f"its format is {made['zarr_format']!r:.40}: expected 2 or 3")
    for key, value in made.items():
        if key not in _KNOWN_KEYS and not (isinstance(value, dict) and value.get("must_understand") is False):
            raise InputError(f"its metadata have {key!r:.60}, an unknown extension")
    if made.get("storage_transformers"):
        raise InputError("it has storage transformers, which are not supported")
    grid, grid_options = _named(made["chunk_grid"], "name")
    if grid != "regular":
        raise InputError(f"its grid of chunks is {grid!r:.60}: expected regular")
    shape, chunks, dtype = _layout(made["shape"], grid_options["chunk_shape"], made["data_type"], _NAMED_TYPE)
    encoding, key_options = _named(made["chunk_key_encoding"], "name")
    if encoding not in ("default", "v2"):
        raise InputError(f"its chunks are named by {encoding!r:.60}: expected default or v2")
    separator = _choice(key_options, "separator", ("/", ".") if encoding == "default" else (".", "/"))
    pipeline = _pipeline(made["codecs"], chunks, dtype, _fill_value(made["fill_value"], dtype))
    return ZarrMetadata(shape, pipeline, f"c{separator}" if encoding == "default" else "", separator)


def _pipeline(steps: Any, shape: tuple[int, ...], dtype: np.dtype[Any], fill: Any, depth: int = 0) -> Pipeline:
    """Codecs of format 3: of arrays, one that makes bytes of them, and of bytes."""
    if not isinstance(steps, list):
        raise InputError(f"its codecs are {steps!r:.60}: expected a list")
    _check_count(steps)
    orders: list[tuple[int, ...]] = []
    shard: Shard | None = None
    stored: np.dtype[Any] | None = None
    codecs: list[Codec] = []
    for name, options in (_named(step, "name") for step in steps):
        if name == "transpose" and stored is None:
            orders.append(_order(options["order"], len(shape)))
        elif name == "bytes" and stored is None:
            stored = dtype.newbyteorder(">" if _choice(options, "endian", ("little", "big")) == "big" else "<")
        elif name == "sharding_indexed" and stored is None and depth < 2:
            if orders:
                raise InputError("its shards are transposed, which is not supported: save it without")
            stored, shard = dtype, _shard(options, shape, dtype, fill, depth)
        elif stored is not None:
            codecs.append(Checksum() if name == "crc32c" else checked_bytes_codec(name, options, dtype))
        else:
            raise InputError(f"its codec {name!r:.60} is not supported, or is out of place: supported are {_ACCEPTED}")
    if stored is None:
        raise InputError("its codecs produce no bytes: expected bytes or sharding_indexed")
    return Pipeline(shape, stored, fill, tuple(orders), shard, tuple(codecs))


def _shard(options: dict[str, Any], shape: tuple[int, ...], dtype: np.dtype[Any], fill: Any, depth: int) -> Shard:
    inner = _sizes(options["chunk_shape"], 1)
    if len(inner) != len(shape) or any(whole % part for whole, part in zip(shape, inner, strict=True)):
        raise InputError(f"its shards of shape {shape} are not multiples of the chunks of shape {inner}")
    counts = tuple(whole // part for whole, part in zip(shape, inner, strict=True))
    location = _choice(options, "index_location", ("end", "start"))
    index = _pipeline(options["index_codecs"], (*counts, 2), np.dtype(np.uint64), 2**64 - 1, depth=2)
    if any(not isinstance(codec, Checksum) for codec in index.codecs) or index.orders:
        raise InputError("the index of its shards is compressed: only bytes and crc32c are supported")
    return Shard(counts, _pipeline(options["codecs"], inner, dtype, fill, depth + 1), index, location == "start")


def _named(step: Any, key: str) -> tuple[str, dict[str, Any]]:
    """Name and configuration of a codec, a grid or an encoding."""
    if isinstance(step, str):
        step = {key: step}
    if not isinstance(step, dict) or not isinstance(step.get(key), str):
        raise InputError(f"{step!r:.60} in its metadata has no {key}")
    options = step.get("configuration") or {} if key == "name" else step
    if not isinstance(options, dict):
        raise InputError(f"the configuration of {step[key]!r:.60} is not a JSON object")
    return step[key], options


def _sizes(values: Any, least: int) -> tuple[int, ...]:
    if not isinstance(values, list) or not all(type(value) is int and least <= value < 2**62 for value in values):
        raise InputError(f"{values!r:.60} is not a shape: expected integers of at least {least}")
    if len(values) > _MOST_AXES:
        raise InputError(f"its shape {values!r:.60} has {len(values)} axes: at most {_MOST_AXES} are supported")
    return tuple(values)


def _check_count(steps: list[Any]) -> None:
    if len(steps) > _MOST_CODECS:
        raise InputError(f"it has {len(steps)} codecs in sequence: at most {_MOST_CODECS} are supported")


def _layout(
    shape: Any, chunks: Any, kind: Any, known: re.Pattern[str]
) -> tuple[tuple[int, ...], tuple[int, ...], np.dtype[Any]]:
    """Check the shape of an array and of its chunks, and the name of its type."""
    sizes, parts = _sizes(shape, 0), _sizes(chunks, 1)
    if len(sizes) != len(parts):
        raise InputError(f"its shape is {sizes}, but that of its chunks {parts}")
    if not (isinstance(kind, str) and known.fullmatch(kind)):
        raise InputError(f"it holds {kind!r:.60}: an image of numbers is expected")
    return sizes, parts, np.dtype(kind)


def _choice(options: dict[str, Any], key: str, choices: tuple[str, str]) -> str:
    """Value of an option, the first of its choices if it is not there."""
    value = options.get(key, choices[0])
    if value not in choices:
        raise InputError(f"its {key} is {value!r:.40}: expected {choices[0]} or {choices[1]}")
    return str(value)


def _order(order: Any, axes: int) -> tuple[int, ...]:
    values = tuple(range(axes))
    known = {"C": values, "F": values[::-1]}
    if isinstance(order, str):
        order = list(known.get(order, ()))
    if not isinstance(order, list) or sorted(order) != list(values):
        raise InputError(f"its transpose has the order {order!r:.60}, which is not an order of {axes} axes")
    return tuple(order)


def _fill_value(value: Any, dtype: np.dtype[Any]) -> Any:
    """Value of pixels that are in no chunk."""
    if value is None:
        return 0
    if dtype.kind == "c":
        return complex(*(float(_SPECIAL.get(part, part)) for part in value))
    if dtype.kind == "f":
        if isinstance(value, str) and value.startswith("0x"):
            return np.array(int(value, 16), f">u{dtype.itemsize}").view(f">f{dtype.itemsize}").item()
        return float(_SPECIAL.get(value, value))
    if dtype.kind == "b":
        return bool(value)
    number = int(value)
    if not np.iinfo(dtype).min <= number <= np.iinfo(dtype).max:
        raise InputError(f"its fill value {number} does not fit in {dtype}")
    return number


# ---- codecs --------------------------------------------------------------------------------------
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
_ACCEPTED = "bytes, transpose, sharding_indexed, shuffle, delta, crc32c, " + ", ".join(BYTES_CODECS)

_MISSING = 2**64 - 1
_CHECKSUM_BYTES = 4


@frozen
class Compression:
    """One of `BYTES_CODECS`."""

    name: str

    def decoded(self, data: bytes, most: int) -> bytes:
        """Undo it."""
        unpacked: bytes = BYTES_CODECS[self.name](data, most)
        if len(unpacked) > most:
            raise ValueError(f"a chunk unpacks to more than {most} bytes, which is more than its values need")
        return unpacked


@frozen
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


@frozen
class Shuffle:
    """Bytes of values apart: all first ones, all second ones, and so on."""

    size: int

    def decoded(self, data: bytes, most: int) -> bytes:
        """Undo it."""
        whole = len(data) // self.size * self.size
        mixed = np.frombuffer(data, np.uint8, whole).reshape(self.size, -1).T
        return mixed.tobytes() + bytes(data[whole:])


@frozen
class Delta:
    """Differences of values."""

    dtype: np.dtype[Any]
    stored: np.dtype[Any]

    def decoded(self, data: bytes, most: int) -> bytes:
        """Undo it."""
        return np.cumsum(np.frombuffer(data, self.stored), dtype=self.dtype).astype(self.dtype).tobytes()


Codec = Compression | Checksum | Shuffle | Delta


@frozen
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


@frozen
class Shard:
    """A chunk that is made of smaller ones, with an index of where they are."""

    counts: tuple[int, ...]  # how many along each axis
    inner: Pipeline  # of a smaller chunk
    index: Pipeline  # of the index: offset and size of each, both 2^64 - 1 where it is left out
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
