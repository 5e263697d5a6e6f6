"""Changes of files that keep most of their structure."""

import gzip
import random
import re
import struct
import zlib
from collections.abc import Callable
from functools import lru_cache

from fuzz.byte_seeds import Bundle

NUMBERS = (0, 1, 2, 3, 7, 8, 16, 127, 128, 255, 256, 4096, 32767, 32768, 65535, 65536, 2**24, 2**31 - 1, 2**31)
NUMBERS += (2**32 - 1, 2**32, 2**53 + 1, 2**62, 2**63 - 1, 2**63, 2**64 - 1, 577_990_168)
WORDS = [*map(str, NUMBERS), "-1", "-0", "1e308", "1e309", "-1e400", "5e-324", "nan", "inf", "-inf", "NaN", "Infinity"]
WORDS += ["1.5.2", "0x10", "1_000", "\u0663", ".", "-", "+1", "007", "1e", "9" * 400, "1" + "0" * 5000, "null", "true"]
WORDS += ["[", "]", "{", "}", "(", ")", '"', ",", ":", ";", "\n", "\r", "\t", " ", "\0", "\\", "\\u0000", "#", "EMPTY"]
WORDS += [
    "[]",
    "{}",
    '""',
    "()",
    "POLYGON",
    "POINT",
    "Z",
    "'",
    "=",
    "\ufeff",
    "\ud800".encode("utf-8", "surrogatepass").decode("latin-1"),
]
TOKENS = re.compile(rb"[A-Za-z_|<>]+|[-+.0-9eE]+|\s+|.", re.DOTALL)
CHUNKS = (b"IDAT", b"PLTE", b"tRNS", b"zTXt", b"iCCP", b"gAMA", b"IEND", b"acTL", b"fdAT")
TAGS = (256, 257, 258, 259, 262, 266, 273, 277, 278, 279, 284, 317, 322, 323, 324, 325, 339, 347, 513, 32997, 50838)
DESCRIPTION = re.compile(rb"<OME .*OME>|ImageJ=[ -~\n]*|{[ -~]*}", re.DOTALL)
TYPE = re.compile(rb"(?<='descr': )'[^']*'")
TYPES = (b"'<u2'", b"'|O'", b"'<c8'", b"[('a', '<u2')]", b"'<U4'", b"'<M8[s]'", b"'>f2'", b"'|b1'", b"'<f16'")
PARTS = {
    "svg": (re.compile(rb"<([a-z]+)\b[^<>]*(?:/>|>[^<>]*</\1>)"), re.compile(rb""" [\w:-]+=("[^"]*"|'[^']*')""")),
    "dxf": (re.compile(rb"^ *0\r?\n.+?(?=^ *0\r?\n)", re.DOTALL | re.MULTILINE), re.compile(rb"^ *\d+\r?\n.*\n", re.M)),
}
"""Elements and attributes of SVG, entities and groups of DXF."""
RESULTS = {"skeleton", "offsets", "voronoi"}
TEXTS = {"csv", "json", "geojson", "wkt", "node", "poly", "pnm", "manifest", "svg", "dxf", *RESULTS}


def mutated(bundle: Bundle, others: list[Bundle], chance: random.Random) -> Bundle:
    """Change one of the files of a bundle, most often once or twice."""
    name = chance.choice(sorted(bundle.files))
    data = bundle.files[name]
    for _ in range(1 + int(chance.expovariate(1.3))):
        data = _change(bundle.kind, name)(data, chance) if chance.random() < 0.7 else _any(data, others, chance)
    files = dict(bundle.files)
    files[name] = data[:200_000]
    if len(files) > 1 and chance.random() < 0.1:  # of a store: a file gone, or under the name of another
        taken, given = chance.sample(sorted(files), 2)
        moved = files.pop(taken)
        if chance.random() < 0.5:
            files[given] = moved
    return Bundle(bundle.kind, bundle.name, files)


