"""The digital triangulation, to the letter and repaired."""

from collections.abc import Callable
from typing import Any, overload

import numpy
import numpy.typing

import vorotool._core.delaunay


class DigitalTriangulationScan:
    def __init__(self) -> None: ...

    @overload
    def add_rows(self, rows: numpy.typing.NDArray[numpy.uint8], threads: int, progress: Callable[[float], object] | None) -> None: ...

    @overload
    def add_rows(self, rows: numpy.typing.NDArray[numpy.uint16], threads: int, progress: Callable[[float], object] | None) -> None: ...

    @overload
    def add_rows(self, rows: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> None: ...

    def finish(self) -> dict[str, Any]: ...

def digital_mesh(points: numpy.typing.NDArray[numpy.float64], x: numpy.typing.NDArray[numpy.int64], y: numpy.typing.NDArray[numpy.int64], scale: int, image: numpy.typing.NDArray[numpy.uint32], frame_x: int, frame_y: int, threads: int, progress: Callable[[float], object] | None) -> tuple[vorotool._core.delaunay.DelaunayTriangulation, dict[str, Any]]:
    """The mesh, and what its repair took."""

def inserted_mesh(points: numpy.typing.NDArray[numpy.float64], threads: int, progress: Callable[[float], object] | None) -> vorotool._core.delaunay.DelaunayTriangulation: ...
