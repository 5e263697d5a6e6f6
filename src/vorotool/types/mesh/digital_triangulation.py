"""Edges and triangles of a digital tessellation, which need not fit, and how they differ from the exact ones."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.equality import check_index
from vorotool.plain import plain
from vorotool.types import fields as f
from vorotool.types.axis import UNSTATED, YAxis
from vorotool.types.features import Rows
from vorotool.types.fields import record
from vorotool.types.mesh.triangulation import ALL, Mesh, Triangulation, lengths_of
from vorotool.types.table import Table
from vorotool.types.values import Graph, Pictured, Tabular, Value, WithParts, counted, placed


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
        sides: NDArray[np.int32] = np.unique(np.sort(pairs, axis=1), axis=0)
        return sides

    def _summary(self) -> str:
        sizes = (counted(len(self.points), "site"), counted(len(self), "triangle"), counted(len(self.edges), "edge"))
        return placed(", ".join(sizes), self.crs)


AnyTriangulation = Triangulation | DigitalTriangulation
"""Any value with points, edges and triangles to write or draw, whether or not these fit together."""


@plain(eq=False, repr=False)
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
