"""Shapes that are rebuilt from their skeletons."""

from __future__ import annotations

from vorotool.engines.from_skeleton.reconstruction import rebuild
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.jobs.skeletons.result import Result


class RebuiltShape(Result):
    """What the discs of a skeleton cover."""

    value: PolygonSet

    def _make(self) -> PolygonSet:
        skeleton = self.origin.skeleton()
        with self.run.phase("rebuild"):
            return rebuild(skeleton, flatten=self.options.flatten)
