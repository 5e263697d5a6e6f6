"""The largest disc inside an outline that covers each pixel."""

from collections.abc import Callable

import numpy
import numpy.typing

import vorotool._core.skeleton


def local_thickness(skeleton: vorotool._core.skeleton.Skeleton, first: tuple[float, float], step: tuple[float, float], height: int, width: int, slack: float, threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.float64]:
    """
    Diameters, row by row; the center of the first pixel, and the steps to the next, are x and y.
    """
