"""Results of digital triangulations, their comparison with the exact one, and their repair."""

from __future__ import annotations

from dataclasses import asdict, replace
from functools import cached_property, partial
from typing import Any

from vorotool.engines.digital.comparison import compare_digital
from vorotool.engines.digital.triangulation import (
    DigitalRepair,
    digital_triangulation,
    repair_digital,
    verify_digital_triangulation,
)
from vorotool.engines.tessellation.seeding import seeds_in_frame
from vorotool.errors import Message
from vorotool.jobs.inputs import JobInput, frame_of, window_of
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.triangulation import MeshProducts, ReadPoints
from vorotool.jobs.units import sides_of
from vorotool.numeric.parallel import Progress
from vorotool.types.mesh.triangulation import AnyTriangulation, DigitalComparison
from vorotool.types.points.point_set import PointSet
from vorotool.types.points.seed_set import SeedSet


class DigitalProducts(MeshProducts):
    """Results of the paper's rule (``--method digital``), and of its comparison with the exact triangulation."""

    def __init__(self, run: Run, options: Options, given: JobInput, read: ReadPoints) -> None:
        points = read.points
        if isinstance(points, SeedSet):
            self.seeds = points
        else:
            frame = partial(frame_of, options)
            self.seeds = seeds_in_frame(points, frame, sides=sides_of(options), strict=options.strict)
        super().__init__(run, options, given, read)
        if "compare" in options.what:
            with run.phase("compare"):
                self._tell_comparison()

    @property
    def where(self) -> dict[str, Any]:
        """Options of the engines: the frame, the sides of pixels in steps, and the threads."""
        o = self.options
        return {"window": window_of(o, self.seeds), "spacing": sides_of(o).units, "threads": o.threads}

    def _triangulate(self, points: PointSet | SeedSet, progress: Progress) -> AnyTriangulation:
        return self._as_input(
            points, digital_triangulation(self.seeds, **self.where, strict=self.options.strict, progress=progress)
        )

    def _as_input(self, points: PointSet | SeedSet, mesh: AnyTriangulation) -> AnyTriangulation:
        return replace(mesh, y_axis=points.y_axis, crs=points.crs) if isinstance(points, PointSet) else mesh

    @cached_property
    def comparison(self) -> DigitalComparison:
        """Differences from the exact triangulation."""
        o = self.options  # which the command refuses to have a spacing
        return compare_digital(self.seeds, window=window_of(o, self.seeds), threads=o.threads, max_pixels=o.max_pixels)

    def _tell_comparison(self) -> None:
        self.run.note(self.comparison.summary())
        if self.comparison.suggestion:
            self.run.note(self.comparison.suggestion)

    def value(self, what: str) -> Any:
        """Give what the digital rule finds, or how it differs."""
        return self.comparison.differences if what == "compare" else super().value(what)

    def _shape(self) -> str:
        return f"of {len(self.mesh.points)} regions too few touch"

    def verify(self, progress: Progress) -> None:
        """Check labels, edges and triangles by another way."""
        found = digital_triangulation(self.seeds, **self.where, progress=progress)
        verify_digital_triangulation(found, self.seeds, **self.where)

    def stats(self) -> dict[str, Any]:
        """Counts, and how good they are."""
        counts: dict[str, Any] = {"points": len(self.seeds.sites) if self.seeds.sites is not None else 0}
        if self.wants_mesh:
            mesh: Any = self.mesh
            counts |= {
                "edges": len(mesh.edges),
                "triangles": len(mesh.triangles),
                "three_label_corners": mesh.three_label_corners,
                "four_label_corners": mesh.four_label_corners,
            }
        if "compare" in self.options.what:
            found = self.comparison
            names = ("edge_precision", "edge_recall", "triangle_precision", "triangle_recall")
            counts["compare"] = {name: getattr(found, name) for name in names} | {
                "differences": found.counts,
                "suggestion": Message.of(found.suggestion).typed,
            }
        return {**counts, "method": "digital", "threads": self.options.threads}


class RepairedProducts(DigitalProducts):
    """Results of the certified repair (``--method digital-valid``): those of the exact triangulation."""

    repair: DigitalRepair

    def _triangulate(self, points: PointSet | SeedSet, progress: Progress) -> AnyTriangulation:
        o = self.options
        mesh, self.repair = repair_digital(
            self.seeds, **self.where, strict=o.strict, max_pixels=o.max_pixels, progress=progress
        )
        if isinstance(points, PointSet):
            mesh = replace(mesh, first_number=points.first_number)
        return self._as_input(points, mesh)

    def _shape(self) -> str:
        return MeshProducts._shape(self)

    def verify(self, progress: Progress) -> None:
        """Check the triangulation exactly, once more."""
        MeshProducts.verify(self, progress)

    def stats(self) -> dict[str, Any]:
        """Counts, and what each step of the repair did."""
        return {**MeshProducts.stats(self), "repair": asdict(self.repair)}
