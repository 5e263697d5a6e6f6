"""What is nearest, and which boxes are disjoint."""

from collections.abc import Callable
from typing import overload

import numpy
import numpy.typing


@overload
def nearest_other_sites(x: numpy.typing.NDArray[numpy.float64], y: numpy.typing.NDArray[numpy.float64], labels: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int64], numpy.typing.NDArray[numpy.float64]]:
    """Of each site the nearest with another label, and its distance."""

@overload
def nearest_other_sites(x: numpy.typing.NDArray[numpy.float64], y: numpy.typing.NDArray[numpy.float64], z: numpy.typing.NDArray[numpy.float64], labels: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int64], numpy.typing.NDArray[numpy.float64]]: ...

def clearances(points: numpy.typing.NDArray[numpy.int32], segments: numpy.typing.NDArray[numpy.int32], places: numpy.typing.NDArray[numpy.float64], reach: numpy.typing.NDArray[numpy.float64], threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.float64]:
    """Of the nearest site within reach; infinite where there is none."""

def disjoint_sheets(boxes: numpy.typing.NDArray[numpy.int64], progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.int32]:
    """Of boxes with the columns least x, least y, most x, most y."""
