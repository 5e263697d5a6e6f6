"""
Gabriel graphs, relative neighborhood graphs and minimum spanning trees.
"""

from collections.abc import Callable
import enum

import numpy
import numpy.typing

import vorotool._core.delaunay


class ProximityKind(enum.Enum):
    gabriel = 0

    relative = 1

    spanning_tree = 2

def proximity_edges(mesh: vorotool._core.delaunay.Triangulation, kind: ProximityKind, threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.int32]:
    """Places of the edges that are in the graph, increasing."""
