"""A check of approximate skeletons that knows their samples and arrays only, not how they were made."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common.faults import fail, first_wrong
from vorotool.engines.sampled_skeleton.approximate import ApproximateSkeleton
from vorotool.engines.sampled_skeleton.hausdorff import distances_to, exact_skeleton, places_on_arcs, widened
from vorotool.engines.skeleton.verify_skeleton import check_arrays, check_branches
from vorotool.errors import VorotoolWarning
from vorotool.geometry.checks import checked_threads
from vorotool.geometry.curves.inverse_functions import hypotenuse
from vorotool.geometry.polygons.conversion import to_shapely
from vorotool.geometry.progress import Progress
from vorotool.geometry.ragged import owners
from vorotool.geometry.skeleton.boundary_samples import BoundarySamples
from vorotool.geometry.skeleton.skeleton import EXTERIOR, INTERIOR, Skeleton

Floats = NDArray[np.float64]

SEED_ERROR = 2.0**-20
"""Of a lattice step: how far seeds may be from their edges, and gaps from what they should be."""
PLACE_ERROR = 2.0**-18
"""Of a lattice step: how far distances of nodes may be wrong. They are rounded to input units, which may be coarser."""
PER_ARC = 5
"""Places on each arc whose distances from the exact skeleton are measured."""


def verify_approximate(
    found: ApproximateSkeleton, *, step: float | None = None, threads: int = 0, progress: Progress = None
) -> None:
    """Check an approximate skeleton from its samples and arrays.

    Seeds are on their edges, in their order, and the gaps are what a step says. The ends of arcs are as far from both
    of their seeds, and no seed is nearer; these have no label in common. No arc meets the shapes but in the corners
    that it leads to, and each lies in its polygon, or outside all. Radii lie between the distances from the shapes and
    from the seeds. Places on arcs are no farther from the exact skeleton, computed anew, than the bounds say. Branches
    are chains that end where they should.

    Parameters
    ----------
    found : ApproximateSkeleton
        However it was made.
    step : float, optional
        What the samples were made with.
    threads, progress
        As of `verify_skeleton`, as is what it raises.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.1.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from vorotool.engines.sampled_skeleton.approximate import approximate_skeleton, sampled_shapes
    >>> found = approximate_skeleton(sampled_shapes([[0, 0], [8, 0], [8, 3], [4, 1], [0, 3]], step=0.5))
    >>> verify_approximate(found, step=0.5)
    >>> wrong = replace(found.skeleton, error_bound=found.skeleton.error_bound / 2)
    >>> verify_approximate(replace(found, skeleton=wrong))  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: arc ... from the exact skeleton, beyond its bound of ...
    """
    threads = checked_threads(threads)
    samples = found.shapes.samples
    check_samples(samples, step)
    if not len(found.skeleton):
        return
    check_arrays(found.skeleton)
    check_branches(found.skeleton)
    _check_seeds(found)
    _check_labels(found)
    _check_crossings(found)
    _check_sides(found.skeleton)
    _check_radii(found, threads, progress)
    _check_bounds(found, threads)


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
    length = np.sqrt((way * way).sum(axis=1))
    across = (way[:, 0] * from_a[:, 1] - way[:, 1] * from_a[:, 0]) / length
    along = (way * from_a).sum(axis=1) / length
    at = first_wrong((np.abs(across) > SEED_ERROR + 2.0**-50 * length) | (along <= 0) | (along >= length))
    if at is not None:
        fail(f"seed {points + at} is not on its edge")
    same = np.flatnonzero(np.diff(samples.segment[points:]) == 0)
    at = first_wrong(along[same + 1] <= along[same])
    if at is not None:
        fail(f"seed {points + same[at]} is beyond the next one of its edge")
    if step is not None:
        _check_gaps(samples, step)


def _check_gaps(samples: BoundarySamples, step: float) -> None:
    if not len(samples.graph):
        return
    gaps, segment = samples.gaps()
    alone = (np.diff(samples.start) == 0)[segment]
    error = (SEED_ERROR + 2.0**-50 * np.ptp(samples.graph.points)) * samples.graph.scale
    at = first_wrong((gaps >= 1.5 * step + error) | (~alone & (gaps < 0.5 * step - error)))
    if at is not None:
        fail(f"a gap on edge {segment[at]} is {gaps[at]}, but the step is {step}")


def _place_error(skeleton: Skeleton, samples: BoundarySamples) -> float:
    largest = max(np.abs(skeleton.vertices).max(initial=0.0), np.abs(samples.polygons.xy).max(initial=0.0))
    return PLACE_ERROR * samples.graph.scale + 4 * float(np.spacing(largest))


def _check_seeds(found: ApproximateSkeleton) -> None:
    """Ends of arcs are equally far from both seeds, and none is nearer."""
    import shapely

    skeleton, samples = found.skeleton, found.shapes.samples
    xy, error = samples.xy, _place_error(skeleton, samples)
    sampled = np.flatnonzero((found.seeds >= 0).all(axis=1))
    tree = shapely.STRtree(shapely.points(xy))
    for end in (0, 1):
        place = skeleton.vertices[skeleton.arcs[sampled, end]]
        left, right = (hypotenuse(*(place - xy[found.seeds[sampled, hand]]).T) for hand in (0, 1))
        at = first_wrong(~(np.abs(left - right) <= error))
        if at is not None:
            one, other = found.seeds[sampled[at]].tolist()
            fail(f"arc {sampled[at]} is {left[at]} from seed {one} and {right[at]} from seed {other}")
        nearest = _nearest_of_group(found, tree, place, found.seeds[sampled, 0], left - error)
        at = first_wrong(nearest < left - error)
        if at is not None:
            fail(f"a seed is {nearest[at]} from arc {sampled[at]}, nearer than its own, {left[at]}")


def _nearest_of_group(
    found: ApproximateSkeleton, tree: Any, places: Floats, seeds: NDArray[np.int32], reach: Floats
) -> Floats:
    """How far the nearest seed is that has a diagram with a given one; only what is within a reach is looked for."""
    import shapely

    points, group = shapely.points(places), found.shapes.groups.of_samples(found.shapes.samples)
    if group is None:
        distance: Floats = tree.query_nearest(points, return_distance=True, all_matches=False)[1]
        return distance
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
    at = first_wrong(share)
    if at is not None:
        fail(f"arc {sampled[at]} is between seeds {found.seeds[sampled[at]].tolist()} of one edge")


def _check_crossings(found: ApproximateSkeleton) -> None:
    """No arc meets the shapes; lines from corners are looked at from their middle on."""
    import shapely

    skeleton, graph = found.skeleton, found.shapes.graph
    ends = skeleton.vertices[skeleton.arcs]
    leads = (found.seeds < 0).any(axis=1)
    for end in (0, 1):
        at_corner = leads & (skeleton.radius[skeleton.arcs[:, end]] == 0)
        ends[at_corner, end] = ends[at_corner].mean(axis=1)
    edges = shapely.linestrings(graph.coordinates()[graph.segments])
    arc, edge = shapely.STRtree(edges).query(shapely.linestrings(ends), predicate="intersects")
    if len(arc):
        fail(f"arc {arc[0]} meets edge {edge[0]} of the shapes")


def _check_sides(skeleton: Skeleton) -> None:
    """Each arc in its polygon, or in none."""
    import shapely

    polygons = skeleton.polygons
    area = np.flatnonzero(~polygons.is_line)
    shapes = np.array(to_shapely(polygons), dtype=object)[area]
    middle = shapely.points(skeleton.vertices[skeleton.arcs].mean(axis=1))
    arc, shape = shapely.STRtree(shapes).query(middle, predicate="intersects")
    inside = np.zeros(len(skeleton), dtype=bool)
    inside[arc] = True
    at = first_wrong(inside != (skeleton.side == INTERIOR))
    if at is not None:
        fail(f"arc {at} is {'inside' if inside[at] else 'outside'}, but said to be on the other side")
    own = np.zeros(len(skeleton), dtype=bool)
    own[arc[area[shape] == skeleton.polygon[arc]]] = True
    at = first_wrong(~own & (skeleton.side != EXTERIOR))
    if at is not None:
        fail(f"arc {at} is not in polygon {skeleton.polygon[at]}")


def _check_radii(found: ApproximateSkeleton, threads: int, progress: Progress) -> None:
    skeleton, graph = found.skeleton, found.shapes.graph
    error = _place_error(skeleton, found.shapes.samples)
    lattice = np.ascontiguousarray((skeleton.vertices - graph.origin) / graph.scale)
    reach = np.ascontiguousarray((skeleton.radius + error) / graph.scale)
    least = graph.scale * _core.spatial.clearances(graph.points, graph.segments, lattice, reach, threads, progress)
    at = first_wrong(~(skeleton.radius >= least - error))
    if at is not None:
        fail(f"node {at} is {least[at]} from the shapes, but its radius is {skeleton.radius[at]}")
    node = skeleton.arcs[:, 0]
    sampled = found.seeds[:, 0] >= 0
    far = hypotenuse(*(skeleton.vertices[node] - found.shapes.samples.xy[found.seeds[:, 0]]).T)
    at = first_wrong(sampled & ~(skeleton.radius[node] <= far + error))
    if at is not None:
        fail(f"node {node[at]} is {far[at]} from its seeds, but its radius is {skeleton.radius[node[at]]}")


def _check_bounds(found: ApproximateSkeleton, threads: int) -> None:
    skeleton = found.skeleton
    sides = np.unique(skeleton.side).tolist()
    side = "both" if len(sides) > 1 else ("interior" if sides == [INTERIOR] else "exterior")
    frame = None if skeleton.frame is None else widened(skeleton.frame)
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        exact = exact_skeleton(found, side=side, frame=frame, threads=threads)
    proved = np.flatnonzero(~np.isnan(skeleton.error_bound))
    if not len(exact):
        if len(proved):
            fail(f"arc {proved[0]} has an error bound, but the exact skeleton has no arcs on this side")
        return
    places = places_on_arcs(skeleton, np.linspace(0, 1, PER_ARC))
    distance = distances_to(exact, places.reshape(-1, 2)).reshape(len(skeleton), -1).max(axis=1)
    error = 4 * float(np.spacing(np.abs(exact.vertices).max(initial=0.0)))
    at = first_wrong(distance > skeleton.error_bound + error)
    if at is not None:
        fail(f"arc {at} is {distance[at]} from the exact skeleton, beyond its bound of {skeleton.error_bound[at]}")
