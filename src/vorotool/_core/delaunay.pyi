"""Delaunay triangulations, and their check: points are finite."""

from collections.abc import Callable
from typing import Any

import numpy
import numpy.typing


class DelaunayTriangulation:
    def __init__(self, points: numpy.typing.NDArray[numpy.float64], threads: int, progress: Callable[[float], object] | None) -> None: ...

    def arrays(self, threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
        """The arrays of a Triangulation but its points."""

class Triangulation:
    def __init__(self, points: numpy.typing.NDArray[numpy.float64], triangles: numpy.typing.NDArray[numpy.int32], neighbors: numpy.typing.NDArray[numpy.int32], edges: numpy.typing.NDArray[numpy.int32], hull: numpy.typing.NDArray[numpy.int32], first: numpy.typing.NDArray[numpy.int32]) -> None: ...

def insert_points(mesh: Triangulation, points: numpy.typing.NDArray[numpy.float64], hints: numpy.typing.NDArray[numpy.int32], threads: int, progress: Callable[[float], object] | None) -> dict[str, Any] | None:
    """
    Of the points of the mesh and further ones triangles, neighbors, edges, hull and first; None where the order of triangles that stay would change.
    """

def find_fault(mesh: Triangulation, threads: int, progress: Callable[[float], object] | None) -> str | None: ...

def nearest_neighbors(points: numpy.typing.NDArray[numpy.float64], edges: numpy.typing.NDArray[numpy.int32], labels: numpy.typing.NDArray[numpy.int64], progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
    """
    Index of the nearest point of each, -1 without any, and its number of neighbors.
    """
