"""What approximate skeletons are written as, checked for and counted by."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.sampled_skeleton.approximate import (
    MOST_SEEDS,
    SampledShapes,
    SamplingOptions,
    Wanted,
    sample_table,
    whole_sampled_diagram,
)
from vorotool.engines.sampled_skeleton.per_feature import FeatureApproximation, approximation, samples_of_graph
from vorotool.errors import silent, warn
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.skeletons.products import SkeletonProducts
from vorotool.jobs.targets import Target
from vorotool.jobs.units import Amount, lengths_among, table_in_units
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import Skeleton

OF_ERRORS = ("largest", "mean", "largest_estimate", "largest_bound")
"""Statistics of errors that are lengths."""

ALL_TOGETHER = {"diagram", "elements"}
"""What is of all features together, however they are taken."""


class ApproximateProducts(SkeletonProducts):
    """Results of one approximate skeleton: see `SkeletonProducts`."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        super().__init__(run, options, given)
        options = self.options  # lengths are in pixels, or in steps
        self._sampling = SamplingOptions(options.step, options.tolerance, options.sampling)
        self._complete = (options.tolerance is not None) if options.complete is None else options.complete
        most = min(options.max_sites, MOST_SEEDS)
        self._wanted = Wanted(options.side, options.frame, self._complete, most, options.threads)
        self._apart: dict[str, Any] | None = None
        # what is refused is refused here, where the input has its name
        if set(options.what) & ALL_TOGETHER:
            _ = self.shapes
        _ = self.found

    @cached_property
    def graph(self) -> PlanarGraph:
        """The shapes as they were placed, all of them together."""
        o = self.options
        if o.features == "together":
            return self.shapes.graph
        with self.telling_once():
            return self.call("engines.features.batches:together", self._polygons, phase="place")

    @cached_property
    def shapes(self) -> SampledShapes:
        """Samples of all features and their one diagram."""
        if self.options.features == "together":
            return self.found.parts[0].shapes
        graph = self.graph
        with self.run.phase("diagram") as progress:
            return samples_of_graph(graph, self._sampling, replace(self._wanted, progress=progress))

    @cached_property
    def found(self) -> FeatureApproximation:
        """The skeleton, and what it was made of."""
        o = self.options
        with self.run.phase("diagram") as progress, self.telling_once():
            wanted = replace(self._wanted, progress=progress)
            return approximation(self._polygons, self._sampling, wanted, features=o.features, strict=o.strict)

    def _make_skeleton(self) -> Skeleton:
        return self.found.skeleton

    def _make_diagram(self) -> Skeleton:
        return whole_sampled_diagram(self.shapes, frame=self.options.frame, threads=self.options.threads)

    def _points(self, what: str) -> NDArray[np.float64]:
        return self.shapes.samples.xy if what in ALL_TOGETHER else self.found.places

    @cached_property
    def exact(self) -> Skeleton:
        """The exact skeleton of the same shapes."""
        o, frame = self.options, self.found.skeleton.frame
        how = {"side": o.side, "features": o.features, "frame": frame, "strict": False}
        with silent():
            return self.call("engines.skeleton_api:skeleton_exact", self._polygons, phase="exact", **how)

    def written(self, what: str, fmt: str) -> Any:
        """Give a result in the units of files: elements are the samples."""
        if what != "elements":
            return super().written(what, fmt)
        return table_in_units(self.options.pixel_size, sample_table(self.shapes.samples))

    def _verify_whole(self, progress: Progress) -> None:
        """Check the samples and the skeleton, from their arrays alone."""
        for part in self.found.parts:
            resolved("engines.sampled_skeleton.verify_approximate:verify_samples")(part, step=self.options.step)
        super()._verify_whole(progress)

    def _shape_stats(self) -> dict[str, Any]:
        inside = self.found.inside if self.options.side == "interior" else None
        return super()._shape_stats() if inside is None else inside.counts()

    def _diagram_stats(self) -> dict[str, Any]:
        return self.found.counts()

    def _more_stats(self) -> dict[str, Any]:
        o = self.options
        found: dict[str, Any] = {
            "step": Amount(o.step),
            "tolerance": Amount(o.tolerance),
            "sampling": "symmetric" if SamplingOptions(o.step, o.tolerance, o.sampling).is_symmetric else "paper",
            "complete": self._complete,
            "open_corners": self.found.open_corners,
        }
        if o.stats is None and not o.compare:
            return found
        error_summary = resolved("engines.sampled_skeleton.hausdorff:error_summary")
        found["error"] = lengths_among(error_summary(self.found, step=o.step), *OF_ERRORS)
        if o.compare:
            found["comparison"] = lengths_among(self._apart, *OF_ERRORS)
        return found

    def check(self, target: Target) -> None:
        """Compute a result, and compare the skeleton if that is asked for: it is said whether statistics are or not."""
        super().check(target)
        if self.options.compare and self._apart is None:
            self._apart = self._comparison()

    def _comparison(self) -> dict[str, Any]:
        """How far the exact skeleton is."""
        found: dict[str, Any] = self.call(
            "engines.sampled_skeleton.hausdorff:compare_parts", self.found, phase="compare", side=self.options.side
        )
        tolerance = self.options.tolerance
        for name, value in found.items():
            if value is None:
                continue
            place = f"({value['x']:g}, {value['y']:g})"
            said = f"{name.replace('_', ' ')} the distance is up to {value['largest']:.3g}, near {place}"
            if tolerance is not None and value["largest"] > tolerance:
                warn(f"{said}: more than the tolerance of {tolerance:g}")
            else:
                self.run.note(said)
        return found
