"""What exact skeletons are written as, checked for and counted by."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from vorotool.engines.features.batches import together
from vorotool.engines.skeleton.both_sides import sides_of
from vorotool.engines.skeleton.exact import (
    ShapeDiagram,
    diagram_of_graph,
    shape_diagram,
    skeleton_of,
    whole_diagram,
)
from vorotool.engines.skeleton.per_feature import FeatureSkeleton, feature_skeleton
from vorotool.geometry.polygons.planar_graph import PlanarGraph
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.skeleton.skeleton import Skeleton
from vorotool.jobs.run_log import Run
from vorotool.jobs.skeleton import SkeletonProducts

if TYPE_CHECKING:
    from vorotool.engines.skeleton.shortened_edges import ElementDiagram


@dataclass(frozen=True)
class Seen:
    """Counts of the diagram of some features.

    Parameters
    ----------
    vertices, edges : int
        Of the diagram.
    deviation : float
        With a gap, how far the skeleton is from the exact one, if that is asked for.
    """

    vertices: int
    edges: int
    deviation: float = 0.0


class ExactProducts(SkeletonProducts):
    """Results of one exact skeleton, or of one with a gap.

    Parameters
    ----------
    polygons : PolygonSet
        Of what.
    options : namespace
        Options of the command line.
    run : Run
        Takes notes and seconds.
    """

    def __init__(self, polygons: PolygonSet, options: SimpleNamespace, run: Run) -> None:
        super().__init__(polygons, options, run)
        # what is refused is refused here, where the input has its name
        if not self._is_inside_only:
            _ = self.graph
        elif self.wants_skeleton:
            _ = self.whole
        else:
            _ = self.derived.offset

    @cached_property
    def shapes(self) -> ShapeDiagram:
        """The diagram of all."""
        with self.run.phase("diagram"), self.telling_once():
            strict = self.options.strict
            if self.options.features == "together":
                return shape_diagram(self._polygons, strict=strict, **self._common)
            return diagram_of_graph(together(self._polygons, strict=strict, **self._common), **self._common)

    @cached_property
    def inside(self) -> FeatureSkeleton[Seen]:
        """What is inside each feature by itself, and what was seen of each diagram that is looked at."""
        o = self.options
        looks = o.verify or o.stats is not None
        with self.telling_once():
            if not o.gap:
                look = self._look if looks else None
                return feature_skeleton(self._polygons, look=look, strict=o.strict, **self._common)
            from vorotool.engines.skeleton.feature_elements import feature_elements

            return feature_elements(
                self._polygons,
                o.gap,
                complete=o.complete is not False,
                look=self._look_at_elements if looks else None,
                strict=o.strict,
                **self._common,
            )

    def _look(self, shapes: ShapeDiagram | ElementDiagram) -> Seen:
        if self.options.verify:
            from vorotool.engines.segment_voronoi.verify_segment_voronoi import verify_segment_voronoi

            verify_segment_voronoi(shapes.diagram, threads=1)
        return Seen(len(shapes.diagram), len(shapes.diagram.edges))

    def _look_at_elements(self, elements: ElementDiagram, made: Skeleton) -> Seen:
        seen = self._look(elements)
        if self.options.stats is None:
            return seen
        from vorotool.engines.skeleton.shortened_edges import exact_inside, gap_deviation

        return replace(seen, deviation=gap_deviation(made, exact_inside(elements)))

    @cached_property
    def elements(self) -> ElementDiagram:
        """That of shortened edges."""
        from vorotool.engines.skeleton.shortened_edges import element_diagram, elements_of_graph

        o = self.options
        with self.run.phase("diagram"), self.telling_once():
            if o.features == "together":
                return element_diagram(self._polygons, o.gap, strict=o.strict, **self._common)
            return elements_of_graph(together(self._polygons, strict=o.strict, **self._common), o.gap, **self._common)

    @property
    def _common(self) -> dict[str, Any]:
        return {"threads": self.options.threads, "progress": self.run.progress("diagram")}

    @property
    def _is_inside_only(self) -> bool:
        """Whether no diagram of all features together is needed."""
        o = self.options
        return o.side == "interior" and o.features == "separate" and "diagram" not in o.what

    def _make_skeleton(self) -> Skeleton:
        o = self.options
        wanted: dict[str, Any] = {"side": o.side, "frame": o.frame, "threads": o.threads}
        if o.features == "separate" and o.side == "interior":
            return self.inside.skeleton
        if not o.gap:
            return (skeleton_of if o.features == "together" else sides_of)(self.shapes, **wanted)
        from vorotool.engines.skeleton.feature_elements import sides_of_elements
        from vorotool.engines.skeleton.shortened_edges import skeleton_of_elements

        made = skeleton_of_elements if o.features == "together" else sides_of_elements
        return made(self.elements, complete=o.complete is not False, **wanted)

    def _make_diagram(self) -> Skeleton:
        o = self.options
        if not o.gap:
            return whole_diagram(self.shapes, frame=o.frame, threads=o.threads)
        from vorotool.engines.skeleton.shortened_edges import whole_element_diagram

        return whole_element_diagram(self.elements, frame=o.frame, threads=o.threads)

    def _shape_diagram(self) -> ShapeDiagram:
        return super()._shape_diagram() if self.options.gap else self.shapes

    @property
    def _part(self) -> ShapeDiagram | ElementDiagram:
        return self.elements if self.options.gap else self.shapes

    @property
    def graph(self) -> PlanarGraph:
        """The shapes as they were placed."""
        return self.elements.shapes if self.options.gap else self.shapes.graph

    def _verify_whole(self) -> None:
        """Check the diagram and the skeleton, from their arrays alone."""
        from vorotool.engines.segment_voronoi.verify_segment_voronoi import verify_segment_voronoi
        from vorotool.engines.skeleton.verify_skeleton import verify_exterior, verify_skeleton

        progress = self.run.progress("verifying")
        if not self._is_inside_only:  # or else each batch was looked at
            verify_segment_voronoi(self._part.diagram, threads=self.options.threads, progress=progress)
        if not self.options.gap and self.options.side != "interior":
            verify_exterior(self.shapes, threads=self.options.threads)
        verify_skeleton(self.whole, threads=self.options.threads, progress=progress)

    def _shape_stats(self) -> dict[str, Any]:
        return self.inside.shapes.counts() if self._is_inside_only else super()._shape_stats()

    def _diagram_stats(self) -> dict[str, Any]:
        if self._is_inside_only:
            seen = self.inside.seen
            return {
                "diagram_vertices": sum(each.vertices for each in seen),
                "diagram_edges": sum(each.edges for each in seen),
            }
        diagram = self._part.diagram
        return {"diagram_vertices": len(diagram), "diagram_edges": len(diagram.edges)}

    def _more_stats(self) -> dict[str, Any]:
        """How far a skeleton with a gap is from the exact one: a second diagram, so only for whom it is written."""
        if not self.options.gap:
            return {}
        o = self.options
        found: dict[str, Any] = {"gap": o.gap, "complete": o.complete is not False}
        if o.stats is not None:
            found["gap_deviation"] = self._gap_deviation()
        return found

    def _gap_deviation(self) -> float:
        o = self.options
        from vorotool.engines.skeleton.parts import outside_of
        from vorotool.engines.skeleton.shortened_edges import exact_for, gap_deviation

        made, side, inside = self.whole, o.side, 0.0
        if o.features == "separate" and side != "exterior":
            inside = max((seen.deviation for seen in self.inside.seen), default=0.0)
            if side == "interior":
                return inside
            made, side = outside_of(made), "exterior"
        return max(inside, gap_deviation(made, exact_for(self.elements, side, frame=made.frame, threads=o.threads)))
