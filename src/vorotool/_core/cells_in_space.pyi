"""Voronoi cells of points in space: a box is low x, y, z, high x, y, z."""

from collections.abc import Callable
from typing import Any

import numpy
import numpy.typing


def space_cells(points: numpy.typing.NDArray[numpy.float64], tetrahedra: numpy.typing.NDArray[numpy.int32], neighbors: numpy.typing.NDArray[numpy.int32], edges: numpy.typing.NDArray[numpy.int32], first: numpy.typing.NDArray[numpy.int32], box: numpy.typing.NDArray[numpy.float64], threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    vertices; faces, counter-clockwise as seen from outside the first of their cells, the second being -1 - side on the box; faces of each cell. The edges are used where there are no tetrahedra.
    """

def measures(vertices: numpy.typing.NDArray[numpy.float64], face_starts: numpy.typing.NDArray[numpy.int64], corners: numpy.typing.NDArray[numpy.int32], face_cells: numpy.typing.NDArray[numpy.int32], cell_starts: numpy.typing.NDArray[numpy.int64], cell_faces: numpy.typing.NDArray[numpy.int32], threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
    """face_areas, and volumes and areas of cells."""

def find_fault(sites: numpy.typing.NDArray[numpy.float64], vertices: numpy.typing.NDArray[numpy.float64], face_starts: numpy.typing.NDArray[numpy.int64], corners: numpy.typing.NDArray[numpy.int32], face_cells: numpy.typing.NDArray[numpy.int32], cell_starts: numpy.typing.NDArray[numpy.int64], cell_faces: numpy.typing.NDArray[numpy.int32], box: numpy.typing.NDArray[numpy.float64], threads: int, progress: Callable[[float], object] | None) -> str | None: ...
