"""Geometry with curves, circular strings, triangles and surfaces, as plain lines and polygons."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats
from vorotool.numeric.curves.flatten import chords_of, middles_of

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
        import shapely

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
        import shapely

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
    turn = 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    p, q = (u * u).sum(axis=1), (v * v).sum(axis=1)
    away = np.stack([v[:, 1] * p - u[:, 1] * q, u[:, 0] * q - v[:, 0] * p], axis=1) / turn[:, None]
    is_whole = (a == c).all(axis=1)
    away = np.where(is_whole[:, None], u / 2, away)
    is_straight = ~np.isfinite(away).all(axis=1) | (a == b).all(axis=1) | (b == c).all(axis=1)
    away[is_straight] = np.nan
    return a + away, (turn > 0) | is_whole


def _tolerances(a: Floats, b: Floats, c: Floats, center: Floats) -> Floats:
    """Fractions of the diagonals of the boxes that hold arcs."""
    radius = np.sqrt(np.square(a - center).sum(axis=1))
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    chord, side = c - a, _cross(c - a, b - a)
    for way in ((1, 0), (0, 1), (-1, 0), (0, -1)):
        end = center + radius[:, None] * way
        is_on = ((_cross(chord, end - a) * np.sign(side) > 0) | (a == c).all(axis=1))[:, None]
        low, high = np.where(is_on, np.minimum(low, end), low), np.where(is_on, np.maximum(high, end), high)
    return np.asarray(FLATTEN_ARC * np.sqrt(np.square(high - low).sum(axis=1)))


def _cross(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _halves(
    points: Floats, center: Floats, is_left: NDArray[np.bool_], tolerance: Floats
) -> tuple[Floats, NDArray[np.int64]]:
    """Vertices of arcs between points that follow each other, without the last; and where each arc begins."""
    begin, end = points[:-1], points[1:]
    before, after = np.where(is_left[:, None], begin, end), np.where(is_left[:, None], end, begin)
    is_long = _cross(before - center, after - center) < 0
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
