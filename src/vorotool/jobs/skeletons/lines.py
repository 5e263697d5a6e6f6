"""What skeletons and centerlines are written as: as they are, led on to their ends, or smooth."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run

if TYPE_CHECKING:
    from vorotool.numeric.progress import Progress
    from vorotool.types.skeleton.centerline import Centerlines
    from vorotool.types.skeleton.extended import ExtendedSkeleton
    from vorotool.types.skeleton.led_on import LedOn
    from vorotool.types.skeleton.skeleton import Skeleton
    from vorotool.types.skeleton.smooth_lines import SmoothLines

LINES = ("skeleton", "centerline")
"""Results that are lines."""


class WrittenLines:
    """Lines that are made when they are asked for."""

    def __init__(
        self,
        run: Run,
        options: Options,
        skeleton: Callable[[], Skeleton],
        centerlines: Callable[[], Centerlines],
    ) -> None:
        self.run, self.options = run, options
        self._skeleton = skeleton
        self._makers: dict[str, Callable[[], Skeleton | LedOn]] = {"skeleton": skeleton, "centerline": centerlines}
        self._made: dict[str, Skeleton | LedOn | SmoothLines] = {}
        if options.ends == "middle":
            self._makers["skeleton"] = lambda: self._extended(skeleton())

    def value(self, what: str) -> Skeleton | LedOn | SmoothLines:
        """Of one of `LINES`."""
        if what not in self._made:
            lines = self._makers[what]()
            self._made[what] = lines if self.options.smooth is None else self._smooth(lines, self.options.smooth)
        return self._made[what]

    def _extended(self, skeleton: Skeleton) -> ExtendedSkeleton:
        from vorotool.engines.centerlines.extended_ends import extend_ends

        with self.run.phase("ends") as progress:
            return extend_ends(skeleton, threads=self.options.threads, progress=progress)

    def _smooth(self, lines: Any, tolerance: float) -> SmoothLines:
        from vorotool.engines.smoothing.smooth import smooth

        with self.run.phase("smooth") as progress:
            return smooth(lines, tolerance, progress=progress)

    def _wanted(self) -> list[Skeleton | LedOn | SmoothLines]:
        """Lines that are asked for."""
        return [self.value(what) for what in LINES if what in self.options.what]

    def verify(self, progress: Progress) -> None:
        """Check ends that skeletons are led on to, and smooth lines."""
        from vorotool.engines.centerlines.verify_extended import verify_extended
        from vorotool.engines.smoothing.verify_smooth import verify_smooth
        from vorotool.types.skeleton.extended import ExtendedSkeleton
        from vorotool.types.skeleton.smooth_lines import SmoothLines

        for value in self._wanted():
            lines: Any = value
            if isinstance(value, SmoothLines):
                verify_smooth(value)
                lines = value.lines
            if isinstance(lines, ExtendedSkeleton):
                verify_extended(lines, self._skeleton())

    def stats(self) -> dict[str, Any]:
        """Counts of smooth lines."""
        from vorotool.types.skeleton.smooth_lines import SmoothLines

        if self.options.smooth is None:
            return {}
        made = [value for value in self._wanted() if isinstance(value, SmoothLines)]
        return {
            "smooth": self.options.smooth,
            "curves": sum(len(value.control) for value in made),
            "largest_error": max((float(value.error.max(initial=0.0)) for value in made), default=0.0),
        }
