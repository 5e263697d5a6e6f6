"""
Voronoi cells, and what is computed of them: a frame is left, bottom, right, top.
"""

from collections.abc import Callable, Sequence

import numpy
import numpy.typing

import vorotool._core.delaunay


def voronoi_cells(mesh: vorotool._core.delaunay.Triangulation, frame: Sequence[float], threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int64]]:
    """Vertices of the cells' rings, and where the ring of each point begins."""

def find_cell_fault(sites: numpy.typing.NDArray[numpy.float64], vertices: numpy.typing.NDArray[numpy.float64], starts: numpy.typing.NDArray[numpy.int64], frame: Sequence[float], threads: int, progress: Callable[[float], object] | None) -> str | None: ...

def measure_cells(sites: numpy.typing.NDArray[numpy.float64], vertices: numpy.typing.NDArray[numpy.float64], rings: numpy.typing.NDArray[numpy.int64], cell_rings: numpy.typing.NDArray[numpy.int64], frame: Sequence[float], threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.uint8]]:
    """
    Area, perimeter, distance of the farthest vertex from the site, whether a vertex is on the frame.
    """
