"""What exact skeletons are written as, checked for and counted by."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from vorotool.cli.run import Run
from vorotool.cli.skeletons import SkeletonProducts
from vorotool.engines.skeleton_exact import ShapeDiagram, shape_diagram, skeleton_of, whole_diagram
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
        super().__init__(options, run)
        progress = run.progress("diagram")
        common = {"strict": options.strict, "threads": options.threads, "progress": progress}
        self.shapes: ShapeDiagram | None = None
        self.elements: ElementDiagram | None = None
        with run.phase("diagram"):
            if options.gap:
                from vorotool.engines.skeleton_elements import element_diagram

                self.elements = element_diagram(polygons, options.gap, **common)
            else:
                self.shapes = shape_diagram(polygons, **common)

    def _make_skeleton(self) -> Skeleton:
        o = self.options
        common: dict[str, Any] = {"side": o.side, "frame": o.frame, "threads": o.threads}
        if self.shapes is not None:
            return skeleton_of(self.shapes, **common)
        from vorotool.engines.skeleton_elements import skeleton_of_elements

        assert self.elements is not None
        return skeleton_of_elements(self.elements, complete=o.complete is not False, **common)

    def _make_diagram(self) -> Skeleton:
        if self.shapes is not None:
            return whole_diagram(self.shapes, frame=self.options.frame, threads=self.options.threads)
        from vorotool.engines.skeleton_elements import whole_element_diagram

        assert self.elements is not None
        return whole_element_diagram(self.elements, frame=self.options.frame, threads=self.options.threads)

    def _shape_diagram(self) -> ShapeDiagram:
        return self.shapes if self.shapes is not None else super()._shape_diagram()

    @property
    def _part(self) -> ShapeDiagram | ElementDiagram:
        part = self.shapes if self.shapes is not None else self.elements
        assert part is not None
        return part

    @property
    def graph(self) -> PlanarGraph:
        """The shapes as they were placed."""
        return self._part.graph if self.elements is None else self.elements.shapes

    def _verify_whole(self) -> None:
        """Check the diagram and the skeleton, from their arrays alone."""
        from vorotool.engines.segment_verification import verify_segment_voronoi
        from vorotool.engines.skeleton_verification import verify_exterior, verify_skeleton

        progress = self.run.progress("verifying")
        verify_segment_voronoi(self._part.diagram, threads=self.options.threads, progress=progress)
        if self.shapes is not None and self.options.side != "interior":
            verify_exterior(self.shapes, threads=self.options.threads)
        verify_skeleton(self.whole, threads=self.options.threads, progress=progress)

    def _diagram_stats(self) -> dict[str, Any]:
        diagram = self._part.diagram
        return {"diagram_vertices": len(diagram), "diagram_edges": len(diagram.edges)}

    def _more_stats(self) -> dict[str, Any]:
        """How far a skeleton with a gap is from the exact one: a second diagram, so only for whom it is written."""
        if self.elements is None:
            return {}
        elements = self.elements
        found: dict[str, Any] = {"gap": elements.gap, "complete": self.options.complete is not False}
        if self.options.stats is not None:
            from vorotool.engines.skeleton_elements import exact_for, gap_deviation

            exact = exact_for(elements, self.options.side, frame=self.skeleton.frame, threads=self.options.threads)
            found["gap_deviation"] = gap_deviation(self.whole, exact)
        return found
