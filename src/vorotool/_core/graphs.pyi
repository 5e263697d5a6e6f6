"""
Paths in graphs of arcs, which are pairs of nodes, and colors of graphs.
"""

from collections.abc import Callable

import numpy
import numpy.typing


def longest_paths(arcs: numpy.typing.NDArray[numpy.int32], length: numpy.typing.NDArray[numpy.float64], group: numpy.typing.NDArray[numpy.int32], groups: int, nodes: int, tie: float, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int64], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
    """
    Where the arcs of each group's path begin, the arcs, and the node that each leads to.
    """

def path_from(arcs: numpy.typing.NDArray[numpy.int32], length: numpy.typing.NDArray[numpy.float64], nodes: int, first: int, last: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]] | None:
    """
    Arcs of the shortest path, and the node that each leads to; with last -1 to the farthest leaf.
    """

def color_graph(vertices: int, a: numpy.typing.NDArray[numpy.uint32], b: numpy.typing.NDArray[numpy.uint32], progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.uint32]: ...

def connected_components(edges: numpy.typing.NDArray[numpy.int32], vertices: int) -> numpy.typing.NDArray[numpy.int32]:
    """The smallest vertex that each is connected with."""

def arcs_by_ends(arcs: numpy.typing.NDArray[numpy.int32], vertices: int) -> numpy.typing.NDArray[numpy.int32]:
    """
    The arcs by their sources, then by their targets; those between the same two as they are given.
    """

def next_half_edges(arcs: numpy.typing.NDArray[numpy.int32], order: numpy.typing.NDArray[numpy.int64], vertices: int) -> numpy.typing.NDArray[numpy.int32]:
    """
    The half-edge after each one around its face: 2 k along arc k, 2 k + 1 back.
    """

def boundary_cycles(next: numpy.typing.NDArray[numpy.int32], tail: numpy.typing.NDArray[numpy.int32], vertices: int) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
    """
    Where the cycles begin that pass no vertex twice, and the half-edges along them.
    """
