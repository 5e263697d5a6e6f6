"""
Alpha complexes, shapes and curves: a side is a triangle or -1, ranks are places in the spectrum.
"""

from collections.abc import Callable
import enum
from typing import Any

import numpy
import numpy.typing


class AlphaRule(enum.Enum):
    corrected = 0

    printed = 1

def edges_of_triangles(triangles: numpy.typing.NDArray[numpy.int32], neighbors: numpy.typing.NDArray[numpy.int32], threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
    """Edges, and the triangles on their sides."""

def alpha_complex(points: numpy.typing.NDArray[numpy.float64], triangles: numpy.typing.NDArray[numpy.int32], edges: numpy.typing.NDArray[numpy.int32], sides: numpy.typing.NDArray[numpy.int32], rule: AlphaRule, threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]: ...

def shape_edges(rank_min: numpy.typing.NDArray[numpy.int32], rank_mid: numpy.typing.NDArray[numpy.int32], rank_max: numpy.typing.NDArray[numpy.int32], reached: int, entered: int, threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.uint8]]:
    """Edges of a shape, and the kind of each."""

def connected_triangles(inside: numpy.typing.NDArray[numpy.uint8], sides: numpy.typing.NDArray[numpy.int32], progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.int32]: ...

def trace_rings(points: numpy.typing.NDArray[numpy.float64], a: numpy.typing.NDArray[numpy.int32], b: numpy.typing.NDArray[numpy.int32], region: numpy.typing.NDArray[numpy.int32], progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.uint8]]:
    """
    Vertices of all rings, where each begins, its region, and whether it is a hole.
    """

def alpha_curves(spectrum: int, cell_rank: numpy.typing.NDArray[numpy.int32], sides: numpy.typing.NDArray[numpy.int32], wall_rank: numpy.typing.NDArray[numpy.int32], cell_size: numpy.typing.NDArray[numpy.float64], wall_size: numpy.typing.NDArray[numpy.float64], progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    Content, border, regions and cavities of the shape of each rank, in the plane or in space.
    """

def part_counts(spectrum: int, points: int, edges: numpy.typing.NDArray[numpy.int32], edge_rank: numpy.typing.NDArray[numpy.int32], progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.int32]: ...

def region_persistence(spectrum: int, points: int, triangles: numpy.typing.NDArray[numpy.int32], triangle_rank: numpy.typing.NDArray[numpy.int32], rank_max: numpy.typing.NDArray[numpy.int32], sides: numpy.typing.NDArray[numpy.int32], area: numpy.typing.NDArray[numpy.float64], progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    Ranks of birth and death of regions, what each becomes part of, and its sizes before that.
    """
