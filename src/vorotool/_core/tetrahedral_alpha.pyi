"""Alpha complexes of points in space: ranks are places in the spectrum."""

from collections.abc import Callable
from typing import Any

import numpy
import numpy.typing


def space_complex(points: numpy.typing.NDArray[numpy.float64], tetrahedra: numpy.typing.NDArray[numpy.int32], neighbors: numpy.typing.NDArray[numpy.int32], triangles: numpy.typing.NDArray[numpy.int32], edges: numpy.typing.NDArray[numpy.int32], threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    Ranks in the spectrum: of tetrahedra, triangles and edges; facet is 4 t + k of each triangle.
    """
