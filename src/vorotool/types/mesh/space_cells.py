"""Voronoi cells of points in space: polyhedra."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.numeric.arrays import Booleans, Floats
from vorotool.products.formats import resolved
from vorotool.types import fields as f
from vorotool.types.features import Rows
from vorotool.types.fields import record
from vorotool.types.points.point_set import OfPoints
from vorotool.types.table import Table
from vorotool.types.values import Tabular, counted

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
        return resolved("engines.delaunay.space_cells:measures_of")(self)

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
