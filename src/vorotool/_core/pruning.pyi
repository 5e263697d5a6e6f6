"""Critical values of skeletons, and what is left for a threshold."""

from collections.abc import Callable
import enum
from typing import Any

import numpy
import numpy.typing


class Criterion(enum.Enum):
    angle = 0

    chord = 1

    scale = 2

    length = 3

    ratio = 4

class Skeleton:
    """Of sites only the scale needs no ends."""

    def __init__(self, vertices: numpy.typing.NDArray[numpy.float64], radius: numpy.typing.NDArray[numpy.float64], arcs: numpy.typing.NDArray[numpy.int32], control: numpy.typing.NDArray[numpy.float64], sites: numpy.typing.NDArray[numpy.int32], length: numpy.typing.NDArray[numpy.float64], site_ends: numpy.typing.NDArray[numpy.float64] | None, is_anchored: numpy.typing.NDArray[numpy.uint8], has_gap: bool, reach: float) -> None: ...

def critical_values(skeleton: Skeleton, criterion: Criterion, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.float64]]:
    """
    Values at the ends of arcs and the largest of each; arcs on which a place is kept, and where. Of the angle: the tangent of half of it.
    """

def prune_skeleton(skeleton: Skeleton, arcs: slice, nodes: slice, criterion: Criterion, threshold: float, group: numpy.typing.NDArray[numpy.int32], progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    What is left of some arcs, whose nodes, numbered from the first of them, are no others'.
    """

def arc_profiles(skeleton: Skeleton) -> tuple[numpy.typing.NDArray[numpy.int8], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    Kinds (between lines, between points, parabola), x at the ends, and h or the tangent of half the angle.
    """

def part_geometry(skeleton: Skeleton, arc: numpy.typing.NDArray[numpy.int32], first: numpy.typing.NDArray[numpy.float64], last: numpy.typing.NDArray[numpy.float64]) -> dict[str, Any]:
    """
    Places and radii of both ends, control points and lengths of parts of arcs.
    """
