"""The errors of an approximate skeleton, measured and summarized beside the paper's estimate (section 3.1)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.sampled_skeleton.approximate import ApproximateSkeleton, Wanted, approximate_skeleton
from vorotool.engines.sampled_skeleton.per_feature import FeatureApproximation
from vorotool.engines.skeleton.exact import diagram_of_placed, skeleton_of
from vorotool.engines.skeleton.verify_bounds import distances_to, places_on_arcs
from vorotool.errors import silent
from vorotool.frozen import frozen
from vorotool.numeric.arrays import crosses, starts_of
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.types.box import Extent, widened
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import Skeleton


def error_summary(found: ApproximateSkeleton | FeatureApproximation, *, step: float | None = None) -> dict[str, Any]:
    """Sum up the certified bounds of errors."""
    bound = found.skeleton.error_bound
    known = np.flatnonzero(~np.isnan(bound))
    summary: dict[str, Any] = {"largest": None, "mean": None, "arc": None, "x": None, "y": None}
    if len(known):
        arc = int(known[bound[known].argmax()])
        x, y = found.skeleton.vertices[found.skeleton.arcs[arc]].mean(axis=0).tolist()
        summary = {"largest": float(bound[arc]), "mean": float(bound[known].mean()), "arc": arc, "x": x, "y": y}
    summary["unproved"] = len(bound) - len(known)
    return summary if step is None else summary | _beside_the_paper(found, step)


def _beside_the_paper(found: ApproximateSkeleton | FeatureApproximation, step: float) -> dict[str, Any]:
    skeleton = found.skeleton
    is_edge = (skeleton.site_table.kind == EDGE)[skeleton.sites]
    sampled = (found.seeds >= 0).all(axis=1)
    bent = np.flatnonzero(sampled & (is_edge[:, 0] != is_edge[:, 1]))
    straight = np.flatnonzero(sampled & is_edge.all(axis=1))
    heights = _focal_heights(found, bent, is_edge[bent])
    with np.errstate(divide="ignore"):
        estimates = step * step / (8 * heights)
    return {
        "parabolas": {
            "arcs": len(bent),
            "largest_estimate": _largest(estimates),
            "largest_bound": _largest(skeleton.error_bound[bent]),
        },
        "lines": {
            "arcs": len(straight),
            "largest_bound": _largest(skeleton.error_bound[straight]),
            "largest_over_step": _largest(skeleton.error_bound[straight] / step),
        },
    }


def _focal_heights(
    found: ApproximateSkeleton | FeatureApproximation, arcs: NDArray[np.intp], is_edge: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """How far the vertex of each arc is from the line of its edge."""
    sites = found.skeleton.sites[arcs]
    ends = found.skeleton.site_ends
    edge = ends[np.where(is_edge[:, 0], sites[:, 0], sites[:, 1])]
    vertex = ends[np.where(is_edge[:, 0], sites[:, 1], sites[:, 0]), 0]
    along, way = edge[:, 1] - edge[:, 0], vertex - edge[:, 0]
    return np.abs(crosses(along, way)) / hypotenuse(*along.T)


def _largest(values: NDArray[np.float64]) -> float | None:
    finite = values[np.isfinite(values)]
    return float(finite.max()) if len(finite) else None


TO_EXACT, TO_APPROXIMATE = "from_approximate_to_exact", "from_exact_to_approximate"
"""The two ways of a comparison."""


PER_ARC = 16
"""Places on an arc beside its ends, evenly in its parameter."""


@frozen
class Deviation:
    """The largest distance of places on one skeleton from another one, and where it is."""

    largest: float  # in input units
    mean: float  # in input units
    x: float  # a place on the first skeleton
    y: float  # a place on the first skeleton
    arc: int  # of the first skeleton


def deviation(skeleton: Skeleton, other: Skeleton) -> Deviation | None:
    """Measure how far the ends of arcs, and 16 points on each, are from another skeleton of the same polygons."""
    if not len(skeleton) or not len(other):
        return None
    places = places_on_arcs(skeleton, np.linspace(0, 1, PER_ARC + 2))
    distance = distances_to(other, places.reshape(-1, 2))
    at = int(distance.argmax())
    x, y = places.reshape(-1, 2)[at].tolist()
    return Deviation(float(distance[at]), float(distance.mean()), x, y, at // places.shape[1])


def compare_parts(found: FeatureApproximation, *, side: str = "interior", threads: int = 0) -> dict[str, Any]:
    """Measure how far an approximate skeleton of features is from the exact one, part by part."""
    sides = [side] * len(found.parts)
    if side == "both" and found.inside is not None:
        sides = [*["interior"] * (len(found.parts) - 1), "exterior"]
    ways = [_both_ways(part, side=own, threads=threads) for part, own in zip(found.parts, sides, strict=True)]
    exact = starts_of([way[TO_APPROXIMATE][1] for way in ways])
    numbers = {
        TO_EXACT: found.arcs,
        TO_APPROXIMATE: [first + np.arange(way[TO_APPROXIMATE][1]) for first, way in zip(exact, ways, strict=False)],
    }
    farthest = {name: _farthest([way[name] for way in ways], own) for name, own in numbers.items()}
    return {name: None if each is None else asdict(each) for name, each in farthest.items()}


def _farthest(ways: Sequence[tuple[Deviation | None, int]], numbers: Sequence[NDArray[np.int64]]) -> Deviation | None:
    """The largest deviation of some parts, with the number of its arc among all; and the mean of all."""
    known = [(way, count, own) for (way, count), own in zip(ways, numbers, strict=True) if way is not None]
    if not known:
        return None
    way, _, own = max(known, key=lambda row: row[0].largest)
    mean = float(np.average([row[0].mean for row in known], weights=[row[1] for row in known]))
    return replace(way, arc=int(own[way.arc]), mean=way.mean if len(known) == 1 else mean)


def _both_ways(found: ApproximateSkeleton, *, side: str, threads: int) -> dict[str, tuple[Deviation | None, int]]:
    """Deviations, and how many arcs each is of."""
    approximate, wide = found.skeleton, found.skeleton
    frame = approximate.frame
    exact = exact_skeleton(found, side=side, frame=frame, threads=threads)
    wide_exact = exact
    if frame is not None:
        larger = widened(frame)
        complete = bool((found.seeds < 0).any())
        wanted = Wanted(side, larger, complete, threads=threads)
        wide = approximate_skeleton(found.shapes, wanted).skeleton
        wide_exact = exact_skeleton(found, side=side, frame=larger, threads=threads)
    return {
        TO_EXACT: (deviation(approximate, wide_exact), len(approximate)),
        TO_APPROXIMATE: (deviation(exact, wide), len(exact)),
    }


def exact_skeleton(
    found: ApproximateSkeleton, *, side: str = "interior", frame: Extent | None = None, threads: int = 0
) -> Skeleton:
    """Compute the exact skeleton of the shapes that were sampled."""
    diagram = diagram_of_placed(found.shapes.graph, found.shapes.placed, threads=threads)
    with silent():  # that there is no interior was told before
        return skeleton_of(diagram, side=side, frame=frame, threads=threads)