def _change(kind: str, name: str) -> Callable[[bytes, random.Random], bytes]:
    if kind in PARTS:
        return lambda data, chance: _parts(kind, data, chance) if chance.random() < 0.5 else _tokens(data, chance)
    if kind in TEXTS or name.endswith((".json", ".zarray", ".zattrs")):
        return _tokens
    return {"png": _png, "tiff": _tiff, "ome-tiff": _ome_tiff, "npy": _npy}.get(kind, _bytes)


def _any(data: bytes, others: list[Bundle], chance: random.Random) -> bytes:
    if chance.random() < 0.2:  # a piece of another file of its kind
        other = chance.choice(list(chance.choice(others).files.values()))
        start, end = sorted(chance.randrange(len(other) + 1) for _ in range(2))
        at = chance.randrange(len(data) + 1)
        return data[:at] + other[start:end] + data[at + (end - start if chance.random() < 0.5 else 0) :]
    return _bytes(data, chance)


def _bytes(data: bytes, chance: random.Random) -> bytes:
    made = bytearray(data)
    at = chance.randrange(len(made) + 1)
    size = min(len(made) - at, 1 + int(chance.expovariate(0.1)))
    action = chance.randrange(7)
    if action == 0 and at < len(made):
        made[at] ^= 1 << chance.randrange(8)
    elif action == 1 and at < len(made):
        made[at] = chance.choice((0, 1, 127, 128, 255, chance.randrange(256)))
    elif action == 2:
        made[at : len(made) if chance.random() < 0.5 else at + size] = b""
    elif action == 3:
        made[at:at] = made[at : at + size] * chance.choice((1, 2, 30))
    elif action == 4:
        made[at : at + size] = bytes(size)
    else:
        width = chance.choice((1, 2, 4, 8))
        number = (chance.choice(NUMBERS) + chance.choice((0, 0, 1, -1))) % 256**width
        made[at : at + width] = number.to_bytes(width, chance.choice(("little", "big")))
    return bytes(made)


def _tokens(data: bytes, chance: random.Random) -> bytes:
    """Change words, numbers and signs of a text."""
    tokens = list(_split(data))
    if not tokens:
        return chance.choice(WORDS).encode()
    at = chance.randrange(len(tokens))
    end = min(len(tokens), at + 1 + int(chance.expovariate(0.2)))
    action = chance.randrange(8)
    if action <= 2:
        numbers = [place for place, token in enumerate(tokens) if token[:1].isdigit()] or [at]
        tokens[chance.choice(numbers)] = chance.choice(WORDS).encode("utf-8", "replace")
    elif action == 3:
        tokens[at] = chance.choice(WORDS).encode("utf-8", "replace")
    elif action == 4:
        del tokens[at:end]
    elif action == 5:
        tokens[at:at] = tokens[at:end] * chance.choice((1, 1, 3, 200))
    elif action == 6:
        other = chance.randrange(len(tokens))
        tokens[at], tokens[other] = tokens[other], tokens[at]
    else:
        tokens[at] = tokens[at].swapcase() if chance.random() < 0.5 else tokens[chance.randrange(len(tokens))]
    return b"".join(tokens)


def _parts(kind: str, data: bytes, chance: random.Random) -> bytes:
    """Repeat, move or swap whole parts of a drawing; those of a packed one most often."""
    if data.startswith(b"\x1f\x8b") and chance.random() < 0.9:
        try:
            return gzip.compress(_parts(kind, gzip.decompress(data), chance), mtime=0)
        except (OSError, EOFError, zlib.error):
            return _bytes(data, chance)
    spans = [match.span() for match in chance.choice(PARTS[kind]).finditer(data)]
    if len(spans) < 2:
        return _tokens(data, chance)
    (a, b), (c, d) = sorted(chance.sample(spans, 2))
    first, between, second = data[a:b], data[b:c], data[c:d]
    action = chance.randrange(4)
    if action == 0:
        first *= chance.choice((2, 2, 30, 1000))
    elif action == 1:
        first, second = b"", second + first
    elif action == 2:
        first, second = second + first, b""
    else:
        first, second = second, first
    return data[:a] + first + between + second + data[d:]


