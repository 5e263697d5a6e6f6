"""What exact skeletons are written as, checked for and counted by."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from vorotool.engines.skeleton.diagrams import (
    AnyDiagram,
    FeatureSkeleton,
    all_edges,
    is_of_single_features,
    skeleton_in,
)
from vorotool.engines.skeleton.exact import ShapeDiagram
from vorotool.engines.skeleton.parts import outside_of
from vorotool.frozen import frozen
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.skeletons.products import SKELETON_INSIDE, SkeletonProducts
from vorotool.jobs.units import Amount
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import Skeleton

_VERIFY_DIAGRAM = "engines.segment_voronoi.segment_voronoi:verify_segment_voronoi"


@frozen
class Seen:
    """Counts of the diagram of some features."""

    vertices: int  # of the diagram
    edges: int  # of the diagram
    deviation: float = 0.0  # with a gap, how far the skeleton is from the exact one, if that is asked for


class ExactProducts(SkeletonProducts):
    """Results of one exact skeleton, or of one with a gap: see `SkeletonProducts`."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        super().__init__(run, options, given)
        # what is refused is refused here, where the input has its name
        if not self._is_inside_only:
            _ = self.of_all
        elif set(options.what) != {"offset"}:
            _ = self.whole
        else:
            _ = self.value("offset")

    @property
    def _is_inside_only(self) -> bool:
        """Whether no diagram of all features together is needed."""
        return is_of_single_features(self.options.side, self.options.features) and "diagram" not in self.options.what

    @property
    def _is_looked_at(self) -> bool:
        """Whether somebody asks for more of a diagram than the skeleton in it."""
        return self.options.verify or self.options.stats is not None

    @cached_property
    def of_all(self) -> AnyDiagram:
        """The diagram of all features."""
        o = self.options
        is_whole = self._is_looked_at or o.side != "interior" or bool({"diagram", "offset"} & set(o.what))
        how = {"features": o.features, "interior_only": not is_whole}
        with self.telling_once():
            return self.call("engines.skeleton.diagrams:diagram_of_all", self._polygons, o.gap, phase="diagram", **how)

    @cached_property
    def inside(self) -> FeatureSkeleton[Seen]:
        """What is inside each feature by itself, and what was seen of each diagram that is looked at."""
        o, look = self.options, self._look if self._is_looked_at else None
        border = self._polygons.frame if o.border == "open" else None
        how = {"complete": o.complete is not False, "look": look, "border": border and border.extent}
        with self.telling_once():
            return self.call(SKELETON_INSIDE, self._polygons, o.gap, phase="skeleton", **how)

    def _look(self, diagram: AnyDiagram, made: Skeleton) -> Seen:
        if self.options.verify:
            resolved(_VERIFY_DIAGRAM)(diagram.diagram, threads=1)
        deviation = 0.0
        if not isinstance(diagram, ShapeDiagram) and self.options.stats is not None:
            from vorotool.engines.skeleton.shortened_edges import exact_inside, gap_deviation

            deviation = gap_deviation(made, exact_inside(diagram))
        return Seen(len(diagram.diagram), len(diagram.diagram.edges), deviation)

    def _make_skeleton(self) -> Skeleton:
        o = self.options
        if is_of_single_features(o.side, o.features):
            return self.inside.skeleton
        how = {"side": o.side, "features": o.features, "complete": o.complete is not False, "frame": o.frame}
        return skeleton_in(self.of_all, **how, threads=o.threads)

    def _make_diagram(self) -> Skeleton:
        return all_edges(self.of_all, frame=self.options.frame, threads=self.options.threads)

    def _shape_diagram(self) -> ShapeDiagram:
        return self.of_all if isinstance(self.of_all, ShapeDiagram) else super()._shape_diagram()

    @property
    def graph(self) -> PlanarGraph:
        """The shapes as they were placed."""
        return self.of_all.graph if isinstance(self.of_all, ShapeDiagram) else self.of_all.shapes

    def _verify_whole(self, progress: Progress) -> None:
        """Check the diagram and the skeleton, from their arrays alone."""
        if not self._is_inside_only:  # or else each batch was looked at
            self.call(_VERIFY_DIAGRAM, self.of_all.diagram, phase=None, progress=progress)
        if self.options.side != "interior" and isinstance(self.of_all, ShapeDiagram):
            self.call("engines.skeleton.verify_skeleton:verify_exterior", self.of_all, phase=None)
        super()._verify_whole(progress)

    def _shape_stats(self) -> dict[str, Any]:
        return self.inside.shapes.counts() if self._is_inside_only else super()._shape_stats()

    def _diagram_stats(self) -> dict[str, Any]:
        if self._is_inside_only:
            seen = self.inside.seen
            return {
                "diagram_vertices": sum(each.vertices for each in seen),
                "diagram_edges": sum(each.edges for each in seen),
            }
        diagram = self.of_all.diagram
        return {"diagram_vertices": len(diagram), "diagram_edges": len(diagram.edges)}

    def _more_stats(self) -> dict[str, Any]:
        """How far a skeleton with a gap is from the exact one: a second diagram, so only for whom it is written."""
        o = self.options
        if o.border == "open":
            return {"border": "open"}
        if not o.gap:
            return {}
        found: dict[str, Any] = {"gap": Amount(o.gap), "complete": o.complete is not False}
        if o.stats is not None:
            found["gap_deviation"] = Amount(self._gap_deviation())
        return found

    def _gap_deviation(self) -> float:
        o = self.options
        made, side, inside = self.whole, o.side, 0.0
        if o.features == "separate" and side != "exterior":
            inside = max((seen.deviation for seen in self.inside.seen), default=0.0)
            if side == "interior":
                return inside
            made, side = outside_of(made), "exterior"
        from vorotool.engines.skeleton.shortened_edges import exact_for, gap_deviation

        assert not isinstance(self.of_all, ShapeDiagram)  # there is a gap
        return max(inside, gap_deviation(made, exact_for(self.of_all, side, frame=made.frame, threads=o.threads)))
