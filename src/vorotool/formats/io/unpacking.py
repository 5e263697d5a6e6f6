"""Undoing compressions up to a limit: nothing is unpacked beyond what is asked for, whatever the data hold.

Each function takes packed bytes and a limit, and returns at most one byte more than the limit, which says that there
is more. What is damaged or ends too early is a ValueError, or an error of the library that unpacks.
"""

from __future__ import annotations

import bz2
import importlib.util
import lzma
import zlib
from collections.abc import Callable
from typing import Any

from vorotool import _core
from vorotool.errors import UsageError

PIECE = 2**24
"""Bytes that are unpacked at a time: between two pieces Python sees signals."""

LZMA_MEMORY = 2**27
"""Bytes for the dictionary of LZMA; its highest preset takes 65 MiB."""

_SPARSE_BLOCKS = 8
"""Times that the blocks of Zstandard could hold more than they do: some writers end them early."""

Packed = bytes | memoryview
Unpacker = Callable[[Packed, int], Any]


def unpack_zlib(data: Packed, limit: int) -> bytes:
    """Undo deflate with the header of zlib; what follows the stream is left."""
    return _streamed(zlib.decompressobj(zlib.MAX_WBITS), data, limit)[0]


def unpack_gzip(data: Packed, limit: int) -> bytes:
    """Undo gzip; several streams follow each other."""
    made = b""
    while data and len(made) <= limit:
        piece, data = _streamed(zlib.decompressobj(16 + zlib.MAX_WBITS), data, limit - len(made))
        made += piece
        data = data.lstrip(b"\0")  # which may fill the rest of a file
    return made


def unpack_bz2(data: Packed, limit: int) -> bytes:
    """Undo bzip2; several streams follow each other."""
    made = b""
    while data and len(made) <= limit:
        piece, data = _streamed(bz2.BZ2Decompressor(), data, limit - len(made))
        made += piece
    return made


def unpack_lzma(data: Packed, limit: int) -> bytes:
    """Undo LZMA in the format of xz, or in the older one."""
    return _streamed(lzma.LZMADecompressor(memlimit=LZMA_MEMORY), data, limit)[0]


def unpack_lzw(data: Packed, limit: int) -> bytes:
    """Undo LZW as TIFF has it."""
    if data[:1] == b"\0" and len(data) > 1 and data[1] & 1:
        raise ValueError("its LZW has the order of bits from before TIFF 5.0: save it with deflate")
    return _core.compression.unpack_lzw(bytes(data), limit + 1).data  # type: ignore[return-value]


def unpack_packbits(data: Packed, limit: int) -> bytes:
    """Undo PackBits."""
    return _core.compression.unpack_packbits(bytes(data), limit + 1).data  # type: ignore[return-value]


def unpack_lz4(data: Packed, limit: int) -> bytes:
    """Undo LZ4 as numcodecs writes it: four bytes say how much there is."""
    if len(data) < 4:
        raise ValueError(f"the header of LZ4 has 4 bytes, but the data have {len(data)}")
    if int.from_bytes(data[:4], "little") > limit:
        return bytes(limit + 1)
    return bytes(_numcodecs("lz4").decompress(data))


def unpack_blosc(data: Packed, limit: int) -> bytes:
    """Undo Blosc, whose header says how much there is."""
    if len(data) < 16:
        raise ValueError(f"the header of Blosc has 16 bytes, but the data have {len(data)}")
    if int.from_bytes(data[4:8], "little") > limit:
        return bytes(limit + 1)
    if int.from_bytes(data[12:16], "little") > len(data):
        raise ValueError("the data of Blosc are cut off")
    return bytes(_numcodecs("blosc").decompress(data))


def unpack_zstd(data: Packed, limit: int) -> bytes:
    """Undo Zstandard; the headers of frames say how much there is, or those of blocks how much there can be."""
    most, is_exact = most_unpacked(data)
    if most > (limit if is_exact else _SPARSE_BLOCKS * limit + PIECE):
        return bytes(limit + 1)
    return bytes(_numcodecs("zstd").decompress(data)) if most else b""


