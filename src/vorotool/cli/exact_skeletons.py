"""What exact skeletons are written as, checked for and counted by."""

from __future__ import annotations

from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from vorotool.cli.run import Run
from vorotool.cli.skeletons import SkeletonProducts
from vorotool.engines.feature_batches import together
from vorotool.engines.feature_sides import sides_of
from vorotool.engines.feature_skeletons import FeatureSkeleton, feature_skeleton
from vorotool.engines.skeleton_exact import (
    ShapeDiagram,
    diagram_of_graph,
    shape_diagram,
    skeleton_of,
    whole_diagram,
)
from vorotool.geometry.planar_graph import PlanarGraph
from vorotool.geometry.polygons import PolygonSet
from vorotool.geometry.skeleton import Skeleton

if TYPE_CHECKING:
    from vorotool.engines.skeleton_elements import ElementDiagram


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
    def inside(self) -> FeatureSkeleton[tuple[int, int]]:
        """What is inside each feature by itself, and the vertices and edges of each diagram that is looked at."""
        o = self.options
        look = self._look if o.verify or o.stats is not None else None
        with self.telling_once():
            return feature_skeleton(self._polygons, look=look, strict=o.strict, **self._common)

    def _look(self, shapes: ShapeDiagram) -> tuple[int, int]:
        if self.options.verify:
            from vorotool.engines.segment_verification import verify_segment_voronoi

            verify_segment_voronoi(shapes.diagram, threads=1)
        return len(shapes.diagram), len(shapes.diagram.edges)

    @cached_property
    def elements(self) -> ElementDiagram:
        """That of shortened edges."""
        from vorotool.engines.skeleton_elements import element_diagram

        with self.run.phase("diagram"):
            return element_diagram(self._polygons, self.options.gap, strict=self.options.strict, **self._common)

    @property
    def _common(self) -> dict[str, Any]:
        return {"threads": self.options.threads, "progress": self.run.progress("diagram")}

    @property
    def _is_inside_only(self) -> bool:
        """Whether no diagram of all features together is needed."""
        o = self.options
        if o.gap or o.side != "interior":
            return False
        return o.features == "separate" and "diagram" not in o.what

    def _make_skeleton(self) -> Skeleton:
        o = self.options
        wanted: dict[str, Any] = {"side": o.side, "frame": o.frame, "threads": o.threads}
        if o.gap:
            from vorotool.engines.skeleton_elements import skeleton_of_elements

            return skeleton_of_elements(self.elements, complete=o.complete is not False, **wanted)
        if o.features == "together":
            return skeleton_of(self.shapes, **wanted)
        return self.inside.skeleton if o.side == "interior" else sides_of(self.shapes, **wanted)

    def _make_diagram(self) -> Skeleton:
        o = self.options
        if not o.gap:
            return whole_diagram(self.shapes, frame=o.frame, threads=o.threads)
        from vorotool.engines.skeleton_elements import whole_element_diagram

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
        from vorotool.engines.segment_verification import verify_segment_voronoi
        from vorotool.engines.skeleton_verification import verify_exterior, verify_skeleton

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
            vertices, edges = zip(*self.inside.seen, strict=True) if self.inside.seen else ((), ())
            return {"diagram_vertices": sum(vertices), "diagram_edges": sum(edges)}
        diagram = self._part.diagram
        return {"diagram_vertices": len(diagram), "diagram_edges": len(diagram.edges)}

    def _more_stats(self) -> dict[str, Any]:
        """How far a skeleton with a gap is from the exact one: a second diagram, so only for whom it is written."""
        if not self.options.gap:
            return {}
        elements = self.elements
        found: dict[str, Any] = {"gap": elements.gap, "complete": self.options.complete is not False}
        if self.options.stats is not None:
            from vorotool.engines.skeleton_elements import exact_for, gap_deviation

            exact = exact_for(elements, self.options.side, frame=self.skeleton.frame, threads=self.options.threads)
            found["gap_deviation"] = gap_deviation(self.whole, exact)
        return found
