"""The tessellation of volumes."""

from collections.abc import Callable
from typing import Any, overload

import numpy
import numpy.typing


class VolumeTessellation:
    def __init__(self, x: numpy.typing.NDArray[numpy.int64], y: numpy.typing.NDArray[numpy.int64], z: numpy.typing.NDArray[numpy.int64], labels: numpy.typing.NDArray[numpy.uint32], origin: tuple[int, int, int], size: tuple[int, int, int], scale: int, unit: tuple[int, int, int], simd: str) -> None: ...

    @property
    def duplicates(self) -> int: ...

    @property
    def is_wide(self) -> bool: ...

    @property
    def products_exact(self) -> bool: ...

    def labels(self, out: numpy.typing.NDArray[Any], first: int, most_squared: tuple[int, int] | None, threads: int, progress: Callable[[float], object] | None) -> None: ...

    def squared_distances(self, out: numpy.typing.NDArray[Any], first: int, threads: int, progress: Callable[[float], object] | None) -> None: ...

class WrongVoxels:
    """Their number, and the first: its place, and its right label."""

    @property
    def count(self) -> int: ...

    @property
    def first(self) -> tuple[int, int, int]: ...

    @property
    def right(self) -> int: ...

class VolumeMeasurer:
    """Of slices in their order."""

    def __init__(self, width: int, height: int) -> None: ...

    def finish(self, progress: Callable[[float], object] | None) -> dict[str, Any]: ...

    @overload
    def add(self, slices: numpy.typing.NDArray[numpy.uint8], threads: int, progress: Callable[[float], object] | None) -> None: ...

    @overload
    def add(self, slices: numpy.typing.NDArray[numpy.uint16], threads: int, progress: Callable[[float], object] | None) -> None: ...

    @overload
    def add(self, slices: numpy.typing.NDArray[numpy.uint32], threads: int, progress: Callable[[float], object] | None) -> None: ...

@overload
def mark_diagram(labels: numpy.typing.NDArray[numpy.uint8], before: numpy.typing.NDArray[numpy.uint8] | None, after: numpy.typing.NDArray[numpy.uint8] | None, out: numpy.typing.NDArray[numpy.uint8], threads: int, progress: Callable[[float], object] | None) -> None: ...

@overload
def mark_diagram(labels: numpy.typing.NDArray[numpy.uint16], before: numpy.typing.NDArray[numpy.uint16] | None, after: numpy.typing.NDArray[numpy.uint16] | None, out: numpy.typing.NDArray[numpy.uint8], threads: int, progress: Callable[[float], object] | None) -> None: ...

@overload
def mark_diagram(labels: numpy.typing.NDArray[numpy.uint32], before: numpy.typing.NDArray[numpy.uint32] | None, after: numpy.typing.NDArray[numpy.uint32] | None, out: numpy.typing.NDArray[numpy.uint8], threads: int, progress: Callable[[float], object] | None) -> None: ...

@overload
def verify_volume(labels: numpy.typing.NDArray[numpy.uint8], origin: tuple[int, int, int], seed_x: numpy.typing.NDArray[numpy.int64], seed_y: numpy.typing.NDArray[numpy.int64], seed_z: numpy.typing.NDArray[numpy.int64], seed_labels: numpy.typing.NDArray[numpy.uint32], side: tuple[int, int, int], limit_high: int | None, limit_low: int, threads: int, progress: Callable[[float], object] | None) -> WrongVoxels: ...

@overload
def verify_volume(labels: numpy.typing.NDArray[numpy.uint16], origin: tuple[int, int, int], seed_x: numpy.typing.NDArray[numpy.int64], seed_y: numpy.typing.NDArray[numpy.int64], seed_z: numpy.typing.NDArray[numpy.int64], seed_labels: numpy.typing.NDArray[numpy.uint32], side: tuple[int, int, int], limit_high: int | None, limit_low: int, threads: int, progress: Callable[[float], object] | None) -> WrongVoxels: ...

@overload
def verify_volume(labels: numpy.typing.NDArray[numpy.uint32], origin: tuple[int, int, int], seed_x: numpy.typing.NDArray[numpy.int64], seed_y: numpy.typing.NDArray[numpy.int64], seed_z: numpy.typing.NDArray[numpy.int64], seed_labels: numpy.typing.NDArray[numpy.uint32], side: tuple[int, int, int], limit_high: int | None, limit_low: int, threads: int, progress: Callable[[float], object] | None) -> WrongVoxels: ...