def has_zstd() -> bool:
    """Whether Zstandard can be undone here."""
    return importlib.util.find_spec("numcodecs") is not None


def _numcodecs(name: str) -> Any:
    try:
        return importlib.import_module(f"numcodecs.{name}")
    except ImportError:
        raise UsageError(f"data packed with {name} need the numcodecs package: pip install 'vorotool[zarr]'") from None


def _streamed(stream: Any, data: Packed, limit: int) -> tuple[bytes, bytes]:
    """Undo one stream; what it gives, and what follows it."""
    pieces: list[bytes] = []
    size = 0
    while not stream.eof and size <= limit:
        piece = stream.decompress(data, min(PIECE, limit + 1 - size))
        data = getattr(stream, "unconsumed_tail", b"")  # of deflate alone: others keep it themselves
        if not piece and not data and not stream.eof and getattr(stream, "needs_input", True):
            raise ValueError("its compressed data end too early")
        pieces.append(piece)
        size += len(piece)
    return b"".join(pieces), stream.unused_data


# ---- how much Zstandard data can hold (RFC 8878, section 3) --------------------------------------
_FRAME, _SKIPPABLE = 0xFD2FB528, 0x184D2A50
_MOST_OF_BLOCK = 2**17
_RAW, _RUN, _COMPRESSED = 0, 1, 2
_CONTENT_BYTES = (0, 2, 4, 8)
_DICTIONARY_BYTES = (0, 1, 2, 4)


def most_unpacked(data: bytes | memoryview) -> tuple[int, bool]:
    """Bytes that unpacking gives at most, and whether they are just as many: every frame says how many it holds."""
    at = total = 0
    is_exact = True
    while at < len(data):
        magic = _number(data, at, 4)
        if magic & 0xFFFFFFF0 == _SKIPPABLE:
            at += 8 + _number(data, at + 4, 4)
            continue
        if magic != _FRAME:
            raise ValueError(f"no Zstandard frame begins at byte {at}")
        stated, window, at, has_checksum = _header(data, at + 4)
        most, at = _blocks(data, at, min(window, _MOST_OF_BLOCK))
        total += most if stated is None else stated
        is_exact &= stated is not None
        at += 4 * has_checksum
    if at > len(data):
        raise ValueError("its compressed data end too early")
    return total, is_exact


def _header(data: bytes | memoryview, at: int) -> tuple[int | None, int, int, bool]:
    """Size that a frame states, if it does, its window, where its blocks begin, and whether a checksum ends it."""
    descriptor = _number(data, at, 1)
    is_single, size_bytes = bool(descriptor & 0x20), _CONTENT_BYTES[descriptor >> 6]
    at, window = at + 1, 0
    if is_single:
        size_bytes = size_bytes or 1
    else:
        exponent = _number(data, at, 1)
        window = (1 << (10 + (exponent >> 3))) * (8 + (exponent & 7)) // 8
        at += 1
    at += _DICTIONARY_BYTES[descriptor & 3]
    stated = _number(data, at, size_bytes) + 256 * (size_bytes == 2) if size_bytes else None
    return stated, window if stated is None or not is_single else stated, at + size_bytes, bool(descriptor & 4)


def _blocks(data: bytes | memoryview, at: int, most_of_block: int) -> tuple[int, int]:
    """How much the blocks of a frame hold at most, and where they end."""
    most = 0
    while True:
        header = _number(data, at, 3)
        kind, size = header >> 1 & 3, header >> 3
        if kind > _COMPRESSED:
            raise ValueError(f"the block at byte {at} has a type that Zstandard does not define")
        most += most_of_block if kind == _COMPRESSED else size
        at += 3 + (1 if kind == _RUN else size)
        if header & 1:
            return most, at


def _number(data: bytes | memoryview, at: int, size: int) -> int:
    if at + size > len(data):
        raise ValueError("its compressed data end too early")
    return int.from_bytes(data[at : at + size], "little")
