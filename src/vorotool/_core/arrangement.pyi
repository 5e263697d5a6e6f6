"""Placement on the lattice, planar graphs, and their check."""

from collections.abc import Callable
from typing import Any

import numpy
import numpy.typing

import vorotool._core.kernel


class TooManyCrossingsError(ValueError):
    pass

class TooManyOverlapsError(ValueError):
    pass

def place_on_lattice(points: numpy.typing.NDArray[numpy.float64], threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int32], tuple[float, float], int, float]:
    """
    Lattice points, origin, exponent of the step and the largest move; the points must be finite.
    """

def first_at_place(points: numpy.typing.NDArray[numpy.int32], progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.int32]:
    """For each lattice point the smallest index of one at the same place."""

def make_planar_graph(vertices: numpy.typing.NDArray[numpy.int32], ring_starts: numpy.typing.NDArray[numpy.int64], ring_kind: numpy.typing.NDArray[numpy.int8], ring_polygon: numpy.typing.NDArray[numpy.int32], progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    Arrays of a PlanarGraph; repairs: of each kind the count, an edge, and what meets it or -1.
    """

def boundary_rings(graph: vorotool._core.kernel.PlanarGraph, face_starts: numpy.typing.NDArray[numpy.int32], face_polygon: numpy.typing.NDArray[numpy.int32], progress: Callable[[float], object] | None) -> dict[str, Any]:
    """The indices of faces must be in range."""

def polygon_faults(points: numpy.typing.NDArray[numpy.float64], ring_starts: numpy.typing.NDArray[numpy.int64], polygon_starts: numpy.typing.NDArray[numpy.int64], is_coverage: bool, threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.uint8]:
    """
    Of each polygon 1 if it is not seen to be one simple ring, 2 if it clashes with others of its coverage.
    """

def find_fault(points: numpy.typing.NDArray[numpy.int32], segments: numpy.typing.NDArray[numpy.int32], faces: numpy.typing.NDArray[numpy.int32] | None, progress: Callable[[float], object] | None) -> str | None: ...
