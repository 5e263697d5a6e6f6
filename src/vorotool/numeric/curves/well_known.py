"""Well-known text and binary as geometry of shapely; kinds that it does not know are read here, without curves."""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.curve_geometry import CURVED, LEAVES, PARTS, Linearizer, Node

_TOKENS = re.compile(r"\s*([A-Za-z]+|[(),]|[^\s(),A-Za-z][^\s(),]*)")
_KINDS = re.compile(rf"({'|'.join((*LEAVES, *PARTS))})(Z|M|ZM)?", re.IGNORECASE)
_CODES = dict(
    enumerate(
        (
            *("POINT", "LINESTRING", "POLYGON", "MULTIPOINT", "MULTILINESTRING", "MULTIPOLYGON", "GEOMETRYCOLLECTION"),
            *("CIRCULARSTRING", "COMPOUNDCURVE", "CURVEPOLYGON", "MULTICURVE", "MULTISURFACE", "", ""),
            *("POLYHEDRALSURFACE", "TIN", "TRIANGLE"),
        ),
        1,
    )
)
_HAS_Z, _HAS_M, _HAS_NUMBER = 1 << 31, 1 << 30, 1 << 29
_MOST_LEVELS = 100
_SHORT = 9 * _MOST_LEVELS
"""Bytes that geometry of too many levels has at least."""
_COLLECTION = 7
"""Its number of GEOS; those of kinds with curves are higher."""


class Flat(NamedTuple):
    """Geometry without curves."""

    geometry: NDArray[np.object_]  # (n,) object array: of shapely; None where a text was None, or is none
    curves: int  # how many circular strings were replaced by lines


def geometry_of_texts(texts: Sequence[str | None], flatten: float | None = None) -> Flat:
    """Read well-known text."""
    import shapely

    capitals = "\n".join(text for text in texts if isinstance(text, str)).upper()
    kinds = [kind for kind in CURVED if kind in capitals]  # none, nearly always: no text is looked at twice
    own = [k for k, text in enumerate(texts if kinds else []) if text and any(kind in text.upper() for kind in kinds)]
    plain = np.array([*texts, None], dtype=object)[:-1]
    plain[own] = None
    with np.errstate(all="ignore"):  # numbers beyond the largest double are found by whoever reads the vertices
        try:
            geometry = _read_plain(shapely.from_wkt, plain)
        except (shapely.GEOSException, UnicodeEncodeError):  # a text with half a surrogate pair
            plain[[k for k, text in enumerate(plain) if isinstance(text, str) and not _is_unicode(text)]] = None
            geometry = _read_plain(shapely.from_wkt, plain)
    return _with_own(geometry, {k: _read_later(_TextReader, texts[k]) for k in own}, flatten)


def _is_unicode(text: str) -> bool:
    """Tell whether a text can be written as UTF-8."""
    return not any("\ud800" <= letter <= "\udfff" for letter in text)


def geometry_of_binary(items: Sequence[bytes | str | None], flatten: float | None = None) -> Flat:
    """Read well-known binary, plain or extended, as bytes or as hexadecimal digits."""
    import shapely

    own = [k for k, item in enumerate(items) if item is not None and _is_read_here(item)]
    plain = np.array([*items, None], dtype=object)[:-1]
    plain[own] = None
    geometry = _read_plain(shapely.from_wkb, plain)
    return _with_own(geometry, {k: _read_later(_BinaryReader, items[k]) for k in own}, flatten)


def _read_plain(read: Callable[..., Any], items: NDArray[np.object_]) -> NDArray[np.object_]:
    """Read geometry by shapely; None for what is damaged, or holds curves where none should be."""
    try:
        made: NDArray[np.object_] = read(items, on_invalid="ignore")
    except NotImplementedError:
        if len(items) == 1:
            return np.array([None], dtype=object)
        return np.concatenate([_read_plain(read, items[k : k + 1]) for k in range(len(items))])
    return made


