"""Checks of necks and of the parts between them, from the polygons and their own arrays alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.common import fail, first_wrong, off_segments
from vorotool.engines.features.batches import BatchShapes, in_batches
from vorotool.engines.skeleton.clearance import SitePlaces
from vorotool.errors import silent
from vorotool.numeric.arrays import Floats, norms, owners, ranks_of
from vorotool.numeric.parallel import Progress, Run, report, running
from vorotool.types.arguments import check_value
from vorotool.types.polygons.planar_graph import PlanarGraph, moved_feet, places_as_given
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.necks import Necks, Parts
from vorotool.types.skeleton.skeleton import Skeleton

_AREA_ERROR = 1e-9
"""Of areas, beside what a foot that is off its edge by some ulp takes from one piece and gives to another."""


def verify_necks(necks: Necks, *, threads: int = 0, progress: Progress = None) -> None:
    """Check necks: both feet lie on their sites, the width is their distance, and the middle is right.

    Nothing of the boundary is nearer to the middle, so that the cut is inside; on both sides there are larger discs.

    Parameters
    ----------
    necks : Necks
        However they were found.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from vorotool import necks
    >>> found = necks([[0, 0], [10, 0], [10, 4], [6, 2], [0, 4]])
    >>> verify_necks(found)
    >>> verify_necks(replace(found, width=found.width + 1))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: neck 0: its feet are 2.0 from each other, but its width is 3.0
    """
    check_value(necks, "necks", "Necks")
    run, necks = running(threads, progress), _placed(necks)
    places = SitePlaces(necks.skeleton)
    for foot in (0, 1):
        off = places.distances(necks.sites[:, foot], necks.feet[:, foot])
        if (at := first_wrong(~(off <= places.tolerance))) is not None:
            fail(f"neck {at}: its foot {necks.feet[at, foot].tolist()} is {off[at]} from site {necks.sites[at, foot]}")
    a, b = necks.feet.swapaxes(0, 1)
    apart = norms(b - a)
    if (at := first_wrong(~(np.abs(apart - necks.width) <= places.tolerance))) is not None:
        fail(f"neck {at}: its feet are {apart[at]} from each other, but its width is {necks.width[at]}")
    if (at := first_wrong(~(norms((a + b) / 2 - necks.xy) <= places.tolerance))) is not None:
        fail(f"neck {at} at {necks.xy[at].tolist()} is not in the middle of its cut")
    least, most = necks.beside.T
    if (at := first_wrong(~(necks.width / 2 <= least + places.tolerance) | ~(least <= most))) is not None:
        fail(f"neck {at}: beside its width of {necks.width[at]} the clearances are {necks.beside[at].tolist()}")
    _check_clearances(necks.skeleton, necks.polygon, necks.xy, necks.width / 2, "neck", run)


def verify_parts(parts: Parts, *, threads: int = 0, progress: Progress = None) -> None:
    """Check parts: their areas sum to those of the polygons, and they border each other along the cuts alone.

    Each cut goes once along each of the two pieces that it is said to be between, in opposite directions, and all other
    edges are on the boundary of the polygons; the largest disc of each piece touches this, and has its center inside.
    The cuts are checked as `verify_necks` does.

    Parameters
    ----------
    parts : Parts
        However they were made.
    threads, progress : optional
        As for `verify_necks`.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from vorotool import parts
    >>> pieces = parts([[0, 0], [10, 0], [10, 4], [6, 2], [0, 4]], neck=1)
    >>> verify_parts(pieces)
    >>> verify_parts(replace(pieces, radius=pieces.radius / 2))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: piece 0: nothing touches its largest disc, of radius 0.8377223398316207
    """
    check_value(parts, "parts", "Parts")
    run = running(threads, progress)
    verify_necks(parts.necks, **run)
    parts = _placed_parts(parts)
    if (at := first_wrong(~(parts.area > 0))) is not None:
        fail(f"piece {at} has an area of {parts.area[at]}")
    _check_discs(parts, run)
    _check_cuts(parts)
    _check_borders(parts, run)
    with silent():
        _check_areas(parts, run)


# ---- where they were computed --------------------------------------------------------------------
def _placed(necks: Necks) -> Necks:
    """Necks whose feet are where their skeleton has the vertices and edges that these are on."""
    return replace(necks, feet=moved_feet(necks.skeleton, necks.sites, necks.feet, back=True))


def _placed_parts(parts: Parts) -> Parts:
    """Parts whose corners are where the skeleton has the vertices and edges that these are on."""
    polygons, necks, placed = parts.polygons, parts.necks, _placed(parts.necks)
    source = np.repeat(parts.source, np.diff(polygons.ring_starts[polygons.polygon_starts]))
    others = np.repeat(necks.polygon, 2), necks.feet.reshape(-1, 2), placed.feet.reshape(-1, 2)
    together = necks.skeleton.features == "together"
    xy = places_as_given(polygons.xy, source, necks.skeleton.polygons, together=together, back=True, others=others)
    return replace(parts, polygons=replace(polygons, xy=xy), necks=placed)


# ---- distances -----------------------------------------------------------------------------------
def _clearances(skeleton: Skeleton, polygon: NDArray[np.int32], places: Floats, reach: Floats, threads: int) -> Floats:
    """Of places, from the boundary of the feature that each is in; infinite beyond reach."""
    polygons = skeleton.polygons
    feature = np.zeros(len(polygons), dtype=np.int64)
    if skeleton.features == "separate":
        feature = polygons.feature.astype(np.int64)
    own = feature[polygon]
    found, step = np.empty(len(places)), skeleton.scale or 1.0
    for each in np.unique(own).tolist():
        points, segments = _elements(polygons, np.flatnonzero(feature == each), skeleton)
        chosen = np.flatnonzero(own == each)
        lattice = np.ascontiguousarray((places[chosen] - skeleton.origin) / step)
        far = np.ascontiguousarray(reach[chosen] / step)
        found[chosen] = step * _core.spatial.clearances(points, segments, lattice, far, threads, None)
    return found


def _elements(
    polygons: PolygonSet, chosen: NDArray[np.int64], skeleton: Skeleton
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Vertices and edges of some polygons, as the lattice has them."""
    rings = np.concatenate([np.arange(*polygons.polygon_starts[[k, k + 1]]) for k in chosen.tolist()])
    vertices = np.concatenate([np.arange(*polygons.ring_starts[[k, k + 1]]) for k in rings.tolist()])
    number = ranks_of(vertices, len(polygons.xy))
    points = np.rint((polygons.xy[vertices] - skeleton.origin) / (skeleton.scale or 1.0)).astype(np.int32)
    segments = np.stack([number[vertices], number[polygons.following[vertices]]], axis=1).astype(np.int32)
    has_length = (points[segments[:, 0]] != points[segments[:, 1]]).any(axis=1)
    return points, np.ascontiguousarray(segments[has_length & ~polygons.ends_line[vertices]])


