"""The planar map of borders and cuts: whose each side of a cut is, by what is beside it where both meet."""

from __future__ import annotations

from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.voronoi.overlay import UNKNOWN, Overlay, RegionOverlay
from vorotool.engines.voronoi.regions import NearestElements
from vorotool.errors import VerificationError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import (
    Floats,
    Indices,
    crosses,
    dots,
    following,
    mask_of,
    norms,
    ranges,
    ranks_of,
    starts_of,
)
from vorotool.numeric.curves.mixed_arcs import MixedArcs
from vorotool.numeric.lazy import shapely
from vorotool.types.voronoi.voronoi_map import OUTSIDE

_AT_ONCE = 2**18
"""Arcs that are measured together, so that this takes little memory."""


@frozen(eq=False)
class Arcs:
    """Arcs of a planar map, from the vertex with the smaller number each."""

    vertices: Floats  # (v, 2) float64 array: places
    # (v,) float64 array: distances from the nearest sites there; NaN at corners of the frame that no border ends at
    radius: Floats
    ends: Indices  # (a, 2) int64 array: source and target
    control: Floats  # (a, 2) float64 array: control points of parabolas, and centers of circular arcs; NaN of others
    center: Floats  # (a, 2) float64 array: control points of parabolas, and centers of circular arcs; NaN of others
    sites: Indices  # (a, 2) int64 array: left and right; `OUTSIDE` of what belongs to nobody
    parts: Indices  # (a, 2) int64 array: left and right; `OUTSIDE` of what belongs to nobody
    order: Indices  # (a, 2) int64 array: rising counter-clockwise around source and target
    is_cut: NDArray[np.bool_]  # (a,) whether each is along a cut
    # vertices that are vertices of the input, and where these are: all is decided where the lattice has them
    moves: tuple[Indices, Floats]

    def mixed(self) -> MixedArcs:
        """The arcs with their ends."""
        source, target = (self.vertices.take(end, axis=0) for end in self.ends.T)
        return MixedArcs(source, target, self.control, self.center, self.sites[:, 0] != OUTSIDE)


def without_lost(center: Floats, places: Floats, ends: Indices, is_left: NDArray[np.bool_]) -> Floats:
    """Return centers of arcs of at most half a circle; those that rounding flattens are lines."""
    circular = np.flatnonzero(~np.isnan(center[:, 0]))
    a, b = (places[end] - center[circular] for end in ends[circular].T)
    cross = np.where(is_left[circular], 1, -1) * (crosses(a, b))
    is_lost = (dots(a, b) > 0) & (cross <= 0)
    made = center.copy()
    made[circular[is_lost]] = np.nan
    return made


def by_ends(ends: Indices, control: Floats, center: Floats) -> Indices:
    """Give the order of arcs by their ends; those between the same two by their control points and centers."""
    vertices = int(ends.max(initial=-1)) + 1
    sorting = _core.graphs.arcs_by_ends(ends.astype(np.int32), vertices).astype(np.int64)
    key = (ends[:, 0] * vertices + ends[:, 1])[sorting]
    again = np.flatnonzero(key[1:] == key[:-1])
    if again.size:  # few arcs have both ends in common
        alike = np.union1d(again, again + 1)
        arc = sorting[alike]
        sorting[alike] = arc[np.lexsort((*center[arc].T[::-1], *control[arc].T[::-1], key[alike]))]
    return sorting


@frozen(eq=False)
class Rings:
    """Rings of a planar map without double points."""

    start: Indices  # (r + 1,) int64 array: where each begins in `half_edge`
    half_edge: Indices  # (h,) int64 array: along each: 2 k along arc k, 2 k + 1 back
    site: Indices  # (r,) int64 array: on the left
    part: Indices  # (r,) int64 array: on the left
    area: Floats  # (r,) float64 array: above 0 of shells

    def __getitem__(self, chosen: NDArray[np.bool_]) -> Rings:
        """Some of the rings."""
        sizes = np.diff(self.start)[chosen]
        half_edge = self.half_edge[ranges(self.start[:-1][chosen], sizes)]
        return Rings(starts_of(sizes), half_edge, self.site[chosen], self.part[chosen], self.area[chosen])


