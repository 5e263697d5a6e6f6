"""Edges and triangles that a digital tessellation shows, which need not fit together."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.row_index import check_index
from vorotool.types import fields as f
from vorotool.types.axis import UNSTATED, YAxis
from vorotool.types.fields import record
from vorotool.types.mesh.triangulation import ALL, Mesh, Triangulation, lengths_of
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
