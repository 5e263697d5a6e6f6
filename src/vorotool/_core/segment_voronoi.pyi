"""Segment Voronoi diagrams, and their check."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy
import numpy.typing

import vorotool._core.kernel


def unwanted_sides(graph: vorotool._core.kernel.PlanarGraph, is_wanted: numpy.typing.NDArray[numpy.uint8]) -> numpy.typing.NDArray[numpy.uint8]: ...

class SegmentVoronoi:
    def __init__(self, points: numpy.typing.NDArray[numpy.int32], segments: numpy.typing.NDArray[numpy.int32], threads: int, progress: Callable[[float], object] | None, within: Sequence[int] | None = None) -> None: ...

    @property
    def counts(self) -> dict[str, Any]: ...

    def take_arrays(self, unwanted: numpy.typing.NDArray[numpy.uint8] | None, threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
        """The arrays of a Diagram that are not of its graph: once."""

class Diagram:
    def __init__(self, points: numpy.typing.NDArray[numpy.int32], segments: numpy.typing.NDArray[numpy.int32], vertices: numpy.typing.NDArray[numpy.float64], radius: numpy.typing.NDArray[numpy.float64], vertex_starts: numpy.typing.NDArray[numpy.int32], vertex_sites: numpy.typing.NDArray[numpy.int32], edges: numpy.typing.NDArray[numpy.int32], edge_sites: numpy.typing.NDArray[numpy.int32], segment_faces: numpy.typing.NDArray[numpy.int32] | None) -> None: ...

def find_fault(diagram: Diagram, threads: int, progress: Callable[[float], object] | None) -> str | None: ...
