"""Checks the largest discs from the polygons alone: no edge enters one, and there is no place for a larger one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import fail, first_wrong, off_segments
from vorotool.engines.skeleton.clearance import ULPS, largest_coordinate
from vorotool.numeric.arrays import Floats, dots, norms
from vorotool.numeric.lazy import shapely
from vorotool.numeric.parallel import Progress, report
from vorotool.types.arguments import check_value
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.shapely_geometry import used_shapes
from vorotool.types.skeleton.discs import Discs

if TYPE_CHECKING:
    from shapely import STRtree


LARGER = 2.0**-8
"""Of the radius: no disc that is larger by more is anywhere, not only near the center that was found."""

_MOST_CELLS = 1 << 17
"""Of a search; a bound of what is left then is given up."""


def verify_discs(discs: Discs, *, progress: Progress = None) -> None:
    """Check discs from their arrays and the polygons alone.

    The nearest edge of the feature is as far from each center as the radius, and so are its feet, which are on their
    sites; the center is inside. Of each feature the discs come from the largest, and are disjoint if they have to be.
    Feet hold those that are the largest, or larger than those around them: they do not leave half of the circle free,
    so that no disc near by is larger. That none elsewhere is larger than the first by a part in 256 is shown by squares
    that cover the feature, each divided until the distances from its center tell, up to 131 072 of them.

    Parameters
    ----------
    discs : Discs
        As `vorotool.largest_discs` gives them.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    VerificationError
        If something is wrong; the message says what and where.

    Examples
    --------
    >>> from vorotool import largest_discs
    >>> verify_discs(largest_discs([[0, 0], [4, 0], [0, 3]]))
    """
    check_value(discs, "discs", "Discs")
    largest = largest_coordinate((0.0, 0.0), discs.polygons.xy, discs.xy) or 1.0
    tolerance = 2 * ULPS * float(np.spacing(largest))
    _check_feet(discs, tolerance)
    if discs.within is not None:
        _check_empty(discs, discs.within, tolerance)
        return
    feature = discs.polygons.feature
    if (at := first_wrong(discs.polygon < 0)) is not None:
        fail(f"disc {at} is in no polygon")
    of_disc = feature[discs.polygon]
    owners = np.unique(of_disc)
    for number, own in enumerate(owners):
        chosen = np.flatnonzero(of_disc == own)
        _check_order(discs, chosen, tolerance)
        if discs.features == "separate":
            _check_feature(discs, chosen, np.flatnonzero(feature == own), tolerance)
        report(progress, (number + 1) / len(owners))
    if discs.features == "together" and len(discs):
        _check_clear(discs, np.arange(len(discs)), _edges(discs, np.arange(len(feature))), tolerance)


def _check_feet(discs: Discs, tolerance: float) -> None:
    counts = np.diff(discs.foot_starts)
    disc = np.repeat(np.arange(len(discs)), counts)
    if (at := first_wrong(counts < (2 if discs.within is None else 1))) is not None:
        fail(f"disc {at} has {counts[at]} feet")
    away = np.abs(norms(discs.feet - discs.xy[disc]) - discs.radius[disc])
    if (at := first_wrong(~(away <= tolerance))) is not None:
        fail(f"a foot of disc {disc[at]} is {away[at]} off its circle")
    from vorotool.types.skeleton.segment_voronoi import ends_of_sites

    ends = ends_of_sites(discs.polygons, discs.site_table, discs.foot_site)
    if (at := first_wrong(~(off_segments(discs.feet, *ends.swapaxes(0, 1)) <= tolerance))) is not None:
        fail(f"a foot of disc {disc[at]} is not on its site {discs.foot_site[at]}")


def _check_order(discs: Discs, chosen: NDArray[np.intp], tolerance: float) -> None:
    if (discs.rank[chosen] != np.arange(len(chosen)) + 1).any():
        fail(f"ranks {discs.rank[chosen].tolist()} are not consecutive")
    radius = discs.radius[chosen]
    if (at := first_wrong(np.diff(radius) > tolerance)) is not None:
        fail(f"disc {chosen[at + 1]} is larger than the one before it")
    if discs.local:
        return
    for k in range(1, len(chosen)):
        way = discs.xy[chosen[:k]] - discs.xy[chosen[k]]
        if (at := first_wrong(norms(way) < radius[:k] + radius[k] - tolerance)) is not None:
            fail(f"discs {chosen[at]} and {chosen[k]} overlap")


def _edges(discs: Discs, polygons: NDArray[np.intp]) -> Any:
    """Edges of some polygons."""
    shapes = discs.polygons
    starts = shapes.ring_starts[shapes.polygon_starts]
    own = np.concatenate([np.arange(starts[k], starts[k + 1]) for k in polygons.tolist()])
    following = np.where(shapes.ends_line, np.arange(len(shapes.xy)), shapes.following)
    return shapely.linestrings(np.stack([shapes.xy[own], shapes.xy[following[own]]], axis=1))


def _distances(tree: STRtree, places: Floats) -> Floats:
    (_, _), found = tree.query_nearest(shapely.points(places), return_distance=True, all_matches=False)
    return np.asarray(found)


def _check_clear(discs: Discs, chosen: NDArray[np.intp], edges: Any, tolerance: float) -> STRtree:
    tree = shapely.STRtree(edges)
    found = _distances(tree, discs.xy[chosen])
    if (at := first_wrong(~(np.abs(found - discs.radius[chosen]) <= tolerance))) is not None:
        k = chosen[at]
        fail(f"disc {k}: an edge is {found[at]} from its center, but its radius is {discs.radius[k]}")
    return tree


def _check_feature(discs: Discs, chosen: NDArray[np.intp], polygons: NDArray[np.intp], tolerance: float) -> None:
    tree = _check_clear(discs, chosen, _edges(discs, polygons), tolerance)
    shapes = [shape for shape in used_shapes(discs.polygons)[polygons] if shape.geom_type.endswith("Polygon")]
    inside = shapely.union_all(shapes)
    shapely.prepare(inside)
    if (at := first_wrong(~shapely.contains_xy(inside, *discs.xy[chosen].T))) is not None:
        fail(f"the center of disc {chosen[at]} is not inside")
    for k in (chosen if discs.local else chosen[:1]).tolist():
        if not _is_held(discs, k, tolerance):
            fail(f"the feet of disc {k} leave half of its circle free: it could grow")
    _check_none_larger(discs, int(chosen[0]), tree, inside, tolerance)


def _check_empty(discs: Discs, within: PolygonSet, tolerance: float) -> None:
    """Discs between shapes, whose centers are in a region."""
    everything = np.arange(len(discs))
    if not len(discs):
        return
    _check_order(discs, everything, tolerance)
    tree = _check_clear(discs, everything, _edges(discs, np.arange(len(discs.polygons))), tolerance)
    filled = [shape for shape in used_shapes(discs.polygons) if shape.geom_type.endswith("Polygon")]
    region = shapely.union_all(used_shapes(within))
    space = shapely.difference(region, shapely.union_all(filled))
    shapely.prepare(space)
    if (at := first_wrong(~(shapely.distance(space, shapely.points(discs.xy)) <= tolerance))) is not None:
        fail(f"the center of disc {at} is not in the region, or in a shape")
    _check_none_larger(discs, 0, tree, space, tolerance)


def _is_held(discs: Discs, disc: int, tolerance: float) -> bool:
    ways = (discs.feet_of(disc) - discs.xy[disc]) / discs.radius[disc]
    slack = 8 * tolerance / float(discs.radius[disc]) + 1e-12
    turn = ways[:, None, 0] * ways[:, 1] - ways[:, None, 1] * ways[:, 0]
    is_next = (turn > slack) | ((np.abs(turn) <= slack) & (dots(ways[:, None], ways) < 0))
    return bool(is_next.any(axis=1).all())  # each has one within half a turn to the left


def _check_none_larger(discs: Discs, disc: int, tree: STRtree, inside: Any, tolerance: float) -> None:
    """Squares by their centers: one may hold a larger disc's if the edges are farther than its corners reach."""
    enough = float(discs.radius[disc]) * (1 + LARGER) + tolerance
    x0, y0, x1, y1 = inside.bounds
    side = max(x1 - x0, y1 - y0)
    places = np.array([[x0 + side / 2, y0 + side / 2]])  # one square over all: a thin shape has no wide first grid
    while len(places) and len(places) <= _MOST_CELLS:
        away = _distances(tree, places)
        if (larger := first_wrong((away > enough) & shapely.contains_xy(inside, *places.T))) is not None:
            place = tuple(places[larger].tolist())
            fail(f"a disc of radius {away[larger]} fits at {place}, larger than disc {disc}")
        reach = side * np.sqrt(0.5)
        places = places[away + reach > enough]
        places = places[shapely.distance(inside, shapely.points(places)) <= reach]
        side /= 2
        quarter = np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]]) * side / 2
        places = (places[:, None] + quarter).reshape(-1, 2)
