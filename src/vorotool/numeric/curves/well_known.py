"""Well-known text and binary as geometry of shapely; kinds that it does not know are read here, without curves."""

from __future__ import annotations

import itertools
import re
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, crosses, dots, norms
from vorotool.numeric.curves.flatten import chords_of, middles_of
from vorotool.numeric.lazy import shapely

PARTS = {
    "POLYGON": "LINEARRING",
    "TRIANGLE": "LINEARRING",
    "MULTIPOINT": "POINT",
    "MULTILINESTRING": "LINESTRING",
    "MULTIPOLYGON": "POLYGON",
    "GEOMETRYCOLLECTION": "",
    "COMPOUNDCURVE": "LINESTRING",
    "CURVEPOLYGON": "LINEARRING",
    "MULTICURVE": "LINESTRING",
    "MULTISURFACE": "POLYGON",
    "POLYHEDRALSURFACE": "POLYGON",
    "TIN": "TRIANGLE",
}
"""Kinds of geometry that consist of others, and which these are where their kind is left out."""
LEAVES = ("POINT", "LINESTRING", "LINEARRING", "CIRCULARSTRING")
"""Kinds that consist of points."""
CURVED = (
    *("CIRCULARSTRING", "COMPOUNDCURVE", "CURVEPOLYGON", "MULTICURVE", "MULTISURFACE"),
    *("POLYHEDRALSURFACE", "TIN", "TRIANGLE"),
)
"""Kinds that shapely does not know."""


@dataclass
class Node:
    """A geometry as it is written: its kind, and its points or its parts."""

    kind: str  # one of `LEAVES` or `PARTS`
    # (n, d) float64 array: x, y, and z if there is one
    points: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 2)))
    parts: list[Node] = field(default_factory=list)


class Linearizer:
    """Makes geometry of shapely, and counts the curves that it flattens."""

    def __init__(self, flatten: float | None = None) -> None:
        self._flatten = flatten
        self.curves = 0

    def geometry(self, node: Node) -> Any:
        """Give the geometry of shapely for a node."""
        kind, parts = node.kind, node.parts
        if kind == "POINT":
            return shapely.Point(node.points[0]) if len(node.points) else shapely.Point()
        if kind in LEAVES or kind == "COMPOUNDCURVE":
            return shapely.linestrings(self._line(node)) if _has_points(node) else shapely.LineString()
        if kind in ("POLYGON", "CURVEPOLYGON", "TRIANGLE"):
            rings = [self._ring(part) for part in parts if _has_points(part)]
            return shapely.Polygon(rings[0], rings[1:]) if rings else shapely.Polygon()
        made = [self.geometry(part) for part in parts if kind == "GEOMETRYCOLLECTION" or _has_points(part)]
        if kind == "GEOMETRYCOLLECTION":
            return shapely.GeometryCollection(made)
        if kind == "MULTIPOINT":
            return shapely.MultiPoint(made)
        return (
            shapely.MultiLineString(made) if kind in ("MULTILINESTRING", "MULTICURVE") else shapely.MultiPolygon(made)
        )

    def _ring(self, node: Node) -> Any:
        vertices = self._line(node)
        if len(vertices) < 4 or (vertices[0, :2] != vertices[-1, :2]).any():
            raise ValueError("a ring is not closed, or has no area")
        return shapely.linearrings(vertices)

    def _line(self, node: Node) -> NDArray[np.float64]:
        """Vertices of a line, a circular string or a compound of such."""
        if node.kind == "COMPOUNDCURVE":
            pieces = [self._line(part) for part in node.parts if _has_points(part)]
            if any((one[-1, :2] != other[0, :2]).any() for one, other in itertools.pairwise(pieces)):
                raise ValueError("the parts of a compound curve do not begin where the ones before end")
            return np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])
        if node.kind not in LEAVES or node.kind == "POINT":
            raise ValueError(f"a {node.kind} is not a curve")
        if node.kind != "CIRCULARSTRING":
            return node.points
        if len(node.points) < 3 or len(node.points) % 2 == 0:
            raise ValueError(f"a circular string of {len(node.points)} points is not made of arcs")
        self.curves += 1
        return flattened_arcs(node.points, self._flatten)


