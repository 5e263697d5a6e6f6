"""Triangulations: of points, and those that follow from a label image."""

from __future__ import annotations

from dataclasses import field
from fractions import Fraction
from functools import cached_property
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vorotool.frozen import frozen
from vorotool.numeric.arrays import dots, norms
from vorotool.numeric.checks import check_index
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.numbers import nearest_double
from vorotool.products.formats import resolved
from vorotool.types import fields as f
from vorotool.types.box import Box
from vorotool.types.features import Rows
from vorotool.types.fields import UNSTATED, YAxis, record
from vorotool.types.points.point_set import OfPoints
from vorotool.types.table import Table
from vorotool.types.values import Graph, Pictured, Tabular, Value, WithParts, counted

FLAT = 2.0**-20
"""Triangles whose largest angle has a smaller sine are computed in rationals: floating point would lose half."""


ALL = slice(None)

CHUNK = 1 << 14
"""Edges that are measured at a time, so that their ends stay in the cache."""


class Mesh:
    """What has edges and maybe triangles, in files and frames."""

    def _rows(self, what: str | None = None) -> Rows:
        of_parts = {"triangles": "triangle_table", "table": "point_table"}
        return Rows(resolved(f"types.mesh.tables:{of_parts.get(what or '', 'edge_table')}")(self))

    def _features(self, what: str | None = None, _flatten: float | None = None) -> Rows:
        return resolved("types.mesh.tables:mesh_features")(self, what)

    def _matrix(self: Any, what: str) -> NDArray[np.int32]:
        return self.edges if what == "edges" else self.triangles


class Triangulated(OfPoints):
    """What is made of points, of which several may lie at one place."""

    _places = "points"

    first: NDArray[np.int32]

    @property
    def is_duplicate(self) -> NDArray[np.bool_]:
        """(n,) mask of points that lie on an earlier one."""
        return self.first != np.arange(len(self.first))

    @property
    def duplicates(self) -> int:
        """Number of duplicate points."""
        return int(np.count_nonzero(self.first != np.arange(len(self.first))))