def without_curves(geometry: NDArray[np.object_], flatten: float | None = None) -> Flat:
    """Replace geometry of shapely that has curves in it, as collections may."""
    import shapely

    held = np.flatnonzero(shapely.is_geometry(geometry))
    binary = {k: shapely.to_wkb(geometry[k]) for k in held[shapely.get_type_id(geometry[held]) >= _COLLECTION].tolist()}
    own = {k: _read_later(_BinaryReader, data) for k, data in binary.items() if _is_read_here(data)}
    return _with_own(geometry.copy(), own, flatten) if own else Flat(geometry, 0)


def flattened_note(curves: int) -> str:
    """Say how many curves were flattened."""
    return f"{curves} curve{'s' * (curves > 1)} flattened to short line segments"


def _read_later(reader: Callable[[Any], Any], item: Any) -> Callable[[], tuple[Node, int]]:
    return lambda: reader(item).read()


def _with_own(
    geometry: NDArray[np.object_], own: dict[int, Callable[[], tuple[Node, int]]], flatten: float | None
) -> Flat:
    """Put in what is read here; None where that cannot be."""
    import shapely

    lines = Linearizer(flatten)
    for k, read in own.items():
        try:
            node, number = read()
            geometry[k] = shapely.set_srid(lines.geometry(node), number)
        except (ValueError, struct.error, IndexError, KeyError, shapely.errors.ShapelyError):
            geometry[k] = None
    return Flat(geometry, lines.curves)


# ---- text ----------------------------------------------------------------------------------------
class _TextReader:
    """Takes one text apart."""

    def __init__(self, text: str) -> None:
        self._tokens = (match[1] for match in _TOKENS.finditer(text))
        self._token = next(self._tokens, "")

    def read(self) -> tuple[Node, int]:
        """Give the geometry, which must be all of the text; it has no number of a reference system."""
        node = self._tagged()
        if self._token:
            raise ValueError("something follows the geometry")
        return node, 0

    def _tagged(self) -> Node:
        found = _KINDS.fullmatch(self._next())
        if found is None:
            raise ValueError("no kind of geometry")
        marks = (found[2] or "").upper()
        if not marks and self._token.upper() in ("Z", "M", "ZM"):
            marks = self._next().upper()
        return self._body(found[1].upper(), marks)

    def _body(self, kind: str, marks: str) -> Node:
        if self._token.upper() == "EMPTY":
            self._next()
            return Node(kind)
        self._expect("(")
        if kind in LEAVES:
            return Node(kind, self._points(marks))
        parts = [self._part(kind, marks)]
        while self._token == ",":
            self._next()
            parts.append(self._part(kind, marks))
        self._expect(")")
        return Node(kind, parts=parts)

    def _part(self, kind: str, marks: str) -> Node:
        token = self._token
        if token[:1].isalpha() and token.upper() != "EMPTY":
            return self._tagged()
        if kind == "MULTIPOINT" and token != "(" and token.upper() != "EMPTY":
            return Node("POINT", _table([self._point()], marks))
        if not PARTS[kind]:
            raise ValueError("a part of a collection has no kind")
        return self._body(PARTS[kind], marks)

    def _points(self, marks: str) -> NDArray[np.float64]:
        rows = [self._point()]
        while self._token == ",":
            self._next()
            rows.append(self._point())
        self._expect(")")
        return _table(rows, marks)

    def _point(self) -> list[float]:
        row = []
        while self._token not in "(),":
            row.append(_number(self._next()))
        return row

    def _next(self) -> str:
        token, self._token = self._token, next(self._tokens, "")
        return token

    def _expect(self, token: str) -> None:
        if self._next() != token:
            raise ValueError(f"expected {token}")


def _number(token: str) -> float:
    if "_" in token:  # which Python alone takes
        raise ValueError("no number")
    return float(token)


def _table(rows: list[list[float]], marks: str) -> NDArray[np.float64]:
    """Points without their measures: the last number of each, where there are any."""
    sizes = set(map(len, rows))
    if len(sizes) != 1 or not sizes <= {2, 3, 4} or (marks and sizes != {2 + len(marks)}):
        raise ValueError("points have different numbers")
    table = np.array(rows)
    return table[:, :2] if marks == "M" else table[:, :3]


