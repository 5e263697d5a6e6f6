"""From segment Voronoi diagrams to skeletons."""

from collections.abc import Callable
from typing import Any

import numpy
import numpy.typing

import vorotool._core.segment_voronoi


class Skeleton:
    """Of sites only the scale needs no ends."""

    def __init__(self, vertices: numpy.typing.NDArray[numpy.float64], radius: numpy.typing.NDArray[numpy.float64], arcs: numpy.typing.NDArray[numpy.int32], control: numpy.typing.NDArray[numpy.float64], sites: numpy.typing.NDArray[numpy.int32], length: numpy.typing.NDArray[numpy.float64], site_ends: numpy.typing.NDArray[numpy.float64] | None, is_anchored: numpy.typing.NDArray[numpy.uint8], has_gap: bool, reach: float) -> None: ...

def skeleton_edges(diagram: vorotool._core.segment_voronoi.Diagram, threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
    """Edges that are not deleted, and the face that each lies in."""

def extract_skeleton(diagram: vorotool._core.segment_voronoi.Diagram, kept: numpy.typing.NDArray[numpy.int32], groups: numpy.typing.NDArray[numpy.int32], clipped: tuple[int, tuple[float, float, float, float]] | None, joined: tuple[int, int], origin_x: float, origin_y: float, scale: float, threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    Frames are least x, most x, least y, most y on the lattice; joined are groups from one to before another.
    """

def steps_along(skeleton: Skeleton, first: numpy.typing.NDArray[numpy.int64], counts: numpy.typing.NDArray[numpy.int64], every: float, threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
    """Places at equal steps along branches, whose first arcs are given."""

def clearance_course(vertices: numpy.typing.NDArray[numpy.float64], radius: numpy.typing.NDArray[numpy.float64], arcs: numpy.typing.NDArray[numpy.int32], sites: numpy.typing.NDArray[numpy.int32], site_places: numpy.typing.NDArray[numpy.int32], error: float, sites_are_exact: bool, threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int8], numpy.typing.NDArray[numpy.float64]]:
    """
    How the clearance begins to change at the source and target of each arc, and where it is least; all on the lattice.
    """
