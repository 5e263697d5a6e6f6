"""Approximate skeletons of features: what is inside each as if it were alone, what is outside of all together."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.planar_graph import arranged, graph_for_skeletons, placed_vertices
from vorotool.engines.arrangement.repaired_polygons import PlacedShapes, placed_shapes
from vorotool.engines.features.batches import BatchShapes, FeatureShapes, in_batches, together
from vorotool.engines.features.order import numbers_of_batches
from vorotool.engines.sampled_skeleton.approximate import (
    ApproximateSkeleton,
    SampledShapes,
    SampleGroups,
    SamplingOptions,
    Wanted,
    approximate_skeleton,
    core_graph,
    diagram_by_step,
    diagram_of_samples,
    sampled_graph,
    skeleton_of_samples,
    told_together,
    warn_without_inside,
)
from vorotool.engines.skeleton.diagrams import joined_sides, joined_with_places
from vorotool.engines.skeleton.exact import warn_empty
from vorotool.engines.skeleton.parts import contraction
from vorotool.errors import LimitError, silent
from vorotool.frozen import frozen
from vorotool.numeric.parallel import Run
from vorotool.types.box import bounds
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import Skeleton


@frozen(eq=False)
class FeatureApproximation:
    """An approximate skeleton of features, and what it was made of."""

    skeleton: Skeleton  # what is inside features, one after the other, then what is outside
    # (a, 2) int32 array: the seeds beside each arc, numbered part after part; -1 of lines that lead to corners
    seeds: NDArray[np.int32]
    parts: list[ApproximateSkeleton]  # of batches of features, then of what is outside
    # list of integer arrays: the number in `skeleton` of each arc of each part; where rounding leaves no length of it,
    # of one at its node
    arcs: Sequence[NDArray[np.integer]]
    inside: FeatureShapes | None  # what features are; None of what is outside alone

    @property
    def open_corners(self) -> int:
        """Corners under 180 degrees that could not be joined."""
        return sum(part.open_corners for part in self.parts)

    @property
    def places(self) -> NDArray[np.float64]:
        """(s, 2) the seeds of all parts."""
        return np.concatenate([np.empty((0, 2)), *(part.shapes.samples.xy for part in self.parts)])

    def counts(self) -> dict[str, int]:
        """Sums over the diagrams."""
        total = {"samples": 0, "triangles": 0, "shared_label": 0, "crossed": 0, "walked_pieces": 0}
        for part in self.parts:
            for name, count in {"samples": len(part.shapes.samples), **part.shapes.diagram.counts}.items():
                total[name] += count
        return total


class _SeedBudget:
    """How many seeds all batches may have, whichever thread they are on."""

    def __init__(self, most: int, options: SamplingOptions) -> None:
        self.most, self._left, self._options, self._lock = most, most, options, threading.Lock()

    def take(self, count: int) -> None:
        with self._lock:
            self._left -= count
            if self._left < 0:
                raise self.error()

    def error(self) -> LimitError:
        if self._options.step is not None:
            return LimitError(
                f"a step of {self._options.step:g} gives too many seeds, more than {self.most}: use a larger step"
            )
        return LimitError(
            f"errors of at most {self._options.tolerance:g} need more than {self.most} seeds (too many seeds): use a "
            "larger tolerance, or allow more seeds"
        )


def of_one_part(found: ApproximateSkeleton) -> FeatureApproximation:
    """Give the approximate skeleton of one arrangement as one of features taken together."""
    return FeatureApproximation(found.skeleton, found.seeds, [found], [np.arange(len(found.skeleton))], None)


def approximation(
    polygons: PolygonSet, options: SamplingOptions, wanted: Wanted, *, features: str = "separate", strict: bool = False
) -> FeatureApproximation:
    """Approximate the skeleton of polygons; arguments, errors and warnings as of `vorotool.skeleton_approx`."""
    if features == "together":
        graph = graph_for_skeletons(polygons, strict=strict, threads=wanted.threads, progress=wanted.progress)
        found = of_one_part(_of_graph(graph, options, wanted))
    elif wanted.side == "interior":
        found = feature_approximation(polygons, options, wanted, strict=strict)
    else:
        found = approximation_of_sides(polygons, options, wanted, strict=strict)
    return _contracted(found)


def _contracted(found: FeatureApproximation) -> FeatureApproximation:
    """Contract arcs whose two nodes have the same coordinates; the parts stay as they were made."""
    less = contraction(found.skeleton)
    if less is None:
        return found
    seeds = found.seeds[less.original]
    return replace(
        found,
        skeleton=less.skeleton,
        seeds=np.where(less.is_reversed[:, None], seeds[:, ::-1], seeds),
        arcs=[less.number[arcs] for arcs in found.arcs],
    )


def feature_approximation(
    polygons: PolygonSet, options: SamplingOptions, wanted: Wanted, *, strict: bool = False
) -> FeatureApproximation:
    """Approximate the skeleton inside polygons, each feature as it would be alone on the lattice of all."""
    budget = _SeedBudget(wanted.most, options)

    def work(shapes: BatchShapes, run: Run) -> ApproximateSkeleton:
        try:
            found = _inside(shapes, options, replace(wanted, side="interior", frame=None, **run))
        except _core.sampled_skeleton.TooManySeedsError:
            raise budget.error() from None
        budget.take(len(found.shapes.samples))
        return found

    whole, made = in_batches(polygons, work, strict=strict, threads=wanted.threads, progress=wanted.progress)
    if not whole.polygon_count:
        warn_empty(polygons, "interior")
    skeleton, places = joined_with_places(whole, [(shapes, found.skeleton) for shapes, found in made])
    if options.tolerance is not None:
        refuse_unproved(skeleton, options.tolerance)
    parts = [found for _, found in made]
    arcs = numbers_of_batches(places, [len(found.skeleton) for found in parts])
    return FeatureApproximation(skeleton, _joined_seeds(parts, arcs), parts, arcs, whole)


def approximation_of_sides(
    polygons: PolygonSet, options: SamplingOptions, wanted: Wanted, *, strict: bool = False
) -> FeatureApproximation:
    """Approximate the skeleton outside of all polygons, and with both sides what is inside each feature, too."""
    common: dict[str, Any] = {"threads": wanted.threads, "progress": wanted.progress}
    graph = together(polygons, strict=strict, **common)
    if wanted.side == "exterior":
        return of_one_part(_of_graph(graph, options, wanted))
    with silent():  # repairs were told where all were put together
        inside = feature_approximation(polygons, options, wanted)
    if not len(inside.skeleton):
        warn_empty(polygons, wanted.side)
    placement = placed_vertices(inside.skeleton.polygons, **common)
    again = arranged(inside.skeleton.polygons, placement, progress=wanted.progress).graph
    outside = _of_graph(again, options, replace(wanted, side="exterior"))
    skeleton = joined_sides(inside.skeleton, outside.skeleton, outside.shapes.placed, again)
    parts = [*inside.parts, outside]
    arcs = [*inside.arcs, len(inside.skeleton) + np.arange(len(outside.skeleton))]
    return FeatureApproximation(skeleton, _joined_seeds(parts, arcs), parts, arcs, inside.inside)


def _inside(shapes: BatchShapes, options: SamplingOptions, wanted: Wanted) -> ApproximateSkeleton:
    groups = _groups(shapes)
    if options.tolerance is not None:
        return refined_skeleton(shapes.graph, shapes.placed, options.tolerance, groups, wanted)
    return skeleton_of_samples(diagram_by_step(shapes.graph, shapes.placed, options, groups, wanted), wanted)


def _of_graph(graph: PlanarGraph, options: SamplingOptions, wanted: Wanted) -> ApproximateSkeleton:
    placed = placed_shapes(graph)
    if options.tolerance is not None:
        return skeleton_within(graph, placed, options.tolerance, wanted)
    return approximate_skeleton(sampled_graph(graph, placed, options, wanted), wanted)


def samples_of_graph(graph: PlanarGraph, options: SamplingOptions, wanted: Wanted) -> SampledShapes:
    """Sample a graph as its skeleton needs it, and compute the Voronoi diagram of the seeds."""
    placed = placed_shapes(graph)
    if options.tolerance is None:
        return sampled_graph(graph, placed, options, wanted)
    return skeleton_within(graph, placed, options.tolerance, wanted).shapes


def _groups(shapes: BatchShapes) -> SampleGroups:
    """Each feature has a diagram of its own, which is put into order in the bounds of all."""
    batch = shapes.batch
    corners = np.concatenate([batch.placement.vertices, batch.beyond])
    (least_x, least_y), (most_x, most_y) = (bound.tolist() for bound in bounds(corners))
    within = (float(least_x), float(most_x), float(least_y), float(most_y))
    present, group = np.unique(shapes.feature_of_point, return_inverse=True)
    return SampleGroups(group.astype(np.int32) if len(present) > 1 else np.empty(0, dtype=np.int32), within)


def _joined_seeds(parts: Sequence[ApproximateSkeleton], arcs: Sequence[NDArray[np.integer]]) -> NDArray[np.int32]:
    seeds = np.full((sum(map(len, arcs)), 2), -1, dtype=np.int32)
    first = 0
    for part, numbers in zip(parts, arcs, strict=True):
        seeds[numbers] = np.where(part.seeds >= 0, part.seeds + np.int32(first), -1)
        first += len(part.shapes.samples)
    return seeds


COARSEST = 2.0**-4
"""Of the extent: the longest gaps that sampling begins with."""
LEAST_STEPS = 2.0**-8
"""Of the lattice: the least tolerance. Seeds and nodes are rounded to about 2^-21 of a step."""
MOST_ROUNDS = 60
"""Gaps are at least halved where they are too long: no more than this from the extent to the least of doubles."""


def skeleton_within(graph: PlanarGraph, placed: PlacedShapes, tolerance: float, wanted: Wanted) -> ApproximateSkeleton:
    """Sample a graph until the error bounds of all arcs are at most a tolerance."""
    warn_without_inside(graph, placed, wanted.side)
    try:
        found = refined_skeleton(graph, placed, tolerance, SampleGroups(), wanted)
    except _core.sampled_skeleton.TooManySeedsError as error:
        raise LimitError(
            f"errors of at most {tolerance:g} need more than {wanted.most} seeds ({error}): use a larger tolerance, or "
            "allow more seeds"
        ) from None
    refuse_unproved(found.skeleton, tolerance)
    return told_together(found, wanted.side)


def refined_skeleton(
    graph: PlanarGraph, placed: PlacedShapes, tolerance: float, groups: SampleGroups, wanted: Wanted
) -> ApproximateSkeleton:
    """Sample until there is nothing more to be divided, or it does not help; TooManySeedsError is the core's."""
    if tolerance < LEAST_STEPS * graph.scale:
        raise LimitError(
            f"a tolerance of {tolerance:g} is finer than the lattice that coordinates are rounded to: use at least "
            f"{LEAST_STEPS * graph.scale!r}"
        )
    core, most = core_graph(graph), wanted.most
    steps = _core.sampled_skeleton.corner_steps(core, COARSEST * _extent(graph, groups), False, most)
    for _ in range(MOST_ROUNDS):
        made = _core.sampled_skeleton.sample_from_corners(core, steps, most, wanted.threads, wanted.progress)
        shapes = diagram_of_samples(graph, placed, made, groups, wanted)
        found = skeleton_of_samples(shapes, wanted, tolerance)
        parts = _parts(shapes, found, tolerance)
        if (parts == 1).all():
            break
        refined = _core.sampled_skeleton.refined_steps(core, steps, made[2], parts, most)
        if len(refined[1]) == len(steps[1]):  # what is to be divided is as short as gaps may be
            break
        steps = refined
    return found


