"""Necks of polygons: where the clearance is least along the skeleton, their feet, and the clearances beside."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.skeleton.clearance import clearance_course, plateaus
from vorotool.engines.skeleton_api import skeleton_exact
from vorotool.errors import UsageError, option
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Columns, Floats, Indices, crosses, dots, mask_of
from vorotool.numeric.numbers import finite_double, shown_number
from vorotool.numeric.parallel import Progress, Run
from vorotool.types.polygons.planar_graph import moved_feet, projected
from vorotool.types.skeleton.arc_measures import ClearanceCourse
from vorotool.types.skeleton.necks import Necks
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

if TYPE_CHECKING:
    from vorotool.typing import FeaturesChoice, PolygonsLike

NARROW = 0.95
"""The ratio of `necks` by default: in bends of constant width each facet has a neck above 0.99."""


def necks(
    polygons: PolygonsLike | Skeleton,
    *,
    neck: float = NARROW,
    features: FeaturesChoice = "separate",
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Necks:
    """Find the necks of polygons: the points of the skeleton where the clearance is least in both directions.

    Inside an arc of the skeleton, or at a node of two arcs, the clearance grows both ways; the disc there touches the
    boundary at two opposite places, and the cut from one to the other is the shortest anywhere near. Between parallel
    edges the clearance stays the same on a whole line: then the cut is at the middle of this. All that decides where
    there are necks, and which is narrower, is exact.

    On either side of a neck the largest clearance is looked for, as far as no narrower neck has to be passed, or one
    that is as narrow and comes before it: small bumps in a corridor do not hide the rooms beyond. Around a hole both
    ways may lead to the same place. Necks that are hardly narrower than what is beside are left out, such as those at
    each vertex of a bend of constant width.

    Parameters
    ----------
    polygons : PolygonSet, shapely geometry, GeoSeries, GeoJSON, (n, 2) array, …, a list of these, or Skeleton
        As of :func:`vorotool.skeleton_exact`, or what that has made of the inside, not pruned and without a gap.
    neck : float
        The largest ratio, of half the width to the smaller of both clearances beside, from 0 to 1: 1 gives all necks.
    features : {"separate", "together"}
        Take each feature by itself, or all of them as one drawing.
    strict, threads, progress : optional
        As for :func:`vorotool.skeleton_exact`.

    Returns
    -------
    Necks
        Polygon by polygon, by x and then by y.

    Raises
    ------
    InputError
        As for :func:`vorotool.skeleton_exact`.
    UsageError
        If the ratio is not from 0 to 1, or the skeleton is approximate, pruned, or has a gap.

    Examples
    --------
    >>> dumbbell = [[0, 0], [4, 0], [4, 1], [6, 1], [6, 0], [10, 0], [10, 4], [6, 4], [6, 3], [4, 3], [4, 4], [0, 4]]
    >>> found = necks(dumbbell)
    >>> found.xy.tolist(), found.width.tolist(), found.ratio.tolist()
    ([[5.0, 2.0]], [2.0], [0.5])
    >>> len(necks(dumbbell, neck=0.4))
    0
    """
    check_neck(neck)
    skeleton = whole_skeleton(polygons, features=features, strict=strict, threads=threads, progress=progress)
    found = found_necks(skeleton, threads=threads, progress=progress).necks
    return found.taken(found.ratio <= neck)


def check_neck(neck: float) -> None:
    """Raise UsageError unless a ratio of necks is from 0 to 1."""
    ratio = finite_double(neck, "the ratio of necks")
    if not 0 <= ratio <= 1:
        raise UsageError(f"invalid {option('--neck', 'neck=')} {shown_number(neck)}: expected a ratio from 0 to 1")


def whole_skeleton(
    polygons: PolygonsLike | Skeleton, *, features: FeaturesChoice, strict: bool, **run: Unpack[Run]
) -> Skeleton:
    """Give the skeleton inside polygons, which may be given themselves."""
    if not isinstance(polygons, Skeleton):
        return skeleton_exact(polygons, features=features, strict=strict, **run)
    is_inside = polygons.side == INTERIOR
    ends = polygons.arcs[is_inside]
    is_cut = (polygons.radius[ends] > 0) & (polygons.degree[ends] == 1)
    if polygons.gap or polygons.error_bound.any() or is_cut.any() or not is_inside.all():
        raise UsageError(
            "necks need the whole skeleton inside polygons: give the polygons, or their skeleton_exact without "
            "pruning, gap or arcs outside"
        )
    return polygons


@frozen(eq=False)
class FoundNecks:
    """Necks, and where the skeleton is to be cut for each."""

    necks: Necks  # in their order
    ways: Ways
    feet: Feet  # of each, left and right of its ways


def found_necks(skeleton: Skeleton, **run: Unpack[Run]) -> FoundNecks:
    """Find the necks on a whole skeleton inside polygons."""
    flow = clearance_flow(skeleton, **run)
    ways = ways_from_necks(skeleton, flow)
    feet = feet_of(skeleton, ways)
    x, y = feet.xy.mean(axis=1).T
    order = np.lexsort((ways.arc[:, 0], y, x, skeleton.polygon[ways.arc[:, 0]]))
    ways, feet = ways[order], feet[order]
    clearance = np.zeros(len(flow.top))
    np.maximum.at(clearance, flow.plateau, skeleton.radius)
    beside = largest_beside(ways.top, feet.square, clearance)
    # the foot with less x first
    given = moved_feet(skeleton, feet.site, feet.xy)
    (a, b), rows = given.swapaxes(0, 1), np.arange(len(ways))
    first = ((b[:, 0] < a[:, 0]) | ((b[:, 0] == a[:, 0]) & (b[:, 1] < a[:, 1]))).astype(np.int64)
    both = np.stack([first, 1 - first], axis=1)
    made = Necks(
        skeleton,
        ways.arc[:, 0].astype(np.int32),
        feet.xy.mean(axis=1),
        feet.width,
        given[rows[:, None], both],
        feet.site[rows[:, None], both].astype(np.int32),
        beside,
    )
    return FoundNecks(made, ways, feet)


def largest_beside(top: Indices, square: Indices, clearance: Floats) -> Floats:
    """(n, 2) the largest clearance on both sides of necks as far as no narrower one has to be passed, smaller first."""
    root, largest = list(range(len(clearance))), clearance.tolist()
    beside = np.empty((len(top), 2))
    pairs = top.tolist()
    for neck in by_width(square).tolist():
        a, b = (_found(root, place) for place in pairs[neck])
        beside[neck] = sorted((largest[a], largest[b]))
        root[b] = a
        largest[a] = max(largest[a], largest[b])
    return beside


def _found(root: list[int], place: int) -> int:
    """What a place is joined to; the way there gets shorter."""
    while root[place] != place:
        root[place] = root[root[place]]
        place = root[place]
    return place


@frozen(eq=False)
class Ways(Columns):
    """The two ways that lead on from each neck."""

    # (n, 2) int64 array: the arc that each way begins with: the same twice where the neck is inside an arc
    arc: Indices
    # (n, 2) int64 array: which end of it, or of the half of it that the way takes, is at the neck: 0 the source, 1
    # the target
    end: Indices
    # (n, 2) float64 array: the place half-way along a plateau of several nodes; NaN of other necks
    middle: NDArray[np.float64]
    top: Indices  # (n, 2) int64 array: the plateau up to which the clearance grows along each way

    def __len__(self) -> int:
        return len(self.arc)

    @property
    def is_inside(self) -> NDArray[np.bool_]:
        """(n,) whether each neck is inside an arc, not at a node."""
        return np.equal(self.arc[:, 0], self.arc[:, 1])


@frozen(eq=False)
class Flow:
    """How the clearance grows from plateau to plateau, most of which are single nodes."""

    course: ClearanceCourse
    plateau: NDArray[np.int32]  # (v,) int32 array: that of each node
    top: Indices  # (p,) int64 array: the local maximum that the clearance grows to from each plateau


def clearance_flow(skeleton: Skeleton, **run: Unpack[Run]) -> Flow:
    """Follow the clearance upwards from everywhere."""
    course = clearance_course(skeleton, **run)
    plateau = plateaus(skeleton, course)
    top = np.arange(int(plateau.max(initial=-1)) + 1)
    source, target = plateau[skeleton.arcs].T.astype(np.int64)
    rises, falls = (_has(course, signs) for signs in ((1, -1), (-1, 1)))
    top[source[rises]] = target[rises]
    top[target[falls]] = source[falls]
    while True:
        further = top[top]
        if (further == top).all():
            return Flow(course, plateau, top)
        top = further


def ways_from_necks(skeleton: Skeleton, flow: Flow) -> Ways:
    """Find the necks: places inside arcs, and plateaus from which the clearance grows both ways."""
    inside = np.flatnonzero(_has(flow.course, (-1, -1)))
    between, between_end = _rising_pairs(skeleton, flow)
    arc = np.concatenate([np.stack([inside, inside], axis=1), between])
    end = np.concatenate([np.tile([1, 0], (len(inside), 1)), between_end])
    top = flow.top[flow.plateau[skeleton.arcs[arc, 1 - end]]]
    made = Ways(arc, end, np.full((len(arc), 2), np.nan), top)
    node = skeleton.arcs[arc, end]
    is_long = ~made.is_inside & (node[:, 0] != node[:, 1])
    _to_middles(skeleton, flow, made, np.flatnonzero(is_long))
    return made


def _has(course: ClearanceCourse, signs: tuple[int, int]) -> NDArray[np.bool_]:
    return (course.slope == signs).all(axis=1)


def _rising_pairs(skeleton: Skeleton, flow: Flow) -> tuple[Indices, Indices]:
    """(n, 2) arcs along which the clearance grows from plateaus that it does not shrink from, and their ends there."""
    slope, plateau = flow.course.slope, flow.plateau[skeleton.arcs]
    falls = mask_of(plateau[slope < 0], len(flow.top))
    falls[flow.plateau[skeleton.radius == 0]] = True
    arc, end = np.nonzero((slope > 0) & ~falls[plateau])
    own = plateau[arc, end]
    order = np.lexsort((end, arc, own))
    first = np.flatnonzero(np.diff(own[order]) == 0)
    pairs = order[np.stack([first, first + 1], axis=1)]
    return arc[pairs], end[pairs]


def _to_middles(skeleton: Skeleton, flow: Flow, ways: Ways, long: Indices) -> None:
    """Have necks on plateaus of several nodes half-way along these: they are straight lines between parallel edges."""
    if not len(long):
        return
    neck = np.full(len(flow.top), -1)
    ends = skeleton.arcs[ways.arc[long], ways.end[long]]
    neck[flow.plateau[ends[:, 0]]] = np.arange(len(long))
    flat = np.flatnonzero(_has(flow.course, (0, 0)))
    flat = flat[neck[flow.plateau[skeleton.arcs[flat, 0]]] >= 0]
    own = neck[flow.plateau[skeleton.arcs[flat, 0]]]
    begin, way = skeleton.vertices[ends[:, 0]], skeleton.vertices[ends[:, 1]] - skeleton.vertices[ends[:, 0]]
    places = skeleton.vertices[skeleton.arcs[flat]] - begin[own, None]
    along = dots(places, way[own, None]) / dots(way, way)[own, None]
    beyond = np.maximum(np.abs(along.mean(axis=1) - 0.5) - np.abs(along[:, 1] - along[:, 0]) / 2, 0)
    order = np.lexsort((along.min(axis=1), beyond, own))
    chosen = order[np.flatnonzero(np.diff(own[order], prepend=-1))]
    is_forward = (along[chosen, 0] <= along[chosen, 1]).astype(np.int64)
    ways.arc[long] = flat[chosen, None]
    ways.end[long] = np.stack([is_forward, 1 - is_forward], axis=1)
    ways.middle[long] = begin + way / 2


_CLOSE = 2.0**-50
"""Part of a width: as a double it is rounded by at most 4 units of 2^-53."""

_SNAP = 4
"""Ulp of the largest coordinate by which the projection of a place half-way along a plateau is rounded at most."""


@frozen(eq=False)
class Feet(Columns):
    """Feet of necks: left and right of the way from the first of their ways to the second."""

    site: Indices  # (n, 2) int64 array: what each foot is on
    xy: Floats  # (n, 2, 2) float64 array: where they are
    width: Floats  # (n,) float64 array: between them
    # (n, 2) int64 array: the exact square of the width in steps of the lattice. Between two vertices it is the first
    # number, the second is 0. Else one is on an edge: it is the square of the first number over the second, the
    # square of the length of that edge
    square: Indices


def feet_of(skeleton: Skeleton, ways: Ways) -> Feet:
    """Find both feet: a vertex, where one is touched; on an edge, the place nearest to the other foot."""
    site = _sites(skeleton, ways)
    ends, is_edge = skeleton.site_ends[site], _is_edge(skeleton)[site]
    xy = ends[:, :, 0].copy()
    both = is_edge.all(axis=1)
    tolerance = _SNAP * float(np.spacing(np.abs(skeleton.polygons.xy).max(initial=1.0)))
    for hand in (0, 1):
        alone = is_edge[:, hand] & ~both
        xy[alone, hand] = projected(ends[alone, hand], ends[alone, 1 - hand, 0])
        xy[both, hand] = _at_ends(projected(ends[both, hand], ways.middle[both]), ends[both, hand], tolerance)
    width, square = _widths(skeleton, ends, is_edge)
    return Feet(site, xy, width, square)


def _is_edge(skeleton: Skeleton) -> NDArray[np.bool_]:
    return skeleton.site_table.kind == EDGE


def _sites(skeleton: Skeleton, ways: Ways) -> Indices:
    """(n, 2) the sites left and right of each neck; where they change there, the vertex."""
    is_edge = _is_edge(skeleton)
    sites = skeleton.sites[ways.arc].astype(np.int64)  # (n, way, hand)
    # from the first way to the second: the first is walked towards its end at the neck, the second from there
    turned = ways.end == (0, 1)
    sites = np.where(turned[:, :, None], sites[:, :, ::-1], sites)
    first, second = sites[:, 0], sites[:, 1]
    return np.where(is_edge[first] & ~is_edge[second], second, first)


def _at_ends(foot: Floats, edge: Floats, tolerance: float) -> Floats:
    """Feet, but the end of the edge where this is where rounding may have kept them from."""
    for end in (0, 1):
        is_off = np.abs(foot - edge[:, end]).max(axis=1, keepdims=True) > tolerance
        foot = np.where(is_off, foot, edge[:, end])
    return foot


def _widths(skeleton: Skeleton, ends: Floats, is_edge: NDArray[np.bool_]) -> tuple[Floats, Indices]:
    """Distances between the sites of each neck: products of coordinates below 2^30 in magnitude fit in 64 bits."""
    step = skeleton.scale or 1.0
    places = np.rint((ends - np.asarray(skeleton.origin)) / step).astype(np.int64)
    turned = is_edge[:, 1]
    edge = np.where(turned[:, None, None], places[:, 1], places[:, 0])
    point = np.where(turned[:, None], places[:, 0, 0], places[:, 1, 0])
    way, to_point = edge[:, 1] - edge[:, 0], point - edge[:, 0]
    cross = np.abs(crosses(way, to_point))
    between, along = dots(to_point, to_point), dots(way, way)
    has_edge = is_edge[:, 0] | is_edge[:, 1]
    square = np.where(has_edge[:, None], np.stack([cross, along], axis=1), np.stack([between, 0 * between], axis=1))
    length = np.sqrt(np.maximum(along, 1).astype(np.float64))
    width = np.where(has_edge, cross / length, np.sqrt(between.astype(np.float64)))
    return step * width, square


def by_width(square: Indices) -> Indices:
    """Give the numbers of necks from the widest to the narrowest, of equal ones the last first."""
    kinds, of = np.unique(square, axis=0, return_inverse=True)
    rank = _ranks(kinds)[of.reshape(-1)]
    return np.lexsort((np.arange(len(rank)), rank))[::-1]


def _ranks(kinds: Indices) -> Indices:
    """Numbers that rise with squares, the same for equal ones."""
    length = np.sqrt(np.maximum(kinds[:, 1], 1).astype(np.float64))
    rounded = np.where(kinds[:, 1] > 0, kinds[:, 0] / length, np.sqrt(kinds[:, 0].astype(np.float64)))
    order = np.argsort(rounded, kind="stable")
    is_apart = np.diff(rounded[order]) > _CLOSE * rounded[order[1:]]
    group = np.concatenate([[0], np.cumsum(is_apart)])[: len(order)]
    rank = np.empty(len(kinds), dtype=np.int64)
    rank[order] = group << 32
    for members in np.split(order, np.flatnonzero(is_apart) + 1):
        if len(members) > 1:
            exact = [_exact(*kind) for kind in kinds[members].tolist()]
            number = {value: k for k, value in enumerate(sorted(set(exact)))}
            rank[members] += [number[value] for value in exact]
    return rank


def _exact(number: int, over: int) -> Fraction:
    return Fraction(number * number, over) if over else Fraction(number)
