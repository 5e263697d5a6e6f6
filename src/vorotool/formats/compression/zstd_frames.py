"""How much Zstandard data can hold, by the headers of their frames and blocks (RFC 8878, section 3)."""

from __future__ import annotations

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
