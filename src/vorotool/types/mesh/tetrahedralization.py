"""A Delaunay triangulation of points in space: tetrahedra, triangles and edges."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError
from vorotool.numeric.arrays import Booleans, Floats, norms
from vorotool.numeric.numbers import shown_number
from vorotool.products.formats import resolved
from vorotool.types import fields as f
from vorotool.types.features import Rows
from vorotool.types.fields import record
from vorotool.types.mesh.triangulation import ALL, Triangulated
from vorotool.types.points.point_set import OfPoints
from vorotool.types.table import Computed, Lookup, Table
from vorotool.types.values import Tabular, counted

if TYPE_CHECKING:
    from numpy.typing import NDArray

FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
"""Corners of the face opposite to each corner of a tetrahedron, counter-clockwise as seen from outside."""
EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])
"""Corners at the ends of each edge of a tetrahedron."""


@record
class Tetrahedralization(Triangulated, Tabular):
    """Delaunay triangulation of points in space: tetrahedra, triangles and edges, as 0-based int32 indices.

    The sphere through the corners of a tetrahedron holds no point inside. The cell of points on one sphere is divided
    from its lexicographically smallest vertex, and so are its faces: the tetrahedra depend on the coordinates alone.
    Points in one plane have triangles and no tetrahedra: those of `Triangulation`, in their plane. Points on one line
    have a chain of edges.

    Parameters
    ----------
    points : (n, 3) float64 array
        Coordinates, in the order of the input; finite.
    tetrahedra : (t, 4) int32 array
        Corners of each tetrahedron: the first three are counter-clockwise as seen from the fourth.
    neighbors : (t, 4) int32 array
        The tetrahedron across the face opposite to each corner, -1 on the hull.
    planar : (k, 3) int32 array
        Triangles of points that lie in one plane, else none.
    first : (n,) int32 array
        Index of the first point at the place of each point. Duplicates are in no tetrahedron.
    labels : (n,) int64 array, optional
        The input's own labels. Without them point i has label i + 1.
    properties : dict of str to sequence, optional
        Other columns of the input, one value per point.
    index : pandas Index, array or sequence, optional
        Names of the points in the input, such as the row index of a data frame: one entry per point.

    Raises
    ------
    InputError
        If an array has another shape.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 4, which leaves three dimensions open.

    Examples
    --------
    >>> from vorotool import delaunay
    >>> corner = delaunay([[0, 0, 0], [4, 0, 0], [0, 3, 0], [0, 0, 2]])
    >>> corner.tetrahedra.tolist(), corner.volumes.tolist(), len(corner.triangles), len(corner.edges)
    ([[0, 3, 1, 2]], [4.0], 4, 6)
    """

    maker = "delaunay"

    points: NDArray[np.float64] = f.position("points", 3)
    tetrahedra: NDArray[np.int32] = f.index("tetrahedra", 4)
    neighbors: NDArray[np.int32] = f.index("tetrahedra", 4)
    planar: NDArray[np.int32] = f.index("planar", 3)
    first: NDArray[np.int32] = f.index("points")
    labels: NDArray[np.int64] | None = f.numbers(np.int64, "points", default=None)
    properties: dict[str, Any] = field(default_factory=dict)
    index: Any = None

    def __len__(self) -> int:
        return len(self.tetrahedra)

    @property
    def dimension(self) -> int:
        """3 if there are tetrahedra, else 2 in a plane, 1 on a line, 0 of one place, -1 without points."""
        if len(self.tetrahedra) or len(self.planar):
            return 3 if len(self.tetrahedra) else 2
        return min(len(self.points) - self.duplicates, 2) - 1

    # ---- parts
    @cached_property
    def triangles(self) -> NDArray[np.int32]:
        """Return the (m, 3) triangles, those of the hull counter-clockwise as seen from outside."""
        if not len(self.tetrahedra):
            return self.planar
        t, face = np.nonzero(self.neighbors < np.arange(len(self))[:, None])
        return self._faces(t, face)

    @cached_property
    def hull(self) -> NDArray[np.int32]:
        """Return the (h, 3) triangles of the convex hull, counter-clockwise as seen from outside; none in a plane."""
        return self._faces(*np.nonzero(self.neighbors < 0))

    @cached_property
    def edges(self) -> NDArray[np.int32]:
        """Return the (e, 2) edges in the order of their ends, smaller index first; on a line the chain."""
        cells = self.tetrahedra if len(self.tetrahedra) else self.planar
        if not len(cells):
            return self._chain()
        pairs = EDGES if cells.shape[1] == 4 else EDGES[[0, 1, 3]]
        corners = cells.T.astype(np.int64)
        ends = [(corners[i], corners[j]) for i, j in pairs]
        keys = np.concatenate([np.minimum(a, b) << 32 | np.maximum(a, b) for a, b in ends])
        keys.sort()  # numpy.unique takes 25 times as long
        found = keys[np.diff(keys, prepend=-1) > 0]
        return np.stack([found >> 32, found & 0xFFFFFFFF], axis=1).astype(np.int32)

    def _chain(self) -> NDArray[np.int32]:
        chosen = np.flatnonzero(~self.is_duplicate)
        order = chosen[np.lexsort(self.points[chosen].T[::-1])].astype(np.int32)
        pairs = np.sort(np.stack([order[:-1], order[1:]], axis=1), axis=1)
        return pairs[np.lexsort(pairs.T[::-1])]

    def _faces(self, t: NDArray[np.intp], face: NDArray[np.intp]) -> NDArray[np.int32]:
        return self.tetrahedra[t[:, None], FACES[face]]

    # ---- measures
    def edge_lengths(self, rows: slice = ALL) -> Floats:
        """Return the (e,) lengths of all or some edges."""
        a, b = self.points[self.edges[rows].T]
        return scaled_norms(b - a)

    @cached_property
    def volumes(self) -> Floats:
        """Return the (t,) positive volumes of the tetrahedra."""
        return self._spheres[1]

    @cached_property
    def circumcenters(self) -> Floats:
        """Return the (t, 3) centers of the spheres through the corners; infinite beyond the largest double."""
        with np.errstate(over="ignore"):
            centers: Floats = self.points[self.tetrahedra[:, 0]] + self.ways_to_centers
        return centers

    @cached_property
    def circumradii(self) -> Floats:
        """Return the (t,) radii of the spheres through the corners."""
        return scaled_norms(self.ways_to_centers)

    @property
    def ways_to_centers(self) -> Floats:
        """(t, 3) vectors from the first corner of each tetrahedron to the center of its sphere."""
        return self._spheres[0]

    @cached_property
    def _spheres(self) -> tuple[Floats, Floats]:
        """Ways to centers within 2^-43 of their lengths, and volumes within 2^-44 of theirs."""
        return resolved("engines.delaunay.tetrahedralization:spheres")(self)

    # ---- tables
    def _rows(self, what: str | None = None) -> Rows:
        parts = {"tetrahedra": "abcd", "triangles": "abc", "hull": "abc", "edges": "ab"}
        name = what or "tetrahedra"
        if name == "table":
            return Rows(resolved("engines.delaunay.tetrahedralization:space_table")(self))
        if name not in parts:
            raise UsageError(
                f"invalid what {shown_number(what)}: expected {', '.join([*parts, 'table'])} of a Tetrahedralization"
            )
        corners: NDArray[np.int32] = getattr(self, name)
        labels = self.label_array
        columns: dict[str, Any] = {
            f"label_{letter}": Lookup(labels, corner) for letter, corner in zip(parts[name], corners.T, strict=True)
        }
        if name == "edges":
            columns["length"] = Computed(self.edge_lengths, len(corners))
        return Rows(Table(columns))

    def _matrix(self, what: str | None) -> NDArray[np.int32]:
        return getattr(self, what or "tetrahedra")

    def _summary(self) -> str:
        sizes = counted(len(self.points), "point"), counted(len(self), "tetrahedron", "tetrahedra")
        return ", ".join(sizes)


def scaled_norms(ways: Floats) -> Floats:
    """Lengths of (n, 3) vectors, scaled by powers of two so that none overflows on the way."""
    exponent = np.frexp(np.abs(ways).max(axis=1, initial=0.0))[1]
    scaled = np.ldexp(ways, -exponent[:, None])
    with np.errstate(over="ignore", under="ignore"):
        lengths: Floats = np.ldexp(norms(scaled), exponent)
    return lengths


BOX_SIDES = ("low x", "high x", "low y", "high y", "low z", "high z")
"""Sides of the box, as -1 - k stands for them in `face_cells`."""


@record
class SpaceCellSet(OfPoints, Tabular):
    """Voronoi cells of points in space, clipped to a box: convex polyhedra, one per point, in the order of the points.

    A cell that meets the box nowhere, or in no volume, has no faces; so has that of a point which lies on an earlier
    one. Cells share vertices and faces.

    Parameters
    ----------
    sites : (n, 3) float64 array
        The points.
    vertices : (v, 3) float64 array
        The doubles nearest to the exact vertices; vertices that differ may be at the same doubles.
    face_starts : (f + 1,) int64 array
        Where the corners of each face begin in `corners`, and the end.
    corners : (c,) int32 array
        Vertices of the faces, counter-clockwise as seen from outside the first of their cells.
    face_cells : (f, 2) int32 array
        The cells on both sides of each face, the smaller index first. In place of the second -1, -2, … -6 are the sides
        of the box: low x, high x, low y, high y, low z, high z.
    cell_starts : (n + 1,) int64 array
        Where the faces of each cell begin in `cell_faces`, and the end.
    cell_faces : (k,) int32 array
        Faces of each cell: those to other cells in the order of these, then those on the box.
    box : (2, 3) float64 array
        The lowest and the highest corner of what the cells were clipped to.
    labels : (n,) int64 array, optional
        The input's own labels. Without them point i has label i + 1.
    properties : dict of str to sequence, optional
        Other columns of the input, one value per point.
    index : pandas Index, array or sequence, optional
        Names of the points in the input, such as the row index of a data frame: one entry per point.

    Raises
    ------
    InputError
        If the arrays do not fit together.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 4, which leaves three dimensions open.

    Examples
    --------
    >>> from vorotool import voronoi_cells
    >>> cells = voronoi_cells([[1, 1, 1], [3, 1, 1]], frame=(0, 0, 0, 4, 2, 2))
    >>> cells.volumes.tolist(), cells.areas.tolist(), cells.face_cells[0].tolist()
    ([8.0, 8.0], [24.0, 24.0], [0, 1])
    >>> cells.vertices[cells.face(0)].tolist()
    [[2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 2.0, 2.0], [2.0, 0.0, 2.0]]
    """

    maker = "voronoi_cells"
    _places = "sites"

    sites: NDArray[np.float64] = f.position("sites", 3)
    vertices: NDArray[np.float64] = f.position("vertices", 3)
    face_starts: NDArray[np.int64] = f.starts("faces", "corners", least=3)
    corners: NDArray[np.int32] = f.index("corners")
    face_cells: NDArray[np.int32] = f.index("faces", 2)
    cell_starts: NDArray[np.int64] = f.starts("sites", "cell_faces")
    cell_faces: NDArray[np.int32] = f.index("cell_faces")
    box: NDArray[np.float64] = f.position(2, 3)
    labels: NDArray[np.int64] | None = f.numbers(np.int64, "sites", default=None)
    properties: dict[str, Any] = field(default_factory=dict)
    index: Any = None

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, least, end in (
            ("corners", 0, len(self.vertices)),
            ("face_cells", -len(BOX_SIDES), len(self.sites)),
            ("cell_faces", 0, len(self.face_cells)),
        ):
            values = getattr(self, name)
            if values.size and (values.min() < least or values.max() >= end):
                raise InputError(f"{name} must be from {least} to {end - 1}")

    def __len__(self) -> int:
        return len(self.sites)

    @property
    def is_empty(self) -> Booleans:
        """(n,) whether each cell is empty."""
        return np.diff(self.cell_starts) == 0

    def face(self, face: int) -> NDArray[np.int32]:
        """Return the vertices of a face, counter-clockwise as seen from outside the first of its cells.

        Parameters
        ----------
        face : int
            Its index.

        Returns
        -------
        (k,) int32 array
            Indices of vertices, at least three.
        """
        return self.corners[self.face_starts[face] : self.face_starts[face + 1]]

    # ---- measures
    @cached_property
    def volumes(self) -> Floats:
        """Return the (n,) volumes of the cells, 0 of empty ones.

        The error is about 2e-15 times the cube of a cell's diameter.
        """
        return self._measures["volumes"]

    @cached_property
    def areas(self) -> Floats:
        """Return the (n,) areas of the surfaces of the cells, 0 of empty ones."""
        return self._measures["areas"]

    @cached_property
    def face_areas(self) -> Floats:
        """Return the (f,) areas of the faces."""
        return self._measures["face_areas"]

    @cached_property
    def _measures(self) -> dict[str, Any]:
        return resolved("engines.delaunay.tetrahedralization:measures_of")(self)

    @cached_property
    def neighbor_counts(self) -> NDArray[np.int64]:
        """Return the (n,) numbers of cells that each cell shares a face with."""
        pairs = self.face_cells[self.face_cells[:, 1] >= 0]
        return np.bincount(pairs.reshape(-1), minlength=len(self))

    # ---- tables
    def _rows(self, _what: str | None = None) -> Rows:
        x, y, z = np.ascontiguousarray(self.sites.T)
        columns: dict[str, Any] = {
            "label": self.label_array,
            "x": x,
            "y": y,
            "z": z,
            "volume": self.volumes,
            "area": self.areas,
            "faces": np.diff(self.cell_starts),
            "neighbors": self.neighbor_counts,
        }
        return Rows(Table(columns).with_properties(self.properties))

    def _summary(self) -> str:
        empty = int(np.count_nonzero(self.is_empty))
        cells = counted(len(self), "cell") + (f" ({empty} empty)" if empty else "")
        return f"{cells}, {counted(len(self.face_cells), 'face')}, {counted(len(self.vertices), 'vertex', 'vertices')}"
