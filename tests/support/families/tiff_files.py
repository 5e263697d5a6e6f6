"""TIFF files of any tags, and damaged ones."""

import struct

SHORT, LONG = 3, 4
_CODES = {1: "B", 2: "B", 7: "B", 3: "H", 4: "I", 12: "d", 16: "Q"}
_OFFSETS = {False: (273, 279), True: (324, 325)}


def tiff_file(tags, segments, *, is_tiled=False, left_out=(), counts=None):
    """A file of one page: tags are {code: value or (type, values)}; segments are the bytes of strips or tiles."""
    places, at = [], 8
    for index, segment in enumerate(segments):
        places.append((0, 0) if index in left_out else (at, len(segment)))
        at += 0 if index in left_out else len(segment)
    body = b"".join(segment for index, segment in enumerate(segments) if index not in left_out)
    offset_tag, count_tag = _OFFSETS[is_tiled]
    entries = {offset_tag: (LONG, [place[0] for place in places])} if places else {}
    if places:
        entries[count_tag] = (LONG, [place[1] for place in places] if counts is None else counts)
    entries |= {code: value if isinstance(value, tuple) else (LONG, [value]) for code, value in tags.items()}
    directory = struct.pack("<H", len(entries))
    end = at + 2 + 12 * len(entries) + 4
    extra = b""
    for code, (kind, values) in sorted(entries.items()):
        packed = struct.pack(f"<{len(values)}{_CODES[kind]}", *values)
        if len(packed) > 4:
            packed, extra = struct.pack("<I", end + len(extra)), extra + packed
        directory += struct.pack("<HHI", code, kind, len(values)) + packed.ljust(4, b"\0")
    return b"II*\0" + struct.pack("<I", at) + body + directory + struct.pack("<I", 0) + extra


def grey(width, height, rows=None, *, bits=8, compression=1, **further):
    """Tags of a grey image in strips."""
    return {
        256: width,
        257: height,
        258: (SHORT, [bits]),
        259: (SHORT, [compression]),
        262: (SHORT, [1]),
        277: (SHORT, [1]),
        278: rows or height,
    } | further
