"""A check of approximate skeletons that knows their samples and arrays only, not how they were made."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import fail, first_wrong
from vorotool.engines.sampled_skeleton.approximate import ApproximateSkeleton, BoundarySamples
from vorotool.engines.skeleton.verify_bounds import place_error
from vorotool.engines.skeleton.verify_skeleton import check_arrays
from vorotool.numeric.arrays import Floats, crosses, dots, norms, owners
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.lazy import shapely

SEED_ERROR = 2.0**-20
"""Of a lattice step: how far seeds may be from their edges, and gaps from what they should be."""


def verify_samples(found: ApproximateSkeleton, *, step: float | None = None) -> None:
    """Check the samples and the seeds beside arcs of an approximate skeleton, but nothing that needs no seeds."""
    check_samples(found.shapes.samples, step)
    if len(found.skeleton):
        check_arrays(found.skeleton)
        _check_seeds(found)
        _check_labels(found)
        _check_radii(found)


def check_samples(samples: BoundarySamples, step: float | None = None) -> None:
    """Raise unless seeds follow each other on their segments, with the gaps of a step if one is given."""
    graph, seeds = samples.graph, samples.seeds
    points = len(graph.points)
    if not np.array_equal(seeds[:points], graph.points) or samples.start[0] != points:
        fail("the first seeds are not the vertices")
    if not np.array_equal(owners(np.diff(samples.start)), samples.segment[points:]):
        fail("seeds are not in the order of their edges")
    a, b = graph.points[graph.segments[samples.segment[points:]]].astype(np.float64).swapaxes(0, 1)
    way, from_a = b - a, seeds[points:] - a
    length = norms(way)
    across = (crosses(way, from_a)) / length
    along = dots(way, from_a) / length
    at = first_wrong((np.abs(across) > SEED_ERROR + 2.0**-50 * length) | (along <= 0) | (along >= length))
    if at is not None:
        fail(f"seed {points + at} is not on its edge")
    same = np.flatnonzero(np.diff(samples.segment[points:]) == 0)
    if (at := first_wrong(along[same + 1] <= along[same])) is not None:
        fail(f"seed {points + same[at]} is beyond the next one of its edge")
    if step is not None:
        _check_gaps(samples, step)


def _check_gaps(samples: BoundarySamples, step: float) -> None:
    if not len(samples.graph):
        return
    gaps, segment = samples.gaps()
    alone = (np.diff(samples.start) == 0)[segment]
    error = (SEED_ERROR + 2.0**-50 * np.ptp(samples.graph.points)) * samples.graph.scale
    if (at := first_wrong((gaps >= 1.5 * step + error) | (~alone & (gaps < 0.5 * step - error)))) is not None:
        fail(f"a gap on edge {segment[at]} is {gaps[at]}, but the step is {step}")


def _check_seeds(found: ApproximateSkeleton) -> None:
    """Ends of arcs are equally far from both seeds, and none is nearer."""
    skeleton, samples = found.skeleton, found.shapes.samples
    xy, error = samples.xy, place_error(skeleton)
    sampled = np.flatnonzero((found.seeds >= 0).all(axis=1))
    tree = shapely.STRtree(shapely.points(xy))
    for end in (0, 1):
        place = skeleton.vertices[skeleton.arcs[sampled, end]]
        left, right = (hypotenuse(*(place - xy[found.seeds[sampled, hand]]).T) for hand in (0, 1))
        if (at := first_wrong(~(np.abs(left - right) <= error))) is not None:
            one, other = found.seeds[sampled[at]].tolist()
            fail(f"arc {sampled[at]} is {left[at]} from seed {one} and {right[at]} from seed {other}")
        nearest = _nearest_of_group(found, tree, place, found.seeds[sampled, 0], left - error)
        if (at := first_wrong(nearest < left - error)) is not None:
            fail(f"a seed is {nearest[at]} from arc {sampled[at]}, nearer than its own, {left[at]}")


def _nearest_of_group(
    found: ApproximateSkeleton, tree: Any, places: Floats, seeds: NDArray[np.int32], reach: Floats
) -> Floats:
    """How far the nearest seed is that has a diagram with a given one; only what is within a reach is looked for."""
    points, group = shapely.points(places), found.shapes.groups.of_samples(found.shapes.samples)
    if group is None:
        return tree.query_nearest(points, return_distance=True, all_matches=False)[1]
    place, seed = tree.query(points, predicate="dwithin", distance=np.maximum(reach, 0))
    own = group[seed] == group[seeds[place]]
    place, seed = place[own], seed[own]
    nearest = np.full(len(places), np.inf)
    np.minimum.at(nearest, place, hypotenuse(*(places[place] - found.shapes.samples.xy[seed]).T))
    return nearest


def _check_labels(found: ApproximateSkeleton) -> None:
    samples = found.shapes.samples
    graph, segment = samples.graph, samples.segment
    sampled = np.flatnonzero((found.seeds >= 0).all(axis=1))
    p, q = found.seeds[sampled].T
    p, q = np.where(segment[p] < 0, p, q), np.where(segment[p] < 0, q, p)  # a vertex first, if there is one
    own, other = segment[p], segment[q]
    share = (own >= 0) & (own == other)
    mixed = np.flatnonzero((own < 0) & (other >= 0))
    share[mixed] = (graph.segments[other[mixed]] == p[mixed, None]).any(axis=1)
    both = np.flatnonzero((own < 0) & (other < 0))
    keys = [
        low.astype(np.int64) * len(graph.points) + high
        for low, high in (np.sort(pairs, axis=1).T for pairs in (graph.segments, np.stack([p[both], q[both]], axis=1)))
    ]
    share[both] = np.isin(keys[1], keys[0])
    if (at := first_wrong(share)) is not None:
        fail(f"arc {sampled[at]} is between seeds {found.seeds[sampled[at]].tolist()} of one edge")


def _check_radii(found: ApproximateSkeleton) -> None:
    """Seeds are no nearer than the shapes."""
    skeleton, node = found.skeleton, found.skeleton.arcs[:, 0]
    error = place_error(skeleton)
    sampled = found.seeds[:, 0] >= 0
    far = hypotenuse(*(skeleton.vertices[node] - found.shapes.samples.xy[found.seeds[:, 0]]).T)
    if (at := first_wrong(sampled & ~(skeleton.radius[node] <= far + error))) is not None:
        fail(f"node {node[at]} is {far[at]} from its seeds, but its radius is {skeleton.radius[node[at]]}")