def _check_clearances(
    skeleton: Skeleton,
    polygon: NDArray[np.int32],
    places: Floats,
    radius: Floats,
    what: str,
    run: Run,
) -> None:
    """Raise if the boundary is nearer to a place than it is said."""
    tolerance = SitePlaces(skeleton).tolerance
    nearest = _clearances(skeleton, polygon, places, radius + 2 * tolerance, run["threads"])
    if (at := first_wrong(nearest < radius - tolerance)) is not None:
        fail(f"{what} {at}: the boundary is {nearest[at]} from {places[at].tolist()}, nearer than {radius[at]}")
    if (at := first_wrong(~(nearest <= radius + tolerance))) is not None:
        fail(f"{what} {at}: nothing touches its largest disc, of radius {radius[at]}")
    report(run["progress"], 1.0)


# ---- pieces --------------------------------------------------------------------------------------
def _check_discs(parts: Parts, run: Run) -> None:
    skeleton = parts.necks.skeleton
    _check_clearances(skeleton, parts.source, parts.center, parts.radius, "piece", run)
    polygons, after = parts.polygons, parts.polygons.following
    corner = owners(np.diff(polygons.ring_starts[polygons.polygon_starts]))
    (x, y), (u, v) = polygons.xy.T, polygons.xy[after].T
    px, py = parts.center[corner].T
    crosses = (y > py) != (v > py)
    right = crosses & (((x - px) * (v - y) - (y - py) * (u - x) > 0) == (v > y))
    # a maximum may be as near to a neck as rounding
    off = np.full(len(parts), np.inf)
    np.minimum.at(off, corner, off_segments(parts.center[corner], polygons.xy, polygons.xy[after]))
    is_out = np.bincount(corner, right, minlength=len(parts)) % 2 == 0
    if (at := first_wrong(is_out & (off > SitePlaces(skeleton).tolerance))) is not None:
        fail(f"piece {at}: the center of its largest disc, {parts.center[at].tolist()}, is not in it")


