"""The planar map of borders and cuts: whose each side of a cut is, by what is beside it where both meet."""

from __future__ import annotations

from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.voronoi.assembly import Arcs, by_ends, without_lost
from vorotool.engines.voronoi.nearest import NearestElements
from vorotool.engines.voronoi.overlay import UNKNOWN, Overlay, RegionOverlay
from vorotool.errors import VerificationError
from vorotool.numeric.arrays import Floats, Indices, following
from vorotool.types.voronoi.voronoi_map import OUTSIDE

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
        used = np.zeros(len(self.places), dtype=bool)
        used[ends] = True
        along = self.ends[count:].ravel()
        along = along[np.sort(np.unique(along, return_index=True)[1])]
        chosen = np.concatenate([np.flatnonzero(used & ~self.is_cut), along[used[along]]])
        number = np.full(len(self.places), -1, dtype=np.int64)
        number[chosen] = np.arange(len(chosen))
        at = np.flatnonzero((self.given != self.places).any(axis=1))
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
        is_cut = (sorting >= count) | (sites == OUTSIDE).any(axis=1)
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
