"""What a skeleton can be written as (``--what``)."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from vorotool.cli.pictures import write_layers
from vorotool.cli.run import Run
from vorotool.cli.targets import Target
from vorotool.engines.skeleton_exact import ShapeDiagram, shape_diagram, skeleton_of, whole_diagram
from vorotool.errors import VorotoolWarning
from vorotool.geometry.polygons import PolygonSet
from vorotool.geometry.skeleton import EXTERIOR, Skeleton

if TYPE_CHECKING:
    from vorotool.engines.skeleton_elements import ElementDiagram
    from vorotool.render.layers import Page

DEFAULT_LAYERS = {
    "skeleton": ("polygons", "skeleton"),
    "diagram": ("polygons", "elements", "points", "skeleton"),
    "elements": ("polygons", "elements", "points"),
}
"""Layers of the picture of each result."""


class SkeletonProducts:
    """Results of one skeleton.

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
        self.options, self.run = options, run
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

    @cached_property
    def skeleton(self) -> Skeleton:
        """Of the side that is asked for."""
        o = self.options
        common: dict[str, Any] = {"side": o.side, "frame": o.frame, "threads": o.threads}
        with self.run.phase("skeleton"):
            if self.shapes is not None:
                return skeleton_of(self.shapes, **common)
            from vorotool.engines.skeleton_elements import skeleton_of_elements

            assert self.elements is not None
            return skeleton_of_elements(self.elements, complete=o.complete is not False, **common)

    @cached_property
    def diagram(self) -> Skeleton:
        """All edges of the diagram, cut by the frame."""
        with self.run.phase("skeleton"):
            if self.shapes is not None:
                return whole_diagram(self.shapes, frame=self.options.frame, threads=self.options.threads)
            from vorotool.engines.skeleton_elements import whole_element_diagram

            assert self.elements is not None
            return whole_element_diagram(self.elements, frame=self.options.frame, threads=self.options.threads)

    def _value(self, what: str) -> Skeleton:
        return self.diagram if what == "diagram" else self.skeleton

    def check(self, target: Target) -> None:
        """Compute a result, and refuse what cannot be written, before anything is written."""
        value = self._value(target.what)
        if target.fmt == "png":
            from vorotool.render.layers_png import check_picture_size

            check_picture_size(self._page(value), self.options.max_pixels)
        if not len(value) and target.what in ("skeleton", "branches") and self.options.side == "exterior":
            warnings.warn("the exterior skeleton is empty", VorotoolWarning, stacklevel=2)

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        from vorotool.formats.outputs import open_output

        with open_output(
            target.path, binary=target.is_binary, no_clobber=self.options.no_clobber, inputs=inputs
        ) as out:
            if target.fmt in ("svg", "png"):
                self._write_picture(out, target)
            else:
                self._write_data(out, target)

    def _write_data(self, out: BinaryIO, target: Target) -> None:
        from vorotool.formats.skeleton_files import write_skeleton

        write_skeleton(
            out,
            self._value(target.what),
            target.fmt,
            what="skeleton" if target.what == "diagram" else target.what,
            flatten=self.options.flatten,
            precision=self.options.precision,
            threads=self.options.threads,
        )

    def _page(self, value: Skeleton) -> Page:
        from vorotool.render.skeleton_layers import skeleton_page

        return skeleton_page(value, width=self.options.width or 1000, y_up=self.options.y_up)

    def _write_picture(self, out: BinaryIO, target: Target) -> None:
        from vorotool.render.skeleton_layers import picture_layers

        value = self._value(target.what)
        page = self._page(value)
        layers = picture_layers(value, page, self.options.layers or DEFAULT_LAYERS[target.what], what=target.what)
        write_layers(out, layers, page, fmt=target.fmt, threads=self.options.threads)

    def verify(self) -> None:
        """Check the diagram and the skeleton, from their arrays alone."""
        from vorotool.engines.segment_verification import verify_segment_voronoi
        from vorotool.engines.skeleton_verification import verify_exterior, verify_skeleton

        part = self.shapes if self.shapes is not None else self.elements
        assert part is not None
        progress = self.run.progress("verifying")
        verify_segment_voronoi(part.diagram, threads=self.options.threads, progress=progress)
        if self.shapes is not None and self.options.side != "interior":
            verify_exterior(self.shapes, threads=self.options.threads)
        verify_skeleton(self.skeleton, threads=self.options.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        part = self.shapes if self.shapes is not None else self.elements
        assert part is not None
        graph = part.graph if self.elements is None else self.elements.shapes
        skeleton, options = self.skeleton, self.options
        assert graph.polygons is not None
        found: dict[str, Any] = {
            "polygons": len(graph.polygons),
            "vertices": len(graph.polygons.xy),
            "sites": len(skeleton.site_table),
            "segments": len(graph),
            "lattice_step": graph.scale,
            "largest_move": graph.largest_move,
            "repairs": graph.repairs,
            "diagram_vertices": len(part.diagram),
            "diagram_edges": len(part.diagram.edges),
            "decisions": part.diagram.counts,
            "arcs": len(skeleton),
            "parabolas": int(np.count_nonzero(skeleton.is_parabola)),
            "exterior_arcs": int(np.count_nonzero(skeleton.side == EXTERIOR)),
            "branches": int(skeleton.branch[-1]) + 1 if len(skeleton) else 0,
            "nodes": len(skeleton.vertices),
            "side": options.side,
            "threads": options.threads,
        }
        if skeleton.frame is not None:
            found["frame"] = list(skeleton.frame)
        if self.elements is not None:
            found |= self._gap_stats(self.elements)
        return found

    def _gap_stats(self, elements: ElementDiagram) -> dict[str, Any]:
        """How far the skeleton is from the exact one: that takes a second diagram, so only for whom it is written."""
        found: dict[str, Any] = {"gap": elements.gap, "complete": self.options.complete is not False}
        if self.options.stats is not None:
            from vorotool.engines.skeleton_elements import exact_for, gap_deviation

            exact = exact_for(elements, self.options.side, frame=self.skeleton.frame, threads=self.options.threads)
            found["gap_deviation"] = gap_deviation(self.skeleton, exact)
        return found
