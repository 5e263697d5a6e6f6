"""Offset curves of shapes."""

from __future__ import annotations

from typing import Any

from vorotool.engines.offsets.offsets import offset
from vorotool.errors import Kind, Message
from vorotool.jobs.skeletons.result import Result
from vorotool.numeric.progress import Progress
from vorotool.types.skeleton.offsets import Offsets


class OffsetCurves(Result):
    """Curves at all distances."""

    value: Offsets

    def _make(self) -> Offsets:
        shapes, o = self.origin.shapes(), self.origin.exact_options
        distances = o.distance or ()
        with self.run.phase("offset") as progress:
            made = offset(shapes, distances, features=o.features, strict=o.strict, threads=o.threads, progress=progress)
        empty = [f"{distance:g}" for distance in distances if distance not in made.distance]
        if empty:
            self.run.warn(Message(f"nothing is left at the distance {', '.join(empty)}", Kind.EMPTY_RESULT))
        return made

    def verify(self, progress: Progress) -> None:
        """Check the curves."""
        from vorotool.engines.offsets.verify_offsets import verify_offsets

        o = self.origin.exact_options
        verify_offsets(self.value, distances=o.distance or (), threads=o.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Count shapes, rings and pieces."""
        made = self.value
        counts = {"shapes": len(made), "rings": len(made.ring_kind), "pieces": len(made.site)}
        return {"distances": list(self.origin.exact_options.distance or ()), **counts}
