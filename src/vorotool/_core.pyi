"""Types of the compiled core (private)."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

_Progress = Callable[[float], object] | None

# regions: labels are C-contiguous uint8, uint16 or uint32
def measure_regions(labels: NDArray[Any], threads: int, progress: _Progress) -> dict[str, NDArray[Any]]: ...
def max_by_label(
    labels: NDArray[Any],
    values: NDArray[Any],
    wanted: NDArray[np.uint32],
    threads: int,
    progress: _Progress,
) -> NDArray[np.uint64]: ...
def mark_diagram(
    labels: NDArray[Any],
    above: NDArray[Any] | None,
    below: NDArray[Any] | None,
    out: NDArray[np.uint8],
    threads: int,
    progress: _Progress,
) -> None: ...
def verify_labels(
    labels: NDArray[Any],
    x: int,
    y: int,
    seed_x: NDArray[np.int64],
    seed_y: NDArray[np.int64],
    seed_labels: NDArray[np.uint32],
    scale: int,
    limit_high: int | None,
    limit_low: int,
    threads: int,
    progress: _Progress,
) -> tuple[int, int, int, int, int]: ...
def nearest_other_sites(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    labels: NDArray[np.uint32],
    threads: int,
    progress: _Progress,
) -> tuple[NDArray[np.int64], NDArray[np.float64]]: ...
def colour_graph(
    vertices: int, a: NDArray[np.uint32], b: NDArray[np.uint32], progress: _Progress
) -> NDArray[np.uint32]: ...