def _directed(parts: Parts) -> tuple[Floats, NDArray[np.int64]]:
    """(n, 4) both ends of each edge of the pieces, and the piece."""
    polygons = parts.polygons
    edges = np.concatenate([polygons.xy, polygons.xy[polygons.following]], axis=1)
    return edges, owners(np.diff(polygons.ring_starts[polygons.polygon_starts]))


def _check_cuts(parts: Parts) -> None:
    edges, piece = _directed(parts)
    found: dict[tuple[float, ...], list[int]] = {}
    for ends, owner in zip(map(tuple, edges.tolist()), piece.tolist(), strict=True):
        found.setdefault(ends, []).append(owner)
    cuts = parts.necks.feet.reshape(-1, 4).tolist()
    for neck, (cut, between) in enumerate(zip(cuts, parts.between.tolist(), strict=True)):
        sides = [found.get(tuple(cut), []), found.get((*cut[2:], *cut[:2]), [])]
        if sorted(map(len, sides)) != [1, 1] or sorted(side[0] for side in sides) != between or sides[0] == sides[1]:
            fail(f"cut {neck} is listed between the pieces {between}, but is an edge of {sides[0]} and {sides[1]}")


def _check_borders(parts: Parts, run: Run) -> None:
    """Raise unless edges that are no cuts lie on the boundary."""
    edges, piece = _directed(parts)
    cuts = {tuple(cut) for cut in parts.necks.feet.reshape(-1, 4).tolist()}
    is_cut = [tuple(ends) in cuts or (*ends[2:], *ends[:2]) in cuts for ends in edges.tolist()]
    rest = np.flatnonzero(~np.array(is_cut, dtype=bool))
    skeleton, source = parts.necks.skeleton, parts.source[piece[rest]]
    tolerance = SitePlaces(skeleton).tolerance
    a, b = edges[rest, :2], edges[rest, 2:]
    for place in (a, (a + b) / 2):
        off = _clearances(skeleton, source, place, np.full(len(rest), 2 * tolerance), run["threads"])
        if (at := first_wrong(~(off <= tolerance))) is not None:
            fail(
                f"piece {piece[rest[at]]}: {place[at].tolist()} is on its border, but neither on a cut nor on the "
                "boundary"
            )
    report(run["progress"], 1.0)


def _check_areas(parts: Parts, run: Run) -> None:
    skeleton = parts.necks.skeleton
    if skeleton.features == "together" or not len(skeleton.polygons):
        graph = planar_graph(skeleton.polygons, **run)
        _check_area(parts, np.arange(len(skeleton.polygons)), graph)
        return

    def check(shapes: BatchShapes, _: Run) -> None:
        _check_area(parts, np.asarray(shapes.batch.polygons), shapes.graph)

    in_batches(skeleton.polygons, check, drops=False, **run)


def _check_area(parts: Parts, polygons: NDArray[np.integer], graph: PlanarGraph) -> None:
    """Raise unless the pieces of some polygons sum to the area of the faces that these cover."""
    inside = graph.is_inside.astype(np.int64)
    left, right = inside[graph.segment_faces].T
    (x, y), (u, v) = (graph.points[graph.segments[:, end]].astype(np.float64).T for end in (0, 1))
    area = float(((x * v - u * y) * (left - right)).sum()) / 2 * (graph.scale * graph.scale)
    summed = float(parts.area[np.isin(parts.source, polygons)].sum())
    extent = float(np.ptp(graph.points, axis=0).max()) * graph.scale if len(graph.points) else 0.0
    around = norms((graph.points[graph.segments[:, 0]] - graph.points[graph.segments[:, 1]]).astype(float)).sum()
    allowed = _AREA_ERROR * area + 8 * np.spacing(max(extent, np.abs(graph.origin).max())) * around * graph.scale
    if not abs(area - summed) <= allowed:
        first, last = polygons.min(initial=0), polygons.max(initial=0)
        fail(f"the pieces of polygons {first} to {last} sum to {summed}, but their area is {area}")
