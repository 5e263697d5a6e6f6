"""The tessellation of volumes."""

from collections.abc import Callable
from typing import Any

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
