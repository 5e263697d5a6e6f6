"""Geometry with curves, triangles and surfaces, as lines and polygons that all libraries know."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.circular_strings import flattened_arcs

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
