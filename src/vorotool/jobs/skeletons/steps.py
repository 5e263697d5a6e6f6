"""Places at equal steps along skeletons and centerlines."""

from __future__ import annotations

from typing import Any

from vorotool.engines.from_skeleton.points_along import points_along
from vorotool.jobs.skeletons.result import Result
from vorotool.numeric.progress import Progress
from vorotool.types.skeleton.points_along import SkeletonPoints


class Steps(Result):
    """Points, and transects from foot to foot."""

    value: SkeletonPoints

    def _make(self) -> SkeletonPoints:
        every, origin = self.options.every, self.origin
        assert every is not None  # the command refuses points without it
        lines = origin.centerlines() if self.options.along == "centerline" else origin.skeleton()
        with self.run.phase("points") as progress:
            return points_along(lines, every=every, threads=self.options.threads, progress=progress)

    def verify(self, progress: Progress) -> None:
        """Check sections: those of branches end where the discs of the skeleton, which is checked, touch."""
        if self.options.along == "centerline":
            from vorotool.engines.from_skeleton.verify_sections import verify_sections

            assert self.options.every is not None
            verify_sections(self.value, self.origin.centerlines(), self.options.every)

    def stats(self) -> dict[str, Any]:
        """Count points."""
        return {"every": self.options.every, "along": self.options.along or "branches", "points": len(self.value)}
