"""The tessellation of frames, and its check."""

from collections.abc import Callable
from typing import Any, overload

import numpy
import numpy.typing


class SeedTooFarError(ValueError):
    pass

class Tessellation:
    def __init__(self, x: numpy.typing.NDArray[numpy.int64], y: numpy.typing.NDArray[numpy.int64], labels: numpy.typing.NDArray[numpy.uint32], frame_x: int, frame_y: int, width: int, height: int, scale: int, unit: tuple[int, int], simd: str) -> None: ...

    @property
    def duplicates(self) -> int: ...

    @property
    def columns(self) -> int: ...

    @property
    def is_wide(self) -> bool: ...

    @property
    def products_exact(self) -> bool: ...

    def labels(self, out: numpy.typing.NDArray[Any], first: int, most_squared: tuple[int, int] | None, threads: int, progress: Callable[[float], object] | None) -> None: ...

    def squared_distances(self, out: numpy.typing.NDArray[Any], first: int, threads: int, progress: Callable[[float], object] | None) -> None: ...

    def distances(self, out: numpy.typing.NDArray[Any], first: int, square_of_step: float, threads: int, progress: Callable[[float], object] | None) -> None: ...

def propagate(x: numpy.typing.NDArray[numpy.int64], y: numpy.typing.NDArray[numpy.int64], labels: numpy.typing.NDArray[numpy.uint32], passes: int, out: numpy.typing.NDArray[numpy.uint32], progress: Callable[[float], object] | None) -> None: ...

def widest_simd() -> str: ...

class WrongPixels:
    """Their number, and the first: its place, and its right label."""

    @property
    def count(self) -> int: ...

    @property
    def column(self) -> int: ...

    @property
    def row(self) -> int: ...

    @property
    def right(self) -> int: ...

@overload
def verify_tessellation(labels: numpy.typing.NDArray[numpy.uint8], x: int, y: int, seed_x: numpy.typing.NDArray[numpy.int64], seed_y: numpy.typing.NDArray[numpy.int64], seed_labels: numpy.typing.NDArray[numpy.uint32], pixel: tuple[int, int], limit_high: int | None, limit_low: int, threads: int, progress: Callable[[float], object] | None) -> WrongPixels: ...

@overload
def verify_tessellation(labels: numpy.typing.NDArray[numpy.uint16], x: int, y: int, seed_x: numpy.typing.NDArray[numpy.int64], seed_y: numpy.typing.NDArray[numpy.int64], seed_labels: numpy.typing.NDArray[numpy.uint32], pixel: tuple[int, int], limit_high: int | None, limit_low: int, threads: int, progress: Callable[[float], object] | None) -> WrongPixels: ...

@overload
def verify_tessellation(labels: numpy.typing.NDArray[numpy.uint32], x: int, y: int, seed_x: numpy.typing.NDArray[numpy.int64], seed_y: numpy.typing.NDArray[numpy.int64], seed_labels: numpy.typing.NDArray[numpy.uint32], pixel: tuple[int, int], limit_high: int | None, limit_low: int, threads: int, progress: Callable[[float], object] | None) -> WrongPixels: ...