@record
class Triangulation(Mesh, Triangulated, Tabular, WithParts, Graph, Pictured):
    """Triangles, edges and hull of points, as 0-based int32 indices.

    Triangles and edges follow a Morton curve through the points: their order depends on the coordinates, not on the
    numbering. They are grouped by their vertex that is earliest on the curve, counter-clockwise around it from its
    earliest neighbor; a triangle begins with that vertex. Collinear points, and fewer than three, have no triangles:
    their edges form a chain. Each cocircular polygon is a fan from its lexicographically smallest vertex.

    Parameters
    ----------
    points : (n, 2) float64 array
        Coordinates, in the order of the input; finite.
    triangles : (t, 3) int32 array
        Vertices of each triangle, counter-clockwise: a positive shoelace sum on the coordinates as stored.
    neighbors : (t, 3) int32 array
        The triangle across the edge opposite to each vertex, -1 on the hull.
    edges : (e, 2) int32 array
        Ends of each edge, the smaller index first.
    hull : (h,) int32 array
        Vertices on the hull, including those inside its sides, counter-clockwise from the lexicographically smallest;
        the whole chain if there are no triangles.
    first : (n,) int32 array
        Index of the first point at the place of each point. Duplicates are in no triangle.
    labels : (n,) int64 array, optional
        The input's own labels. Without them point i has label i + 1.
    properties : dict of str to sequence, optional
        Other columns of the input, one value per point.
    y_axis : {"none", "up", "down"}
        Direction of y where the coordinates come from; "none" where nothing states it.
    crs : object, optional
        The ``crs`` member of a GeoJSON input.
    first_number : {1, 0}
        Number of the first point in files of Triangle, as in the ``.node`` file of the input.
    index : pandas Index, array or sequence, optional
        Names of the points in the input, such as the row index of a data frame: one entry per point.
    frame : Box, optional
        The rectangle covered by the pixels of the image that the points come from: the default frame of what is made
        of them.

    Raises
    ------
    InputError
        If an array has another shape.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.1.

    Examples
    --------
    >>> triangle = Triangulation([[0, 0], [4, 0], [0, 3]], [[0, 1, 2]], [[-1, -1, -1]], [[0, 1], [0, 2], [1, 2]],
    ...                          [0, 1, 2], [0, 1, 2])
    >>> triangle.circumcenters.tolist(), triangle.circumradii.tolist(), triangle.areas.tolist()
    ([[2.0, 1.5]], [2.5], [6.0])
    """

    maker = "delaunay"

    points: NDArray[np.float64] = f.position("points", 2)
    triangles: NDArray[np.int32] = f.index("triangles", 3)
    neighbors: NDArray[np.int32] = f.index("triangles", 3)
    edges: NDArray[np.int32] = f.index("edges", 2)
    hull: NDArray[np.int32] = f.index("hull")
    first: NDArray[np.int32] = f.index("points")
    labels: NDArray[np.int64] | None = f.numbers(np.int64, "points", default=None)
    properties: dict[str, Any] = field(default_factory=dict)
    y_axis: YAxis = f.y_axis(default=UNSTATED)
    crs: Any = None
    first_number: int = 1
    index: Any = None
    frame: Box | None = f.input_box()

    def __len__(self) -> int:
        return len(self.triangles)

    @classmethod
    def from_triangles(cls, points: Any, triangles: ArrayLike) -> Triangulation:
        """Make a triangulation of points and triangles from elsewhere, such as scipy's or Triangle's.

        Parameters
        ----------
        points : (n, 2) array, or points as `vorotool.delaunay` takes them
            The points.
        triangles : (t, 3) array of int
            Indices from 0 of the corners of each triangle, in either direction.

        Returns
        -------
        Triangulation
            With the triangles in their order, all counter-clockwise. Whether it is Delaunay is for
            `vorotool.verify_triangulation` to say.

        Raises
        ------
        InputError
            If an index is out of range, a triangle has no area, two overlap along an edge, or the triangles do not
            fill one region without holes.

        Examples
        --------
        >>> square = [[0, 0], [2, 0], [2, 1], [0, 1]]
        >>> mesh = Triangulation.from_triangles(square, [[0, 1, 2], [3, 2, 0]])
        >>> mesh.triangles.tolist(), mesh.neighbors.tolist(), mesh.hull.tolist()
        ([[0, 1, 2], [3, 0, 2]], [[-1, 1, -1], [0, -1, -1]], [0, 1, 2, 3])
        """
        return resolved("engines.delaunay.delaunay:triangulation_of")(points, triangles)

    def edge_lengths(self, rows: slice = ALL) -> NDArray[np.float64]:
        """Return the (e,) lengths of all or some edges, to a relative error of 1e-15; infinite on overflow."""
        return lengths_of(self.points, self.edges[rows])

    @cached_property
    def hull_edges(self) -> NDArray[np.bool_]:
        """Return the (e,) mask of edges on the hull; without triangles all edges are."""
        if not len(self.triangles):
            return np.ones(len(self.edges), dtype=bool)
        onward = np.full(len(self.points), -1, dtype=np.int32)  # next vertex on the hull
        onward[self.hull] = np.roll(self.hull, -1)
        a, b = self.edges.T
        return (onward[a] == b) | (onward[b] == a)

    @cached_property
    def circumcenters(self) -> NDArray[np.float64]:
        """Return the (t, 2) circumcenters of the triangles.

        The error is at most about 1e-9 times the circumradius, nearly always about 1e-15 times, plus the rounding of
        the result. A center beyond the largest double is infinite.
        """
        return self._circles()[0]

    @cached_property
    def circumradii(self) -> NDArray[np.float64]:
        """Return the (t,) circumradii, to a relative error of at most about 1e-9, nearly always about 1e-15."""
        return self._circles()[1]

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Return the (t,) positive areas of the triangles.

        The error is about 1e-15 times the product of the two shorter sides; triangles flat beyond that are exact to
        rounding.
        """
        _, b, c, _, exponent = self._corners()
        cross, flat = _cross(b, c)
        with np.errstate(over="ignore", under="ignore"):
            areas = np.ldexp(0.5 * cross, 2 * exponent)
        for t in np.flatnonzero(flat):
            areas[t] = nearest_double(abs(_exact_cross(self.points[self.triangles[t]])) / 2)
        return areas

    def _circles(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        a, b, c, scale, exponent = self._corners()
        cross, flat = _cross(b, c)
        b2, c2 = dots(b, b), dots(c, c)
        with np.errstate(all="ignore"):  # flat triangles divide by zero and are done again
            x = (c[:, 1] * b2 - b[:, 1] * c2) / (2 * cross)
            y = (b[:, 0] * c2 - c[:, 0] * b2) / (2 * cross)
            centers = np.ldexp(np.ldexp(np.stack([x, y], axis=1), (exponent - scale)[:, None]) + a, scale)
            radii = np.ldexp(hypotenuse(x, y), exponent)
        for t in np.flatnonzero(flat):
            centers[t], radii[t] = _exact_circle(self.points[self.triangles[t]])
        return centers, radii

    def _corners(self) -> tuple[NDArray[np.float64], ...]:
        """The vertex opposite to the longest side (times 2^-scale), and the way to the others (times 2^-exponent)."""
        scale = 4 if np.abs(self.points).max(initial=0.0) > 2.0**1000 else 0
        corners = np.ldexp(self.points, -scale)[self.triangles]
        sides = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)  # opposite to each vertex
        largest = np.abs(sides).max(axis=(1, 2), initial=0.0)
        exponent = np.frexp(largest)[1]
        sides = np.ldexp(np.ldexp(sides, -(exponent // 2)[:, None, None]), (exponent // 2 - exponent)[:, None, None])
        apex = dots(sides, sides).argmax(axis=1)
        rows = np.arange(len(corners))
        b, c = sides[rows, (apex + 2) % 3], -sides[rows, (apex + 1) % 3]
        return corners[rows, apex], b, c, np.asarray(scale), exponent + scale

    def _summary(self) -> str:
        sizes = (counted(len(self.points), "point"), counted(len(self), "triangle"), counted(len(self.edges), "edge"))
        return ", ".join(sizes)


def lengths_of(points: NDArray[np.float64], edges: NDArray[np.int32]) -> NDArray[np.float64]:
    """(e,) distances between the ends of edges; relative error below 1e-15, infinite beyond the largest double."""
    lengths = np.empty(len(edges))
    for start in range(0, len(lengths), CHUNK):
        ends = edges[start : start + CHUNK]
        a, b = points.take(ends[:, 0], axis=0), points.take(ends[:, 1], axis=0)
        with np.errstate(over="ignore", under="ignore", invalid="ignore"):
            way = b - a
            square = way[:, 0] * way[:, 0] + way[:, 1] * way[:, 1]
            found = np.sqrt(square, out=lengths[start : start + CHUNK])
            far = np.flatnonzero(~((square >= 2.0**-900) & (square < np.inf)))
            if not far.size:  # or else coordinates are scaled by powers of two
                continue
            shift = np.where(np.isfinite(way[far]).all(axis=1), 0, 2)
            way = np.ldexp(b[far], -shift[:, None]) - np.ldexp(a[far], -shift[:, None])
            exponent = np.frexp(np.abs(way).max(axis=1))[1]
            way = np.ldexp(way, -exponent[:, None])
            found[far] = np.ldexp(norms(way), exponent + shift)
    return lengths


def _cross(b: NDArray[np.float64], c: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Twice the area of each triangle, and where cancellation makes it useless."""
    left, right = b[:, 0] * c[:, 1], b[:, 1] * c[:, 0]
    cross = left - right
    return cross, ~(np.abs(cross) >= FLAT * (np.abs(left) + np.abs(right)))


