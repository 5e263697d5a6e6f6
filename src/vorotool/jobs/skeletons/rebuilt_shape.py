"""Shapes that are rebuilt from their skeletons."""

from __future__ import annotations

from vorotool.engines.from_skeleton.reconstruction import rebuild
from vorotool.jobs.skeletons.result import Result
from vorotool.types.polygons.polygon_set import PolygonSet


class RebuiltShape(Result):
    """What the discs of a skeleton cover."""

    value: PolygonSet

    def _make(self) -> PolygonSet:
        skeleton = self.origin.skeleton()
        with self.run.phase("rebuild"):
            return rebuild(skeleton, flatten=self.options.flatten)
