"""What approximate skeletons are written as, checked for and counted by."""

from __future__ import annotations

import warnings
from functools import cached_property
from types import SimpleNamespace
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.cli.run import Run
from vorotool.cli.skeletons import SkeletonProducts
from vorotool.cli.targets import Target
from vorotool.engines.placed_rings import placed_shapes
from vorotool.engines.planar_graph import graph_for_skeletons
from vorotool.engines.skeleton_approx import (
    MOST_SEEDS,
    ApproximateSkeleton,
    SampledShapes,
    SamplingOptions,
    approximate_skeleton,
    sampled_graph,
    whole_sampled_diagram,
)
from vorotool.errors import VorotoolWarning
from vorotool.geometry.edge_samples import sample_table
from vorotool.geometry.planar_graph import PlanarGraph
from vorotool.geometry.polygons import PolygonSet
from vorotool.geometry.skeleton import Skeleton


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
        sampling = SamplingOptions(options.step, options.tolerance, options.sampling)
        self._most = min(options.max_sites, MOST_SEEDS)
        self._found: ApproximateSkeleton | None = None
        self._apart: dict[str, Any] | None = None
        with run.phase("place"):
            self._graph = graph_for_skeletons(polygons, strict=options.strict, **self._common)
            placed = placed_shapes(self._graph, threads=options.threads)
        with run.phase("diagram"):
            if options.tolerance is None:
                self.shapes: SampledShapes = sampled_graph(
                    self._graph, placed, sampling, most=self._most, **self._common
                )
            else:
                from vorotool.engines.skeleton_tolerance import skeleton_within

                self._found = skeleton_within(
                    self._graph, placed, options.tolerance, **self._wanted, most=self._most, **self._common
                )
                self.shapes = self._found.shapes

    @property
    def _wanted(self) -> dict[str, Any]:
        o = self.options
        complete = (o.tolerance is not None) if o.complete is None else o.complete
        return {"side": o.side, "frame": o.frame, "complete": complete}

    @cached_property
    def found(self) -> ApproximateSkeleton:
        """The skeleton, and what it was made of."""
        if self._found is not None:
            return self._found
        return approximate_skeleton(self.shapes, **self._wanted, **self._common)

    def _make_skeleton(self) -> Skeleton:
        return self.found.skeleton

    def _make_diagram(self) -> Skeleton:
        return whole_sampled_diagram(self.shapes, frame=self.options.frame, threads=self.options.threads)

    @property
    def graph(self) -> PlanarGraph:
        """The shapes as they were placed."""
        return self._graph

    @property
    def _points(self) -> NDArray[np.float64]:
        return self.shapes.samples.xy

    @cached_property
    def exact(self) -> Skeleton:
        """The exact skeleton of the same shapes."""
        from vorotool.engines.skeleton_comparison import exact_skeleton

        o = self.options
        with self.run.phase("exact"):
            return exact_skeleton(self.found, side=o.side, frame=self.found.skeleton.frame, threads=o.threads)

    def _write_data(self, out: BinaryIO, target: Target) -> None:
        if target.what != "elements":
            super()._write_data(out, target)
            return
        from vorotool.formats.tables import write_table

        o = self.options
        write_table(out, sample_table(self.shapes.samples), target.fmt, precision=o.precision, threads=o.threads)

    def _verify_whole(self) -> None:
        """Check the samples and the skeleton, from their arrays alone."""
        from vorotool.engines.approximate_verification import verify_approximate

        progress = self.run.progress("verifying")
        verify_approximate(self.found, step=self.options.step, threads=self.options.threads, progress=progress)

    def _diagram_stats(self) -> dict[str, Any]:
        return {"samples": len(self.shapes.samples), **self.shapes.diagram.counts}

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
        from vorotool.engines.skeleton_errors import error_summary

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
        from vorotool.engines.skeleton_comparison import compare_with_exact

        with self.run.phase("compare"):
            found = compare_with_exact(self.found, side=self.options.side, threads=self.options.threads)
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