def _exact_cross(triangle: NDArray[np.float64]) -> Fraction:
    (ax, ay), (bx, by), (cx, cy) = ((Fraction(x), Fraction(y)) for x, y in triangle.tolist())
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def _exact_circle(triangle: NDArray[np.float64]) -> tuple[tuple[float, float], float]:
    """Center and radius of one circle, from rationals."""
    (ax, ay), (bx, by), (cx, cy) = ((Fraction(x), Fraction(y)) for x, y in triangle.tolist())
    bx, by, cx, cy = bx - ax, by - ay, cx - ax, cy - ay
    b2, c2, cross = bx * bx + by * by, cx * cx + cy * cy, bx * cy - by * cx
    x, y = (cy * b2 - by * c2) / (2 * cross), (bx * c2 - cx * b2) / (2 * cross)
    return (nearest_double(ax + x), nearest_double(ay + y)), _root(x * x + y * y)


def _root(value: Fraction) -> float:
    """The square root of a fraction of any size."""
    shift = (value.numerator.bit_length() - value.denominator.bit_length()) // 2
    reduced = sqrt(value / Fraction(4) ** shift)
    return nearest_double(Fraction(reduced) * Fraction(2) ** shift)


@record
class DigitalTriangulation(Mesh, Value, Tabular, WithParts, Graph, Pictured):
    """Edges and triangles of a label image by the rule of section 2.1, as 0-based int32 indices.

    It is not a `Triangulation`: triangles may overlap or be flat, and a side of a triangle need not be an edge.

    Parameters
    ----------
    points : (n, 2) float64 array
        Position of each region's site: the seed, or the centroid of an object; in increasing order of labels.
    edges : (e, 2) int32 array
        Regions that share a pixel side, the smaller index first, in lexicographic order.
    triangles : (t, 3) int32 array
        Regions of a pixel and two of its 4-neighbors that are 8-neighbors of each other: the smallest index first,
        then counter-clockwise (collinear sites: in increasing order), in lexicographic order of the sorted indices.
    at_four : (t,) bool array
        Whether the triangle was found at a corner where four labels meet. All four triples of these are triangles.
    labels : (n,) int64 array
        Label of each region.
    three_label_corners, four_label_corners : int
        Numbers of corners of the pixel lattice at which three and four labels meet.
    properties : dict of str to sequence, optional
        Other columns of the input, one value per site.
    y_axis : {"none", "up", "down"}
        Direction of y where the coordinates come from; "none" where nothing states it.
    crs : object, optional
        The ``crs`` member of a GeoJSON input.
    index : pandas Index, array or sequence, optional
        Names of the sites in the input, such as the row index of a data frame: one entry per site.

    Raises
    ------
    InputError
        If an array has another shape.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.1.

    Examples
    --------
    >>> points, edges = [[0, 0], [3, 0], [0, 3]], [[0, 1], [0, 2], [1, 2]]
    >>> corner = DigitalTriangulation(points, edges, [[0, 1, 2]], [False], [1, 2, 3])
    >>> len(corner), corner.sides.tolist()
    (1, [[0, 1], [0, 2], [1, 2]])
    """

    maker = "digital_triangulation"

    points: NDArray[np.float64] = f.position("points", 2)
    edges: NDArray[np.int32] = f.index("edges", 2)
    triangles: NDArray[np.int32] = f.index("triangles", 3)
    at_four: NDArray[np.bool_] = f.numbers(np.bool_, "triangles")
    labels: NDArray[np.int64] = f.numbers(np.int64, "points")
    three_label_corners: int = 0
    four_label_corners: int = 0
    properties: dict[str, Any] = field(default_factory=dict)
    y_axis: YAxis = f.y_axis(default=UNSTATED)
    crs: Any = None
    index: Any = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_index(self.index, len(self.points), "site")

    def __len__(self) -> int:
        return len(self.triangles)

    @property
    def label_array(self) -> NDArray[np.int64]:
        """Return the (n,) labels of the regions."""
        return self.labels

    def edge_lengths(self, rows: slice = ALL) -> NDArray[np.float64]:
        """Return the (e,) distances between the sites of all or some edges."""
        return lengths_of(self.points, self.edges[rows])

    @cached_property
    def sides(self) -> NDArray[np.int32]:
        """Return the (s, 2) sides of the triangles, each once, smaller index first, in lexicographic order."""
        pairs = self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        return np.unique(np.sort(pairs, axis=1), axis=0)

    def _summary(self) -> str:
        sizes = (counted(len(self.points), "site"), counted(len(self), "triangle"), counted(len(self.edges), "edge"))
        return ", ".join(sizes)