def rings_of(arcs: Arcs) -> Rings:
    """Go around every face of a map, with the face on the left; the rings of the outside are left out."""
    ends, count = arcs.ends.astype(np.int32), len(arcs.vertices)
    after = _core.graphs.next_half_edges(ends, arcs.order, count)
    start, half_edge = (each.astype(np.int64) for each in _core.graphs.boundary_cycles(after, ends.ravel(), count))
    site, part = arcs.sites.ravel()[half_edge], arcs.parts.ravel()[half_edge]
    begin = start[:-1]
    if (site != np.repeat(site[begin], np.diff(start))).any():
        raise VerificationError(
            "internal error in vorotool: borders do not close around a cell; please report it with the input"
        )
    area = _core.voronoi.ring_areas(start, half_edge, ends, arcs.vertices, _bulges(arcs))
    rings = Rings(start, half_edge, site[begin], part[begin], area)
    return rings[site[begin] != OUTSIDE]


def _bulges(arcs: Arcs) -> Floats:
    """(a,) signed areas between chords and arcs."""
    bulges = np.empty(len(arcs.ends))
    for first in range(0, len(bulges), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        source, target = (arcs.vertices.take(end, axis=0) for end in arcs.ends[some].T)
        mixed = MixedArcs(source, target, arcs.control[some], arcs.center[some], arcs.sites[some, 0] != OUTSIDE)
        bulges[some] = mixed.areas_beside(source)
    return bulges


def cells_of(rings: Rings, shell: Indices, count: int) -> tuple[NDArray[np.int32], Indices, Indices, Indices]:
    """Put rings into polygons, and polygons into cells: arcs along rings, from 1, and where rows of each begin."""
    is_hole = shell != np.arange(len(shell))
    sorting = np.lexsort((np.arange(len(shell)), is_hole, shell, rings.site[shell]))
    sizes = np.diff(rings.start)[sorting]
    half_edge = rings.half_edge[ranges(rings.start[:-1][sorting], sizes)]
    arc = (half_edge >> 1) + 1
    first = np.flatnonzero(~is_hole[sorting])
    of_site = np.bincount(rings.site[sorting[first]], minlength=count)
    return (
        np.where(half_edge & 1, -arc, arc).astype(np.int32),
        starts_of(sizes),
        np.append(first, len(sorting)),
        starts_of(of_site),
    )


def moved_vertices(arcs: Arcs, rings: Rings) -> Floats:
    """(v, 2) vertices of a map, where the input has them; on rings so thin that they might turn over none is moved."""
    at, xy = arcs.moves
    made = arcs.vertices.copy()
    if not at.size:
        return made
    made[at] = xy
    most = float(norms(xy - arcs.vertices[at]).max())
    size = np.diff(rings.start)
    around = np.add.reduceat(_lengths(arcs)[rings.half_edge >> 1], rings.start[:-1])
    thin = np.flatnonzero(np.abs(rings.area) <= 2 * most * (around + size * most))
    kept = arcs.ends[rings.half_edge[ranges(rings.start[:-1][thin], size[thin])] >> 1]
    made[kept] = arcs.vertices[kept]
    return made


def _lengths(arcs: Arcs) -> Floats:
    """(a,) at least the lengths of arcs."""
    source, target = (arcs.vertices.take(end, axis=0) for end in arcs.ends.T)
    length = norms(target - source)
    bent = np.flatnonzero(~np.isnan(arcs.control[:, 0]))
    control = arcs.control[bent]
    length[bent] = norms(control - source[bent]) + norms(target[bent] - control)
    round_ = np.flatnonzero(~np.isnan(arcs.center[:, 0]))
    length[round_] = 4 * norms(source[round_] - arcs.center[round_])  # at most half a circle
    return length


def shells_of(rings: Rings, arcs: Arcs) -> Indices:
    """(r,) the shell around each hole; of a shell its own number."""
    shell = np.arange(len(rings.site))
    shells, holes = np.flatnonzero(rings.area > 0), np.flatnonzero(~(rings.area > 0))
    if not holes.size:
        return shell
    sorting = shells[np.argsort(rings.part[shells], kind="stable")]
    first = np.searchsorted(rings.part[sorting], rings.part[holes])
    last = np.searchsorted(rings.part[sorting], rings.part[holes], side="right")
    held = last > first
    shell[holes[held]] = sorting[first[held]]
    several = np.flatnonzero(last - first > 1)
    if several.size:
        shell[holes[several]] = _around(holes[several], shells, rings, arcs)
    return shell


def _around(holes: Indices, shells: Indices, rings: Rings, arcs: Arcs) -> Indices:
    """For each hole the smallest shell of its part that lies around it."""
    own = shells[np.isin(rings.part[shells], rings.part[holes])]
    tree = shapely.STRtree([shapely.Polygon(_outline(each, rings, arcs)) for each in own.tolist()])
    inner = np.array([shapely.Polygon(_outline(each, rings, arcs)) for each in holes.tolist()])
    hole, row = tree.query(shapely.point_on_surface(inner), predicate="dwithin", distance=0.0)
    shell = own[row]
    fits = (rings.part[shell] == rings.part[holes[hole]]) & (rings.area[shell] >= -rings.area[holes[hole]])
    hole, shell = hole[fits], shell[fits]
    order = np.lexsort((shell, -rings.area[shell], hole))
    found = np.full(len(holes), -1, dtype=np.int64)
    found[hole[order]] = shell[order]  # the smallest comes last, and stays
    for at in np.flatnonzero(found < 0).tolist():  # as far as doubles tell it lies in none: in the nearest
        alike = np.flatnonzero(rings.part[own] == rings.part[holes[at]])
        found[at] = own[alike[shapely.distance(tree.geometries[alike], inner[at]).argmin()]]
    return found


def _outline(ring: int, rings: Rings, arcs: Arcs) -> NDArray[np.float64]:
    """Places along a ring, close enough to tell what is in it."""
    half_edge = rings.half_edge[rings.start[ring] : rings.start[ring + 1]]
    arc, is_back = half_edge >> 1, (half_edge & 1).astype(bool)
    along = arcs.mixed()[arc].reversed(is_back)
    tolerance = float(np.ptp(np.concatenate([along.source, along.target]), axis=0).max()) * 2.0**-20
    return along.polylines(tolerance)[0]


_MOST_TRIED = 7
"""Ends at one place, of which all orders are tried."""

_NEAR = 2.0**-6
"""Of a right angle, within which two directions may be taken for the other way round where the sites say so."""


_ALONG = (0.5, 0.3125, 0.71875)
"""Of parts of cuts: where a limit only touches one of them, the others tell."""


class CutMap:
    """The arcs of a map, first those of borders, then those along cuts, and whose their sides are."""

    def __init__(self, overlay: Overlay) -> None:
        borders, pieces, cuts = overlay.borders, overlay.pieces, overlay.cuts
        self.count = len(pieces.piece)
        self.ends = np.concatenate([pieces.ends, cuts.ends])
        self.sites = np.concatenate([borders.sites.take(pieces.piece, axis=0), cuts.sites.astype(np.int32)])
        of = borders.parts if overlay.has_parts else borders.sites
        self.parts = np.concatenate([of.take(pieces.piece, axis=0), cuts.sites])
        self.order = np.concatenate([borders.order.take(pieces.piece, axis=0), np.zeros_like(cuts.ends)])
        half = np.flatnonzero(overlay.is_cut[self.ends.ravel()])
        self._put_in_order(overlay, half)
        self.unknown, self.group = self._tell(half)  # sides that no border tells, and which of them are of one face
        self.places, self.given = overlay.places()
        self.radius = overlay.graph.scale * overlay.found.radius
        self.radius[cuts.ends[overlay.edges.is_enclosure[cuts.edge]]] = np.nan
        self.is_cut = overlay.is_cut[:-1]
        control = overlay.control.take(pieces.piece, axis=0)
        control[pieces.whole :] = overlay.found.curves[pieces.row].control(*pieces.t.T)
        self.control, self.center = (
            overlay.graph.coordinates(each) for each in (control, borders.center.take(pieces.piece, axis=0))
        )

    def _put_in_order(self, overlay: Overlay, half: Indices) -> None:
        """Order what leaves places on cuts; half an arc is twice its number, or one more where that is its target."""
        own = half[half < 2 * self.count] >> 1
        regions = np.full((len(half), 2), 0)
        is_border = half < 2 * self.count
        regions[is_border] = overlay.region[overlay.pieces.piece[own]][:, None]
        cut = (half[~is_border] >> 1) - self.count
        sides = overlay.edges.regions[overlay.cuts.edge[cut]]
        hand = half[~is_border] & 1
        rows = np.arange(len(cut))
        regions[~is_border] = np.stack([sides[rows, hand], sides[rows, 1 - hand]], axis=1)
        left = np.column_stack([regions[:, 0], self.sites.ravel()[half]])
        right = np.column_stack([regions[:, 1], self.sites.ravel()[half ^ 1]])
        angle = quarters(_directions(overlay, half, self.count))
        self.order.reshape(-1)[half] = order_around(self.ends.ravel()[half], angle, left, right)

    def _tell(self, half: Indices) -> tuple[Indices, Indices]:
        """Tell sides of cuts by the sides beside them around places; left are those of faces that cuts alone bound."""
        tail = self.ends.ravel()[half]
        around = half[np.lexsort((self.order.ravel()[half], tail))]
        tail = self.ends.ravel()[around]
        starts = np.flatnonzero(np.diff(tail, prepend=-1))
        after = following(np.append(starts, len(around)))
        # on the left of what leaves a place is the face that is on the right of what leaves it next
        side, number = np.unique(np.stack([around, around[after] ^ 1], axis=1), return_inverse=True)
        root = _core.graphs.connected_components(number.reshape(-1, 2).astype(np.int32), len(side))
        site = self.sites.ravel()[side]
        known = np.flatnonzero(site != UNKNOWN)
        told = np.full(len(side), -1)
        told[root[known]] = side[known]
        if (self.sites.ravel()[told[root[known]]] != site[known]).any():
            raise VerificationError(
                "the clip, an enclosure or the frame nearly coincides with a cell border, to within rounding: shift "
                "it slightly"
            )
        unknown = np.flatnonzero(site == UNKNOWN)
        by = told[root[unknown]]
        for each in (self.sites, self.parts):
            each.reshape(-1)[side[unknown]] = np.where(by < 0, UNKNOWN, each.ravel()[by])
        left = unknown[by < 0]
        return side[left], root[left].astype(np.int64)

    def tell(self, sites: Indices | int, parts: Indices | int) -> None:
        """Tell whose the sides are that no border tells."""
        self.sites.reshape(-1)[self.unknown] = sites
        self.parts.reshape(-1)[self.unknown] = parts

    def arcs(self) -> Arcs:
        """Give the arcs between two sites, with vertices and arcs numbered by where they are."""
        count = self.count
        is_kept = np.ones(len(self.ends), dtype=bool)
        is_kept[count:] = self.sites[count:, 0] != self.sites[count:, 1]
        made = self.ends, self.sites, self.parts, self.order
        ends, sites, parts, order = made if is_kept.all() else (each[is_kept] for each in made)
        used = mask_of(ends, len(self.places))
        along = self.ends[count:].ravel()
        along = along[np.sort(np.unique(along, return_index=True)[1])]
        chosen = np.concatenate([np.flatnonzero(used & ~self.is_cut), along[used[along]]])
        number = ranks_of(chosen, len(self.places))
        (x, y), (given_x, given_y) = self.places.T, self.given.T
        at = np.flatnonzero((given_x != x) | (given_y != y))
        at = at[number[at] >= 0]
        moves = number[at], self.given[at]
        straight = np.full((len(ends) - count, 2), np.nan)
        control, center = (np.concatenate([each, straight]) for each in (self.control, self.center))
        ends = number.take(ends)
        turned = ends[:, 0] > ends[:, 1]
        sorting = by_ends(np.where(turned[:, None], ends[:, ::-1], ends), control, center)
        pairs = 2 * sorting[:, None] + (np.arange(2) ^ turned[sorting][:, None])
        ends, sites, parts, order = (each.take(pairs) for each in (ends, sites, parts, order))
        places, radius = self.places.take(chosen, axis=0), self.radius.take(chosen)
        control, center = control.take(sorting, axis=0), center.take(sorting, axis=0)
        is_cut = (sorting >= count) | (sites[:, 0] == OUTSIDE) | (sites[:, 1] == OUTSIDE)
        center = without_lost(center, places, ends, sites[:, 0] != OUTSIDE)
        return Arcs(places, radius, ends, control, center, sites, parts, order, is_cut, moves)


def cut_map(overlay: RegionOverlay) -> CutMap:
    """Put the borders of all regions between the cuts, and tell whose each side of each cut is."""
    made = CutMap(overlay)
    if made.unknown.size:
        sites = _found_by_places(overlay, made.unknown - 2 * made.count, made.group)
        made.tell(sites, sites)
    return made


def _directions(overlay: Overlay, half: Indices, count: int) -> Floats:
    """(h, 2) the directions in which halves of arcs leave their places."""
    borders, pieces, found = overlay.borders, overlay.pieces, overlay.found
    ways = np.empty((len(half), 2))
    is_border, end = half < 2 * count, half & 1
    forward = overlay.edges.forward[overlay.cuts.edge[(half[~is_border] >> 1) - count]]
    ways[~is_border] = np.where(end[~is_border, None] == 0, forward, -forward)
    piece, end = half[is_border] >> 1, end[is_border]
    own = borders.ends[pieces.piece[piece]]
    places = np.concatenate([borders.places, np.full((1, 2), np.nan)])  # that of -1, at infinity
    control = overlay.control[pieces.piece[piece]]
    rows = np.arange(len(piece))
    here, there = places[own[rows, end]], places[own[rows, 1 - end]]
    made = np.where(np.isnan(control), there, control) - here
    bent = np.flatnonzero(piece >= pieces.whole)
    cut = piece[bent] - pieces.whole
    t = pieces.t[cut]
    onward = np.sign(t[:, 1] - t[:, 0]) * np.where(end[bent] == 0, 1, -1)
    at = t[np.arange(len(bent)), end[bent]]
    made[bent] = onward[:, None] * found.curves[pieces.row[cut]].tangent(at)
    ways[is_border] = made
    return ways


def _found_by_places(overlay: RegionOverlay, half: Indices, group: Indices) -> Indices:
    """(k,) the site of sides of cuts in groups, each of a face: nearest to places along most of its length."""
    nearest = NearestElements(overlay.local)
    part = half >> 1
    region = overlay.edges.regions[overlay.cuts.edge[part], half & 1]
    places, length = overlay.places_along(part, _ALONG)
    site = np.empty(places.shape[:2], dtype=np.int64)
    for each in np.unique(region).tolist():
        own = np.flatnonzero(region == each)
        site[own] = nearest.sites(places[own].reshape(-1, 2), each).reshape(len(own), -1)
    faces, face = np.unique(group, return_inverse=True)
    ring = np.repeat(face.reshape(-1), len(_ALONG))
    pairs, row = np.unique(np.stack([ring, site.ravel()], axis=1), axis=0, return_inverse=True)
    total = np.bincount(row.reshape(-1), np.repeat(length, len(_ALONG)), minlength=len(pairs))
    order = np.lexsort((-pairs[:, 1], total, pairs[:, 0]))
    made = np.empty(len(faces), dtype=np.int64)
    made[pairs[order, 0]] = pairs[order, 1]  # the longest comes last, and stays
    return made[face.reshape(-1)]


def quarters(way: Floats) -> Floats:
    """(k,) numbers from 0 to 4 that rise with the angle of directions, by one a right angle."""
    x, y = way.T
    size = np.abs(x) + np.abs(y)
    size = np.where(size > 0, size, 1)
    turned = np.where(y >= 0, 1 - x / size, 3 + x / size)
    return np.where(turned >= 4, 0, turned)


def order_around(tail: Indices, angle: Floats, left: Indices, right: Indices) -> Indices:
    """(h,) numbers that rise counter-clockwise among the ends that leave a place."""
    sorting = np.lexsort((angle, tail))
    starts = np.flatnonzero(np.diff(tail[sorting], prepend=-1))
    sizes = np.diff(starts, append=len(tail))
    order = np.empty(len(tail), dtype=np.int64)
    after = following(np.append(starts, len(tail)))
    thin = _is_thin_inside(angle[sorting], left[sorting], right[sorting], after)
    sorting[thin], sorting[after[thin]] = sorting[after[thin]], sorting[thin]
    order[sorting] = np.arange(len(tail))
    agree = _agree(left[sorting], right[sorting][after])
    for k in np.flatnonzero(np.logical_or.reduceat(~agree, starts)).tolist():
        own = sorting[starts[k] : starts[k] + sizes[k]]
        order[own] = starts[k] + _tried(own, angle, left, right)
    return order


def _is_thin_inside(angle: Floats, left: Indices, right: Indices, after: Indices) -> Indices:
    """List ends of limits with less than a right angle of their cell up to the next end: they come after that one."""
    # A disc around a site touches each limit from inside, so that a cell has at least half a turn between two of them;
    # where discs touch each other, limits leave in one direction, with what is beyond both between them.
    turn = (angle[after] - angle) % 4
    is_border = (left[:, 0] == right[:, 0]) & (left[:, 0] == left[after, 0]) & (left[after, 0] == right[after, 0])
    is_inside = (right[:, 1] == OUTSIDE) & (left[:, 1] >= 0) & (right[after, 1] >= 0) & (left[after, 1] == OUTSIDE)
    return np.flatnonzero(is_border & is_inside & (turn < 1))


def _agree(left: Indices, right: Indices) -> NDArray[np.bool_]:
    known = (left[:, 1] != UNKNOWN) & (right[:, 1] != UNKNOWN)
    return (left[:, 0] == right[:, 0]) & ((left[:, 1] == right[:, 1]) | ~known)


def _tried(own: Indices, angle: Floats, left: Indices, right: Indices) -> Indices:
    """The rank of each of the ends at one place, whose first one stays."""
    count = len(own)
    if count <= _MOST_TRIED:
        for rest in permutations(range(1, count)):
            order = np.array([0, *rest])
            turns = np.diff(angle[own[order]], append=angle[own[0]] + 4)
            turns = (turns + _NEAR) % 4 - _NEAR
            one = own[order]
            after = np.roll(np.arange(count), -1)
            is_thin = _is_thin_inside(angle[one], left[one], right[one], after).size > 0
            if abs(turns.sum() - 4) < 1 and not is_thin and _agree(left[one], right[one][after]).all():
                rank = np.empty(count, dtype=np.int64)
                rank[order] = np.arange(count)
                return rank
    raise VerificationError(
        "the clip, an enclosure or the frame coincides with a cell border to within rounding: shift it slightly"
    )