def refuse_unproved(skeleton: Skeleton, tolerance: float) -> None:
    """Raise LimitError for arcs without a bound, or with one above a tolerance."""
    wrong = ~(skeleton.error_bound <= tolerance)
    if not wrong.any():
        return
    unproved = np.isnan(skeleton.error_bound)
    first = (unproved if unproved.any() else wrong).argmax()
    x, y = skeleton.vertices[skeleton.arcs[first, 0]].tolist()
    if unproved.any():
        raise LimitError(
            f"errors of {np.count_nonzero(unproved)} arcs could not be bounded, the first near ({x:g}, {y:g}), where "
            "edges are too close together for the lattice that coordinates are rounded to: use a step instead of the "
            "tolerance, or the exact skeleton"
        )
    raise LimitError(
        f"errors of at most {tolerance:g} could not be proved for {np.count_nonzero(wrong)} arcs, the first near "
        f"({x:g}, {y:g}): use a larger tolerance"
    )


def _extent(graph: PlanarGraph, groups: SampleGroups) -> float:
    """The larger side of the bounds, of all if what is sampled is a part."""
    if groups.within is not None:
        least_x, most_x, least_y, most_y = groups.within
        return max(most_x - least_x, most_y - least_y)
    return float(np.ptp(graph.points, axis=0).max()) if len(graph.points) else 1.0


def _parts(shapes: SampledShapes, found: ApproximateSkeleton, tolerance: float) -> NDArray[np.int32]:
    """Into how many parts each piece of an edge should be divided."""
    parts = found.parts.copy()
    walked = shapes.diagram.walked_pieces
    lengths, _ = shapes.samples.gaps()
    reached = walked[lengths[walked] > tolerance]
    parts[reached] = np.maximum(parts[reached], 2)
    return parts
