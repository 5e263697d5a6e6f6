"""Types of the compiled core (private)."""

from collections.abc import Callable
from typing import Any

from numpy.typing import NDArray

class SeedTooFarError(ValueError): ...

class Tessellation:
    def __init__(
        self,
        x: NDArray[Any],
        y: NDArray[Any],
        labels: NDArray[Any],
        frame_x: int,
        frame_y: int,
        width: int,
        height: int,
        steps: int,
        simd: str,
    ) -> None: ...
    @property
    def duplicates(self) -> int: ...
    @property
    def columns(self) -> int: ...
    @property
    def is_wide(self) -> bool: ...
    @property
    def products_exact(self) -> bool: ...
    def labels(
        self,
        out: NDArray[Any],
        first: int,
        most_squared: tuple[int, int] | None,
        threads: int,
        progress: Callable[[float], object] | None,
    ) -> None: ...
    def squared_distances(
        self, out: NDArray[Any], first: int, threads: int, progress: Callable[[float], object] | None
    ) -> None: ...
    def distances(
        self, out: NDArray[Any], first: int, threads: int, progress: Callable[[float], object] | None
    ) -> None: ...

def propagate(
    x: NDArray[Any],
    y: NDArray[Any],
    labels: NDArray[Any],
    passes: int,
    out: NDArray[Any],
    progress: Callable[[float], object] | None,
) -> None: ...
def stream_fill(out: NDArray[Any], threads: int) -> None: ...
def widest_simd() -> str: ...
