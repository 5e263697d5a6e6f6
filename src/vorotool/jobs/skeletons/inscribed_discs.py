"""The largest discs inside shapes."""

from __future__ import annotations

from typing import Any

from vorotool.engines.from_skeleton.largest_discs import discs_of_skeleton
from vorotool.engines.skeleton.diagrams import skeleton_in, skeleton_inside
from vorotool.engines.skeleton.exact import ShapeDiagram
from vorotool.jobs.skeletons.result import Result
from vorotool.numeric.progress import Progress
from vorotool.types.skeleton.discs import Discs
from vorotool.types.skeleton.skeleton import Skeleton


class InscribedDiscs(Result):
    """Discs of each feature, of its exact skeleton before it is pruned, whatever skeleton is asked for."""

    value: Discs

    def _make(self) -> Discs:
        o, axis = self.origin.exact_options, self._axis()
        with self.run.phase("discs"):
            return discs_of_skeleton(axis, count=o.count, local=o.local, threads=o.threads)

    def _axis(self) -> Skeleton:
        o = self.origin.exact_options
        if not o.gap and o.side != "exterior":
            return self.origin.whole()
        shapes = self.origin.shapes()
        with self.run.phase("skeleton") as progress:
            if isinstance(shapes, ShapeDiagram):
                return skeleton_in(shapes, side="interior", features=o.features, threads=o.threads, progress=progress)
            return skeleton_inside(shapes, strict=o.strict, threads=o.threads, progress=progress).skeleton

    def verify(self, progress: Progress) -> None:
        """Check the discs."""
        from vorotool.engines.from_skeleton.verify_discs import verify_discs

        verify_discs(self.value, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Count discs, and tell of the largest."""
        made = self.value
        return {"discs": len(made), "largest_radius": float(made.radius.max()) if len(made) else None}
