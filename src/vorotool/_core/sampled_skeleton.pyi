"""
Approximate skeletons, from the Voronoi diagram of seeds on the edges of a planar graph.
"""

from collections.abc import Callable
from typing import Any

import numpy
import numpy.typing

import vorotool._core.kernel


class TooManySeedsError(Exception):
    pass

LEAST_SAMPLE_GAP: float = 1.52587890625e-05

def sample_by_step(graph: vorotool._core.kernel.PlanarGraph, step: float, most: int, threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
    """
    Seeds, the segment that each is inside of (-1: a point), and where those of each segment begin.
    """

def sample_from_corners(graph: vorotool._core.kernel.PlanarGraph, steps: tuple[numpy.typing.NDArray[numpy.uint64], numpy.typing.NDArray[numpy.float64]], most: int, threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]: ...

def corner_steps(graph: vorotool._core.kernel.PlanarGraph, step: float, is_even: bool, most: int) -> tuple[numpy.typing.NDArray[numpy.uint64], numpy.typing.NDArray[numpy.float64]]:
    """
    Where the distances of each point begin, and how far from it seeds are: at even steps, or doubling up to one.
    """

def refined_steps(graph: vorotool._core.kernel.PlanarGraph, steps: tuple[numpy.typing.NDArray[numpy.uint64], numpy.typing.NDArray[numpy.float64]], start: numpy.typing.NDArray[numpy.int32], parts: numpy.typing.NDArray[numpy.int32], most: int) -> tuple[numpy.typing.NDArray[numpy.uint64], numpy.typing.NDArray[numpy.float64]]:
    """Distances with each piece of an edge divided into so many parts."""

class SampledDiagram:
    def __init__(self, graph: vorotool._core.kernel.PlanarGraph, seeds: numpy.typing.NDArray[numpy.float64], segment: numpy.typing.NDArray[numpy.int32], start: numpy.typing.NDArray[numpy.int32], group: numpy.typing.NDArray[numpy.int32], within: tuple[float, float, float, float] | None, threads: int, progress: Callable[[float], object] | None) -> None:
        """
        Of each point a group that has a diagram of its own, or none of any; triangles are ordered within bounds. These are least and most x, then y, on the lattice.
        """

    @property
    def counts(self) -> dict[str, Any]: ...

    @property
    def walked_pieces(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Pieces of edges that may meet the cells of other seeds than their ends.
        """

    def skeleton(self, face_group: numpy.typing.NDArray[numpy.int32], clipped: tuple[int, tuple[float, float, float, float]] | None, whole: bool, complete: bool, tolerance: float, joined: tuple[int, int], origin_x: float, origin_y: float, scale: float, threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
        """
        Arrays as of extract_skeleton, with error_bound, seeds and parts, and the number of open_corners.
        """
