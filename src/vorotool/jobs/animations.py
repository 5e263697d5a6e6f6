"""Animations: results that grow, each frame computed as a picture of its own would be."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, BinaryIO, Protocol

from vorotool.errors import LimitError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.jobs.run_log import Run

FRAMES, FPS = 40, 10.0
"""Where they are not chosen."""

MOST_PIXELS = 1 << 28
"""Of all frames together."""


class Animated(Protocol):
    """Options of what can be an animation."""

    @property
    def animate(self) -> bool:
        """Whether it is to be one."""

    @property
    def frames(self) -> int | None:
        """How many pictures it has."""

    @property
    def fps(self) -> float | None:
        """How many of them are shown a second."""


def parts_of_whole(o: Animated, *, has_nothing: bool = False) -> list[Fraction]:
    """Give how far a result has grown in each frame, up to 1; from 0 where nothing can be shown."""
    count = o.frames or FRAMES
    if has_nothing:
        return [Fraction(k, max(count - 1, 1)) for k in range(count)]
    return [Fraction(k, count) for k in range(1, count + 1)]


def check_size(o: Animated, shape: tuple[int, int]) -> None:
    """Refuse more pixels than can be shown."""
    count = o.frames or FRAMES
    if count * shape[0] * shape[1] > MOST_PIXELS:
        raise LimitError(
            f"{count} frames of {shape[1]} x {shape[0]} pixels are too many, at most {MOST_PIXELS} pixels: use fewer "
            "--frames, or a smaller --width"
        )


def write_frames(
    out: BinaryIO,
    run: Run,
    o: Animated,
    fmt: str,
    values: Sequence[Fraction],
    draw: Callable[[Fraction], NDArray[np.uint8]],
) -> None:
    """Draw each frame and write them."""
    from vorotool.formats.images.animation_writer import write_animation

    progress = run.progress("animate")

    def frames() -> Iterator[NDArray[np.uint8]]:
        for number, value in enumerate(values):
            yield draw(value)
            if progress is not None:
                progress((number + 1) / len(values))

    write_animation(out, frames(), fmt=fmt, fps=o.fps or FPS)
