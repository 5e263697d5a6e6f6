"""Checks offset curves from their arrays: their pieces by distances, their shapes by what they must hold."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.common import fail, first_wrong, off_segments
from vorotool.engines.features.batches import BatchShapes, in_batches
from vorotool.engines.offsets.offsets import listed_distances
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi, verify_segment_voronoi
from vorotool.engines.skeleton.clearance import ULPS, clearances, largest_coordinate
from vorotool.errors import VorotoolWarning
from vorotool.numeric.arrays import Floats, following, norms, ranges, ranks_of, starts_of
from vorotool.numeric.curves.flatten import middles_of
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import distinct, finite_double
from vorotool.numeric.parallel import Progress, Run, running
from vorotool.types.arguments import check_value
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import SHELL
from vorotool.types.polygons.shapely_geometry import to_shapely
from vorotool.types.skeleton.offsets import Offsets
from vorotool.types.skeleton.segment_voronoi import EDGE, ends_of_sites

FLATTEN = 1e-4
"""Of the distance: how far chords are from arcs where places are told to be in a shape or not; nearer ones are not
asked."""


def verify_offsets(
    offsets: Offsets, *, distances: Sequence[float] = (), threads: int = 0, progress: Progress = None
) -> None:
    """Check offset curves from their arrays alone.

    Each piece begins where the one before it ends; it is at its distance from its own site, and nothing is nearer, at
    its ends and at three places between; shells turn left and holes right. Each region on either side of the curves has
    a site or a vertex of the Voronoi diagram in it, which is made again and checked for it: these must lie in one shape
    if their distance from the polygons says so, or that they are inside, and otherwise in none.

    Parameters
    ----------
    offsets : Offsets
        What to check.
    distances : sequence of float
        The distances requested; some may have no shape.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Raises
    ------
    VerificationError
        If a check fails; the message says what and where.

    Examples
    --------
    >>> from vorotool import offset
    >>> verify_offsets(offset([[0, 0], [4, 0], [4, 2], [0, 2]], [-0.5, 1]))
    """
    check_value(offsets, "offsets", "Offsets")
    run, more = running(threads, progress), listed_distances(distances)
    tolerance = _tolerance(offsets)
    _check_chains(offsets)
    _check_sites(offsets, tolerance)
    _check_orientation(offsets, tolerance)
    wanted = {*(finite_double(one, "a distance") for one in more), *offsets.distance.tolist()}
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):  # features may lie over each other
        if offsets.features == "together":
            graph = planar_graph(offsets.polygons, **run)
            _check_in_graph(offsets, wanted, tolerance, graph, run)
        else:
            _check_features(offsets, wanted, tolerance, run)


def _check_features(offsets: Offsets, wanted: set[float], tolerance: float, run: Run) -> None:
    """Check what is outside of all features, and what is inside of each by itself."""
    outwards, inwards = {d for d in wanted if d > 0}, {d for d in wanted if d < 0}
    if outwards:
        graph = planar_graph(offsets.polygons, **run)
        outside = with_shapes(offsets, np.flatnonzero(offsets.distance > 0))
        _check_in_graph(outside, outwards, tolerance, graph, run)

    def check(shapes: BatchShapes, run: Run) -> None:
        number = ranks_of(shapes.batch.polygons, len(offsets.polygons), np.int32)
        is_own = (offsets.distance < 0) & (offsets.polygon >= 0) & (number[offsets.polygon] >= 0)
        own = with_shapes(offsets, np.flatnonzero(is_own))
        sites = distinct(own.site).astype(np.intp)
        table = offsets.site_table.taken(sites)
        own = replace(
            own,
            site=np.searchsorted(sites, own.site).astype(np.int32),
            polygon=number[own.polygon],
            site_table=replace(table, polygon=number[table.polygon]),
            polygons=shapes.batch.part,
        )
        if (own.site_table.polygon < 0).any():
            fail("a piece inside a feature is about a site of another one")
        _check_in_graph(own, inwards, tolerance, shapes.graph, run)

    if inwards:
        in_batches(offsets.polygons, check, **run)


def _check_in_graph(offsets: Offsets, distances: set[float], tolerance: float, graph: PlanarGraph, run: Run) -> None:
    _check_nothing_nearer(offsets, tolerance, graph, run)
    _check_regions(offsets, distances, tolerance, graph, run)


def with_shapes(offsets: Offsets, chosen: NDArray[np.intp]) -> Offsets:
    """Give some of the shapes."""
    counts, sizes = np.diff(offsets.shape_starts), np.diff(offsets.ring_starts)
    rings = ranges(offsets.shape_starts[chosen], counts[chosen])
    pieces = ranges(offsets.ring_starts[rings], sizes[rings])
    return replace(
        offsets,
        **{name: getattr(offsets, name)[pieces] for name in ("start", "end", "center", "site")},
        ring_starts=starts_of(sizes[rings]),
        shape_starts=starts_of(counts[chosen]),
        distance=offsets.distance[chosen],
        polygon=offsets.polygon[chosen],
    )


def _tolerance(offsets: Offsets) -> float:
    largest = largest_coordinate(offsets.origin, offsets.polygons.xy, offsets.start) or 1.0
    furthest = float(np.abs(offsets.distance).max(initial=0))
    return ULPS * float(np.spacing(max(largest, furthest)))


def _check_chains(offsets: Offsets) -> None:
    if (at := first_wrong((offsets.end != offsets.start[following(offsets.ring_starts)]).any(axis=1))) is not None:
        fail(f"piece {at} ends at {tuple(offsets.end[at].tolist())}, but the next one of its ring does not begin there")


def _check_sites(offsets: Offsets, tolerance: float) -> None:
    """Lines are along edges, arcs about vertices, each at its distance."""
    ends = ends_of_sites(offsets.polygons, offsets.site_table)[offsets.site]
    if (at := first_wrong((offsets.site_table.kind[offsets.site] == EDGE) == offsets.is_arc)) is not None:
        fail(f"piece {at} is neither a line along an edge nor an arc about a vertex")
    if (at := first_wrong(offsets.is_arc & (offsets.center != ends[:, 0]).any(axis=1))) is not None:
        fail(f"arc {at} is about {tuple(offsets.center[at].tolist())}, which is not its vertex")
    distance = np.abs(offsets.piece_distance)
    for place in (offsets.start, offsets.end):
        apart = np.abs(off_segments(place, *ends.swapaxes(0, 1)) - distance)
        if (at := first_wrong(~(apart <= tolerance))) is not None:
            fail(f"piece {at} has an end that is {apart[at]:g} too near to its site, or too far from it")


def _inner_places(offsets: Offsets) -> Floats:
    """(3, k, 2) on each piece, evenly between its ends."""
    middle = _middles(offsets, offsets.start, offsets.end)
    return np.stack([_middles(offsets, offsets.start, middle), middle, _middles(offsets, middle, offsets.end)])


def _middles(offsets: Offsets, start: Floats, end: Floats) -> Floats:
    """Of the part of each piece between two places on it."""
    arcs = np.flatnonzero(offsets.is_arc)
    middles = (start + end) / 2
    is_left = (offsets.piece_distance[arcs] > 0)[:, None]
    first, last = np.where(is_left, start[arcs], end[arcs]), np.where(is_left, end[arcs], start[arcs])
    middles[arcs] = middles_of(first, last, offsets.center[arcs], np.zeros(len(arcs), dtype=bool))
    return middles


def _check_nothing_nearer(offsets: Offsets, tolerance: float, graph: PlanarGraph, run: Run) -> None:
    places = np.concatenate([offsets.start, *_inner_places(offsets)])
    distance = np.tile(np.abs(offsets.piece_distance), 4)
    nearest = _clearances(places, distance, graph, run)
    if (at := first_wrong(nearest < distance - tolerance)) is not None:
        piece = at % len(offsets.site)
        fail(f"piece {piece} at distance {distance[at]}: a site is {nearest[at]} from {tuple(places[at].tolist())}")


def _clearances(places: Floats, reach: Floats, graph: PlanarGraph, run: Run) -> Floats:
    """Distances from the nearest site where it is not beyond the reach, else infinity."""
    if not len(graph):  # a lattice of single points may have no step
        apart = norms(places[:, None] - graph.coordinates()[None])
        return np.asarray(apart.min(axis=1, initial=np.inf))
    return clearances(places, reach, graph, run)


def _check_orientation(offsets: Offsets, tolerance: float) -> None:
    shape = offsets.shape_of_ring
    single = replace(
        offsets,
        shape_starts=np.arange(len(offsets.ring_starts)),
        distance=offsets.distance[shape],
        polygon=offsets.polygon[shape],
    )
    length = np.add.reduceat(offsets.length, offsets.ring_starts[:-1]) if len(single) else np.zeros(0)
    area = np.where(offsets.ring_kind == SHELL, single.area, -single.area)
    if (at := first_wrong(area < -tolerance * length)) is not None:
        fail(f"ring {at} has the wrong orientation: it has the area {single.area[at]}")


def _check_regions(offsets: Offsets, distances: set[float], tolerance: float, graph: PlanarGraph, run: Run) -> None:
    diagram = segment_voronoi(graph.points, graph.segments, **run)
    verify_segment_voronoi(diagram, **run)
    sites = graph.coordinates()
    witnesses = np.concatenate([sites, sites[graph.segments].mean(axis=1), graph.coordinates(diagram.vertices)])
    points = shapely.points(witnesses)
    closed = to_shapely(offsets.polygons)
    is_inside = _holding(closed[~offsets.polygons.is_line], points) > 0
    for distance in sorted(distances):
        tested = abs(distance) * FLATTEN + tolerance
        shapes = to_shapely(offsets.flattened(abs(distance) * FLATTEN))[offsets.distance == distance]
        reach = np.full(len(witnesses), abs(distance) + 2 * tested)
        clearance = _clearances(witnesses, reach, graph, run)
        is_near = clearance <= abs(distance)
        wanted = is_inside | is_near if distance > 0 else is_inside & ~is_near
        clear = np.abs(clearance - abs(distance)) > 2 * tested
        held = _holding(shapes, points)
        if (at := first_wrong(clear & (held != wanted))) is not None:
            how = f"is in {held[at]} shapes, not in {'one' if wanted[at] else 'none'},"
            fail(f"{tuple(witnesses[at].tolist())}, {clearance[at]} from the polygons, {how} at distance {distance}")


def _holding(shapes: Any, points: Any) -> NDArray[np.int64]:
    """In how many of some polygons each point lies."""
    if not len(shapes):
        return np.zeros(len(points), dtype=np.int64)
    found = shapely.STRtree(shapes).query(points, predicate="intersects")[0]
    return np.bincount(found, minlength=len(points))