AnyTriangulation = Triangulation | DigitalTriangulation
"""Any value with points, edges and triangles to write or draw, whether or not these fit together."""


@frozen(eq=False, repr=False)
class DigitalComparison(Value, Tabular):
    """Precision and recall of a digital triangulation, and every difference with its cause.

    Ties are allowed: an edge or triangle is right if some Delaunay triangulation of the sites has it, and must be
    there if all of them have it.

    Parameters
    ----------
    edge_precision, edge_recall, triangle_precision, triangle_recall : float
        Fraction of the results that are right, and of the required ones that are found; 1 if there are none.
    differences : Table
        One row per difference: ``kind`` (edge or triangle), ``difference`` (missing, false or tie), ``label_a``,
        ``label_b``, ``label_c`` (of triangles), ``cause``, and ``voronoi_length``: pixels of the Voronoi edge that
        explains it, inside the frame, where there is one.
    counts : dict of str to int
        Differences by ``kind difference cause``.
    suggestion : str
        A frame or scale at which most of the missing ones would be found.

    Examples
    --------
    >>> DigitalComparison(1.0, 0.5, 1.0, 1.0, Table({}), {"edge missing off_frame": 1}, "").summary()
    'edges: precision 1.000, recall 0.500; triangles: precision 1.000, recall 1.000; 1 edge missing (off_frame 1)'
    """

    edge_precision: float
    edge_recall: float
    triangle_precision: float
    triangle_recall: float
    differences: Table
    counts: dict[str, int]
    suggestion: str

    def summary(self) -> str:
        """Return a summary in one line."""
        parts = [
            f"edges: precision {self.edge_precision:.3f}, recall {self.edge_recall:.3f}",
            f"triangles: precision {self.triangle_precision:.3f}, recall {self.triangle_recall:.3f}",
        ]
        causes: dict[tuple[str, str], dict[str, int]] = {}
        for name, count in self.counts.items():
            kind, difference, cause = name.split()
            causes.setdefault((kind, difference), {})[cause] = count
        for (kind, difference), by_cause in causes.items():
            total = sum(by_cause.values())
            listed = ", ".join(f"{cause} {count}" for cause, count in by_cause.items())
            parts.append(f"{total} {kind}{'s' if total > 1 else ''} {difference} ({listed})")
        return "; ".join(parts)

    def _rows(self, _what: str | None = None) -> Rows:
        return Rows(self.differences)

    def _summary(self) -> str:
        return self.summary()
