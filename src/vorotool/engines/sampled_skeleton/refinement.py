"""Approximate skeletons as fine as a tolerance needs: sampling where the error bounds ask for it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.lattice_rings import PlacedShapes
from vorotool.engines.sampled_skeleton.approximate import (
    MOST_SEEDS,
    ApproximateSkeleton,
    SampledShapes,
    SampleGroups,
    core_graph,
    diagram_of_samples,
    skeleton_of_samples,
    told_together,
)
from vorotool.engines.skeleton.exact import warn_empty
from vorotool.errors import LimitError
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.progress import Progress
from vorotool.types.box import Extent
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import Skeleton

COARSEST = 2.0**-4
"""Of the extent: the longest gaps that sampling begins with."""
LEAST_STEPS = 2.0**-8
"""Of the lattice: the least tolerance. Seeds and nodes are rounded to about 2^-21 of a step."""
MOST_ROUNDS = 60
"""Gaps are at least halved where they are too long: no more than this from the extent to the least of doubles."""


def skeleton_within(
    graph: PlanarGraph,
    placed: PlacedShapes,
    tolerance: float,
    *,
    side: str = "interior",
    frame: Extent | None = None,
    complete: bool = True,
    most: int = MOST_SEEDS,
    threads: int = 0,
    progress: Progress = None,
) -> ApproximateSkeleton:
    """Sample a graph until the error bounds of all arcs are at most a tolerance."""
    if side != "exterior" and not graph.is_inside.any():
        warn_empty(placed.polygons, side)
    try:
        found = refined_skeleton(
            graph,
            placed,
            tolerance,
            SampleGroups(),
            side=side,
            frame=frame,
            complete=complete,
            most=most,
            threads=checked_threads(threads),
            progress=progress,
        )
    except _core.sampled_skeleton.TooManySeedsError as error:
        raise LimitError(
            f"errors of at most {tolerance:g} need more than {most} seeds ({error}): use a larger tolerance, or allow "
            "more seeds"
        ) from None
    refuse_unproved(found.skeleton, tolerance)
    return told_together(found, side)


def refined_skeleton(
    graph: PlanarGraph,
    placed: PlacedShapes,
    tolerance: float,
    groups: SampleGroups,
    *,
    side: str,
    frame: Extent | None,
    complete: bool,
    most: int,
    threads: int,
    progress: Progress,
) -> ApproximateSkeleton:
    """Sample until there is nothing more to be divided, or it does not help; TooManySeedsError is the core's."""
    if tolerance < LEAST_STEPS * graph.scale:
        raise LimitError(
            f"a tolerance of {tolerance:g} is finer than the lattice that coordinates are rounded to: use at least "
            f"{LEAST_STEPS * graph.scale!r}"
        )
    core = core_graph(graph)
    common: dict[str, Any] = {"threads": threads, "progress": progress}
    steps = _core.sampled_skeleton.corner_steps(core, COARSEST * _extent(graph, groups), False, most)
    for _ in range(MOST_ROUNDS):
        made = _core.sampled_skeleton.sample_from_corners(core, steps, most, threads, progress)
        shapes = diagram_of_samples(graph, placed, made, groups, **common)
        found = skeleton_of_samples(shapes, side=side, frame=frame, complete=complete, tolerance=tolerance, **common)
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