@lru_cache(maxsize=256)
def _split(data: bytes) -> tuple[bytes, ...]:
    """Tokens of a text; those of the files that are changed again and again are kept."""
    return tuple(TOKENS.findall(data))


def _png(data: bytes, chance: random.Random) -> bytes:
    """Change, drop, double or move chunks; most checksums are made right."""
    chunks, at = [], 8
    while at + 12 <= len(data):
        length = int.from_bytes(data[at : at + 4], "big")
        chunks.append((data[at + 4 : at + 8], data[at + 8 : at + 8 + length]))
        at += 12 + length
    if not chunks:
        return _bytes(data, chance)
    place = chance.randrange(len(chunks))
    kind, body = chunks[place]
    action = chance.randrange(6)
    if action == 0:
        del chunks[place]
    elif action == 1:
        chunks.insert(chance.randrange(len(chunks)), chunks[place])
    elif action == 2:
        chunks[place] = chance.choice(CHUNKS), body
    elif action == 3 and kind == b"IDAT":
        try:
            chunks[place] = kind, zlib.compress(_bytes(zlib.decompress(body), chance))
        except zlib.error:
            chunks[place] = kind, _bytes(body, chance)
    else:
        chunks[place] = kind, _bytes(body, chance)
    made = data[:8]
    for kind, body in chunks:
        check = zlib.crc32(kind + body) ^ (chance.random() < 0.05)
        made += len(body).to_bytes(4, "big") + kind + body + check.to_bytes(4, "big")
    return made


def _tiff(data: bytes, chance: random.Random) -> bytes:
    """Change the type, the count or the value of a tag, or take the tag of another."""
    order = "<" if data[:2] == b"II" else ">"
    if len(data) < 16:
        return _bytes(data, chance)
    is_big = data[2:4] in (b"+\0", b"\0+")
    head, size, value_type = ("Q", 20, "Q") if is_big else ("H", 12, "I")
    start = struct.unpack_from(order + value_type, data, 8 if is_big else 4)[0]
    first = start + struct.calcsize(order + head)
    if first + size > len(data):
        return _bytes(data, chance)
    count = min(struct.unpack_from(order + head, data, start)[0], (len(data) - first) // size)
    if not count:
        return _bytes(data, chance)
    made = bytearray(data)
    at = first + size * chance.randrange(count)
    width = struct.calcsize(order + value_type)
    action, number = chance.randrange(6), chance.choice(NUMBERS)
    if action == 0:
        struct.pack_into(order + "H", made, at + 2, chance.choice((0, 1, 2, 3, 4, 5, 6, 9, 11, 12, 13, 16, 17, 99)))
    elif action == 1:
        struct.pack_into(order + value_type, made, at + 4, number % 256**width)
    elif action == 2:
        struct.pack_into(order + "H", made, at, chance.choice(TAGS))
    elif action == 3:
        made[at : at + size] = made[first : first + size]
    else:
        small = chance.choice(("H", value_type))
        struct.pack_into(order + small, made, at + 4 + width, number % 256 ** struct.calcsize(order + small))
    return bytes(made)


def _ome_tiff(data: bytes, chance: random.Random) -> bytes:
    """Change the description, which keeps its length, or a tag."""
    match = DESCRIPTION.search(data)
    if match is None or chance.random() < 0.5:
        return _tiff(data, chance)
    text, (start, end) = _tokens(match[0], chance), match.span()
    return data[:start] + text.ljust(end - start)[: end - start] + data[end:]


def _npy(data: bytes, chance: random.Random) -> bytes:
    """Change the text of the header; most lengths are made right."""
    if len(data) < 12:
        return _bytes(data, chance)
    length = int.from_bytes(data[8:10], "little")
    text, body = data[10 : 10 + length], data[10 + length :]
    text = TYPE.sub(lambda _: chance.choice(TYPES), text)
    text = _tokens(text, chance)
    if chance.random() < 0.9:
        text = text.rstrip() + b" " * (-(len(text.rstrip()) + 11) % 64) + b"\n"
        length = len(text) % 65536
    return data[:8] + length.to_bytes(2, "little") + text + body