# ---- binary --------------------------------------------------------------------------------------
def _is_read_here(item: bytes | str) -> bool:
    """Whether a geometry may have curves, or be nested so deep that GEOS, which is recursive, would crash."""
    head = _bytes(item[:36]) if isinstance(item, str) else item[:18]
    if len(head) < 18 or head[0] > 1:
        return False
    order: Literal["little", "big"] = "little" if head[0] else "big"
    code = int.from_bytes(head[1:5], order)
    kind = _kind_of(code)
    if kind in CURVED or kind in (*LEAVES, "POLYGON", ""):
        return kind in CURVED
    at = 9 if code & _HAS_NUMBER else 5
    if (
        head[at : at + 4] == (1).to_bytes(4, order) and head[at + 4] == head[0]
    ):  # of one part, which is most often plain
        part = _kind_of(int.from_bytes(head[at + 5 : at + 9], order))
        if part in (*LEAVES[:-1], "POLYGON"):
            return False
    if kind != "GEOMETRYCOLLECTION" and len(item) < _SHORT:
        return False
    try:
        return _BinaryReader(item).has_curves()
    except (ValueError, struct.error):
        return True  # it is read once more, and refused


def _kind_of(code: int) -> str:
    """The kind of geometry that a number stands for; empty if it is none."""
    plain = code & ~(_HAS_Z | _HAS_M | _HAS_NUMBER)
    return _CODES.get(plain % 1000, "") if plain < 4000 else ""


def _bytes(digits: str) -> bytes:
    try:
        return bytes.fromhex(digits)
    except ValueError:
        return b""


class _BinaryReader:
    """Takes one geometry apart."""

    def __init__(self, item: bytes | str) -> None:
        self._data = _bytes(item) if isinstance(item, str) else item
        self._at = 0

    def read(self) -> tuple[Node, int]:
        """Give the geometry and the number of its reference system, or 0."""
        return self._geometry(0)

    def has_curves(self) -> bool:
        """Tell whether there are kinds in it that shapely does not know."""
        pending = [self.read()[0]]
        while pending:
            node = pending.pop()
            if node.kind in CURVED:
                return True
            pending += node.parts if node.kind == "GEOMETRYCOLLECTION" else []
        return False

    def _geometry(self, level: int) -> tuple[Node, int]:
        order = {0: ">", 1: "<"}.get(self._unpack("<B"))
        if order is None or level > _MOST_LEVELS:
            raise ValueError("no order of bytes, or too deep")
        code = self._unpack(order + "I")
        number = self._unpack(order + "I") if code & _HAS_NUMBER else 0
        kind = _kind_of(code)
        if not kind:
            raise ValueError(f"no kind of geometry has the number {code}")
        marks = (code & ~(_HAS_Z | _HAS_M | _HAS_NUMBER)) // 1000
        has_z = bool(code & _HAS_Z) or marks in (1, 3)
        width = 2 + has_z + (bool(code & _HAS_M) or marks in (2, 3))
        taken = 3 if has_z else 2
        if kind == "POINT":
            points = self._points(order, 1, width)[:, :taken]
            return Node(kind, points[~np.isnan(points).all(axis=1)]), number
        count = self._unpack(order + "I")
        if kind in LEAVES:
            return Node(kind, self._points(order, count, width)[:, :taken]), number
        self._check(count, 4)
        if kind in ("POLYGON", "TRIANGLE"):
            sizes = (self._unpack(order + "I") for _ in range(count))
            return Node(
                kind, parts=[Node("LINEARRING", self._points(order, n, width)[:, :taken]) for n in sizes]
            ), number
        return Node(kind, parts=[self._geometry(level + 1)[0] for _ in range(count)]), number

    def _unpack(self, form: str) -> int:
        value: int
        (value,) = struct.unpack_from(form, self._data, self._at)
        self._at += struct.calcsize(form)
        return value

    def _check(self, count: int, size: int) -> None:
        """Refuse a count of what is not there."""
        if count * size > len(self._data) - self._at:
            raise ValueError(f"{count} items are announced, and not there")

    def _points(self, order: str, count: int, width: int) -> NDArray[np.float64]:
        self._check(count, 8 * width)
        numbers = np.frombuffer(self._data, order + "f8", count * width, self._at).astype(np.float64)
        self._at += 8 * count * width
        return numbers.reshape(count, width)
