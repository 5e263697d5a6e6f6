"""Critical values of skeletons, and what is left for a threshold."""

from collections.abc import Callable
import enum
from typing import Any

import numpy
import numpy.typing

import vorotool._core.skeleton


class Criterion(enum.Enum):
    angle = 0

    chord = 1

    scale = 2

    length = 3

    ratio = 4

def critical_values(skeleton: vorotool._core.skeleton.Skeleton, criterion: Criterion, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.float64]]:
    """
    Values at the ends of arcs and the largest of each; arcs on which a place is kept, and where. Of the angle: the tangent of half of it.
    """

def prune_skeleton(skeleton: vorotool._core.skeleton.Skeleton, arcs: slice, nodes: slice, criterion: Criterion, threshold: float, group: numpy.typing.NDArray[numpy.int32], progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    What is left of some arcs, whose nodes, numbered from the first of them, are no others'.
    """

def arc_profiles(skeleton: vorotool._core.skeleton.Skeleton) -> tuple[numpy.typing.NDArray[numpy.int8], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    Kinds (between lines, between points, parabola), x at the ends, and h or the tangent of half the angle.
    """

def part_geometry(skeleton: vorotool._core.skeleton.Skeleton, arc: numpy.typing.NDArray[numpy.int32], first: numpy.typing.NDArray[numpy.float64], last: numpy.typing.NDArray[numpy.float64]) -> dict[str, Any]:
    """
    Places and radii of both ends, control points and lengths of parts of arcs.
    """
