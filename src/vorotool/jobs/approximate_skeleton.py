"""What approximate skeletons are written as, checked for and counted by."""

from __future__ import annotations

import warnings
from functools import cached_property
from types import SimpleNamespace
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.arrangement.lattice_rings import placed_shapes
from vorotool.engines.arrangement.planar_graph import graph_for_skeletons
from vorotool.engines.features.batches import together
from vorotool.engines.sampled_skeleton.approximate import (
    MOST_SEEDS,
    ApproximateSkeleton,
    SampledShapes,
    SamplingOptions,
    approximate_skeleton,
    sampled_graph,
    whole_sampled_diagram,
)
from vorotool.engines.sampled_skeleton.per_feature import (
    FeatureApproximation,
    approximation_of_sides,
    feature_approximation,
    of_one_part,
)
from vorotool.errors import VorotoolWarning
from vorotool.geometry.polygons.planar_graph import PlanarGraph
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.skeleton.boundary_samples import sample_table
from vorotool.geometry.skeleton.skeleton import Skeleton
from vorotool.jobs.run_log import Run
from vorotool.jobs.skeleton import SkeletonProducts
from vorotool.jobs.targets import Target

ALL_TOGETHER = {"diagram", "elements"}
"""What is of all features together, however they are taken."""


class ApproximateProducts(SkeletonProducts):
    """Results of one approximate skeleton.

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
        self._common: dict[str, Any] = {"threads": options.threads, "progress": run.progress("skeleton")}
        self._sampling = SamplingOptions(options.step, options.tolerance, options.sampling)
        self._most = min(options.max_sites, MOST_SEEDS)
        self._found: ApproximateSkeleton | None = None
        self._apart: dict[str, Any] | None = None
        # what is refused is refused here, where the input has its name
        if options.features == "together" or set(options.what) & ALL_TOGETHER:
            _ = self.shapes
        if self.wants_skeleton and options.features == "separate":
            _ = self.found
        elif not self.wants_skeleton:
            _ = self.derived.offset

    @cached_property
    def graph(self) -> PlanarGraph:
        """The shapes as they were placed, all of them together."""
        o = self.options
        with self.run.phase("place"), self.telling_once():
            if o.features == "together":
                return graph_for_skeletons(self._polygons, strict=o.strict, **self._common)
            return together(self._polygons, strict=o.strict, **self._common)

    @cached_property
    def shapes(self) -> SampledShapes:
        """Samples of all features and their one diagram."""
        o = self.options
        placed = placed_shapes(self.graph, threads=o.threads)
        with self.run.phase("diagram"):
            if o.tolerance is None:
                return sampled_graph(self.graph, placed, self._sampling, most=self._most, **self._common)
            from vorotool.engines.sampled_skeleton.refinement import skeleton_within

            self._found = skeleton_within(
                self.graph, placed, o.tolerance, **self._wanted, most=self._most, **self._common
            )
            return self._found.shapes

    @property
    def _wanted(self) -> dict[str, Any]:
        o = self.options
        complete = (o.tolerance is not None) if o.complete is None else o.complete
        return {"side": o.side, "frame": o.frame, "complete": complete}

    @cached_property
    def found(self) -> FeatureApproximation:
        """The skeleton, and what it was made of."""
        wanted = self._wanted
        if self.options.features == "together":
            shapes = self.shapes
            return of_one_part(self._found or approximate_skeleton(shapes, **wanted, **self._common))
        common: dict[str, Any] = {"strict": self.options.strict, "most": self._most, **self._common}
        with self.run.phase("diagram"), self.telling_once():
            if wanted["side"] != "interior":
                return approximation_of_sides(self._polygons, self._sampling, **wanted, **common)
            return feature_approximation(self._polygons, self._sampling, complete=wanted["complete"], **common)

    def _make_skeleton(self) -> Skeleton:
        return self.found.skeleton

    def _make_diagram(self) -> Skeleton:
        return whole_sampled_diagram(self.shapes, frame=self.options.frame, threads=self.options.threads)

    def _points(self, what: str) -> NDArray[np.float64]:
        return self.shapes.samples.xy if what in ALL_TOGETHER else self.found.places

    @cached_property
    def exact(self) -> Skeleton:
        """The exact skeleton of the same shapes."""
        from vorotool.engines.skeleton_api import skeleton_exact

        o = self.options
        with self.run.phase("exact"), warnings.catch_warnings():
            warnings.simplefilter("ignore", VorotoolWarning)  # all that was told before
            frame = self.found.skeleton.frame
            return skeleton_exact(self._polygons, side=o.side, features=o.features, frame=frame, threads=o.threads)

    def _write_data(self, out: BinaryIO, target: Target) -> None:
        if target.what != "elements":
            super()._write_data(out, target)
            return
        from vorotool.formats.text.tables import write_table

        o = self.options
        write_table(out, sample_table(self.shapes.samples), target.fmt, precision=o.precision, threads=o.threads)

    def _verify_whole(self) -> None:
        """Check the samples and the skeleton, from their arrays alone."""
        from vorotool.engines.sampled_skeleton.verify_approximate import verify_approximate

        progress = self.run.progress("verifying")
        for part in self.found.parts:
            verify_approximate(part, step=self.options.step, threads=self.options.threads, progress=progress)

    def _shape_stats(self) -> dict[str, Any]:
        inside = self.found.inside if self.options.side == "interior" and self.wants_skeleton else None
        return super()._shape_stats() if inside is None else inside.counts()

    def _diagram_stats(self) -> dict[str, Any]:
        return self.found.counts()

    def _more_stats(self) -> dict[str, Any]:
        o = self.options
        found: dict[str, Any] = {
            "step": o.step,
            "tolerance": o.tolerance,
            "sampling": "symmetric" if SamplingOptions(o.step, o.tolerance, o.sampling).is_symmetric else "paper",
            "complete": self._wanted["complete"],
            "open_corners": self.found.open_corners,
        }
        if o.stats is None and not o.compare:
            return found
        from vorotool.engines.sampled_skeleton.error_summary import error_summary

        found["error"] = error_summary(self.found, step=o.step)
        if o.compare:
            found["comparison"] = self._apart
        return found

    def check(self, target: Target) -> None:
        """Compute a result, and compare the skeleton if that is asked for: it is said whether statistics are or not."""
        super().check(target)
        if self.options.compare and self._apart is None:
            self._apart = self._comparison()

    def _comparison(self) -> dict[str, Any]:
        """How far the exact skeleton is."""
        from vorotool.engines.sampled_skeleton.hausdorff import compare_parts

        with self.run.phase("compare"):
            found = compare_parts(self.found, side=self.options.side, threads=self.options.threads)
        tolerance = self.options.tolerance
        for name, value in found.items():
            if value is None:
                continue
            place = f"({value['x']:g}, {value['y']:g})"
            said = f"{name.replace('_', ' ')} the distance is up to {value['largest']:.3g}, near {place}"
            if tolerance is not None and value["largest"] > tolerance:
                warnings.warn(f"{said}: more than the tolerance of {tolerance:g}", VorotoolWarning, stacklevel=2)
            else:
                self.run.note(said)
        return found
