"""
Measures, diagrams, outlines and connected components of label images and masks.
"""

from collections.abc import Callable
import enum
from typing import Any, overload

import numpy
import numpy.typing


class CornerRule(enum.Enum):
    apart = 0

    divided = 1

    joined = 2

    yielding = 3

@overload
def measure_regions(labels: numpy.typing.NDArray[numpy.uint8], threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]: ...

@overload
def measure_regions(labels: numpy.typing.NDArray[numpy.uint16], threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]: ...

@overload
def measure_regions(labels: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]: ...

@overload
def max_by_label(labels: numpy.typing.NDArray[numpy.uint8], values: numpy.typing.NDArray[numpy.uint32], wanted: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.uint64]: ...

@overload
def max_by_label(labels: numpy.typing.NDArray[numpy.uint8], values: numpy.typing.NDArray[numpy.uint64], wanted: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.uint64]: ...

@overload
def max_by_label(labels: numpy.typing.NDArray[numpy.uint16], values: numpy.typing.NDArray[numpy.uint32], wanted: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.uint64]: ...

@overload
def max_by_label(labels: numpy.typing.NDArray[numpy.uint16], values: numpy.typing.NDArray[numpy.uint64], wanted: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.uint64]: ...

@overload
def max_by_label(labels: numpy.typing.NDArray[numpy.uint32], values: numpy.typing.NDArray[numpy.uint32], wanted: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.uint64]: ...

@overload
def max_by_label(labels: numpy.typing.NDArray[numpy.uint32], values: numpy.typing.NDArray[numpy.uint64], wanted: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.uint64]: ...

@overload
def mark_diagram(labels: numpy.typing.NDArray[numpy.uint8], above: numpy.typing.NDArray[numpy.uint8] | None, below: numpy.typing.NDArray[numpy.uint8] | None, out: numpy.typing.NDArray[numpy.uint8], threads: int, progress: Callable[[float], object] | None) -> None: ...

@overload
def mark_diagram(labels: numpy.typing.NDArray[numpy.uint16], above: numpy.typing.NDArray[numpy.uint16] | None, below: numpy.typing.NDArray[numpy.uint16] | None, out: numpy.typing.NDArray[numpy.uint8], threads: int, progress: Callable[[float], object] | None) -> None: ...

@overload
def mark_diagram(labels: numpy.typing.NDArray[numpy.uint32], above: numpy.typing.NDArray[numpy.uint32] | None, below: numpy.typing.NDArray[numpy.uint32] | None, out: numpy.typing.NDArray[numpy.uint8], threads: int, progress: Callable[[float], object] | None) -> None: ...

@overload
def count_crack_vertices(labels: numpy.typing.NDArray[numpy.uint8], threads: int, progress: Callable[[float], object] | None) -> int: ...

@overload
def count_crack_vertices(labels: numpy.typing.NDArray[numpy.uint16], threads: int, progress: Callable[[float], object] | None) -> int: ...

@overload
def count_crack_vertices(labels: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> int: ...

@overload
def trace_cracks(labels: numpy.typing.NDArray[numpy.uint8], rule: CornerRule, threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]: ...

@overload
def trace_cracks(labels: numpy.typing.NDArray[numpy.uint16], rule: CornerRule, threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]: ...

@overload
def trace_cracks(labels: numpy.typing.NDArray[numpy.uint32], rule: CornerRule, threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]: ...

def label_components(mask: numpy.typing.NDArray[numpy.uint8], corners: bool, out: numpy.typing.NDArray[numpy.uint32], progress: Callable[[float], object] | None) -> int:
    """Of a mask of zeros and ones; the number of components."""

class StreamingComponents:
    def __init__(self, width: int, corners: bool) -> None: ...

    @property
    def size(self) -> int: ...

    def add(self, mask: numpy.typing.NDArray[numpy.uint8], out: numpy.typing.NDArray[numpy.uint32], progress: Callable[[float], object] | None) -> None: ...

    def settle(self, out: numpy.typing.NDArray[numpy.uint32]) -> int: ...

def number_band(mask: numpy.typing.NDArray[numpy.uint8], corners: bool, above: numpy.typing.NDArray[numpy.uint32], fresh: numpy.typing.NDArray[numpy.uint32], out: numpy.typing.NDArray[numpy.uint32], progress: Callable[[float], object] | None) -> None: ...