def _has_points(node: Node) -> bool:
    return len(node.points) > 0 or any(map(_has_points, node.parts))


FLATTEN_ARC = 1 / 2000
"""How far a chord may be from an arc, in diagonals of the box that holds the arc."""

_FINEST = 16
"""Steps of the largest coordinate that a chord may always be off: vertices nearer to each other are rounding."""


def flattened_arcs(points: Floats, flatten: float | None = None) -> Floats:
    """Replace arcs by chords; the points that were given stay vertices."""
    points = np.asarray(points, dtype=np.float64)
    with np.errstate(all="ignore"):  # numbers that are not finite are found by whoever reads the vertices
        a, b, c = points[:-1:2, :2], points[1::2, :2], points[2::2, :2]
        center, is_left = _circles(a, b, c)
        tolerance = _tolerances(a, b, c, center) if flatten is None else np.full(len(a), flatten)
        tolerance = np.maximum(tolerance, _FINEST * np.spacing(np.abs(points[:, :2]).max(initial=0)))
        inner, first = _halves(
            points[:, :2], np.repeat(center, 2, axis=0), np.repeat(is_left, 2), np.repeat(tolerance, 2)
        )
    knots = np.append(first[:-1], len(inner))
    xy = np.concatenate([inner, points[-1:, :2]])
    at = np.arange(len(xy))
    arc = np.minimum(np.searchsorted(knots, at, side="right") - 1, len(knots) - 2)
    part = ((at - knots[arc]) / np.diff(knots)[arc])[:, None]
    rest = points[arc, 2:] + part * (points[arc + 1, 2:] - points[arc, 2:])
    return np.concatenate([xy, rest], axis=1)


def _circles(a: Floats, b: Floats, c: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Centers of circles through three points, NaN where they are on a line; and whether arcs turn left."""
    u, v = b - a, c - a
    turn = 2 * (crosses(u, v))
    p, q = dots(u, u), dots(v, v)
    away = np.stack([v[:, 1] * p - u[:, 1] * q, u[:, 0] * q - v[:, 0] * p], axis=1) / turn[:, None]
    is_whole = (a == c).all(axis=1)
    away = np.where(is_whole[:, None], u / 2, away)
    is_straight = ~np.isfinite(away).all(axis=1) | (a == b).all(axis=1) | (b == c).all(axis=1)
    away[is_straight] = np.nan
    return a + away, (turn > 0) | is_whole


def _tolerances(a: Floats, b: Floats, c: Floats, center: Floats) -> Floats:
    """Fractions of the diagonals of the boxes that hold arcs."""
    radius = norms(a - center)
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    chord, side = c - a, crosses(c - a, b - a)
    for way in ((1, 0), (0, 1), (-1, 0), (0, -1)):
        end = center + radius[:, None] * way
        is_on = ((crosses(chord, end - a) * np.sign(side) > 0) | (a == c).all(axis=1))[:, None]
        low, high = np.where(is_on, np.minimum(low, end), low), np.where(is_on, np.maximum(high, end), high)
    return np.asarray(FLATTEN_ARC * norms(high - low))


def _halves(
    points: Floats, center: Floats, is_left: NDArray[np.bool_], tolerance: Floats
) -> tuple[Floats, NDArray[np.int64]]:
    """Vertices of arcs between points that follow each other, without the last; and where each arc begins."""
    begin, end = points[:-1], points[1:]
    before, after = np.where(is_left[:, None], begin, end), np.where(is_left[:, None], end, begin)
    is_long = crosses(before - center, after - center) < 0
    middle = middles_of(before, after, center, is_long)
    pieces = 1 + is_long
    first = np.concatenate([[0], np.cumsum(pieces)])
    starts = np.empty((first[-1], 2))
    starts[first[:-1]] = begin
    starts[first[:-1][is_long] + 1] = middle[is_long]
    each = np.repeat(np.arange(len(begin)), pieces)
    vertices, at = chords_of(
        starts, np.concatenate([starts[1:], end[-1:]]), center[each], is_left[each], tolerance[each]
    )
    return vertices, at[first]


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
    # of one part, which is most often plain
    if head[at : at + 4] == (1).to_bytes(4, order) and head[at + 4] == head[0]:
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
