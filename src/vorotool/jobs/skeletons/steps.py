"""Places at equal steps along skeletons."""

from __future__ import annotations

from typing import Any

from vorotool.engines.from_skeleton.points_along import points_along
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.jobs.skeletons.result import Result


class Steps(Result):
    """Points, and transects from foot to foot."""

    value: SkeletonPoints

    def _make(self) -> SkeletonPoints:
        skeleton, every = self.origin.skeleton(), self.options.every
        assert every is not None  # the command refuses points without it
        with self.run.phase("points") as progress:
            return points_along(skeleton, every=every, threads=self.options.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Count points."""
        return {"every": self.options.every, "points": len(self.value)}
