"""A frame as what borders are cut by: their boxes tell of most whether they are in it, off it, or cross it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.borders import Borders
from vorotool.engines.voronoi.crossings import Drawn, crossings_between
from vorotool.engines.voronoi.cut_curves import NOBODY, CutEdges, controls_of, cut_curves
from vorotool.engines.voronoi.overlay import Overlay, Pieces, cut_pieces, pieces_between
from vorotool.numeric.arrays import Floats, Indices
from vorotool.types.box import Extent, corners_of
from vorotool.types.polygons.planar_graph import PlanarGraph

SIDES = 4
"""Of a frame, counter-clockwise: least y, most x, most y, least x."""

_WITHIN, _OFF, _CROSSING = range(3)

_AT_ONCE = 2**18
"""Pieces that are looked at together, so that what is only compared takes little memory."""

_FARTHEST = 2.0**500
"""Coordinates on the lattice that the frame's are cut to: that of a single place is finer than anything."""


class FrameBox:
    """A frame in input units, and on the lattice."""

    def __init__(self, frame: Extent, graph: PlanarGraph) -> None:
        self.corners = corners_of(frame)
        self.low, self.high, self.scale = self.corners[0], self.corners[2], graph.scale
        with np.errstate(over="ignore"):
            on_lattice = (self.corners - np.array(graph.origin)) / graph.scale
        self.on_lattice = on_lattice.clip(-_FARTHEST, _FARTHEST)

    def edges(self) -> CutEdges:
        """Its sides, the only region on their left."""
        ends = np.stack([np.arange(SIDES), np.roll(np.arange(SIDES), -1)], axis=1)
        regions = np.tile([0, NOBODY], (SIDES, 1))
        none = np.zeros(SIDES, dtype=bool)
        return CutEdges(self.on_lattice, self.corners, self.corners, ends, regions, none, self.scale)

    def is_inside(self, places: Floats) -> NDArray[np.bool_]:
        """(n,) whether places in input units are strictly inside."""
        return _all_of(places > self.low) & _all_of(places < self.high)

    def side_of(self, places: Floats, rounded: Floats, is_site: NDArray[np.bool_], slack: Floats) -> Indices:
        """(n,) the side that places are at: nearly on the lattice, sites exactly in input units; -1 of others."""
        hits = []
        for number in range(SIDES):
            axis = 1 - number % 2
            near = np.abs(rounded[:, axis] - self.on_lattice[number, axis]) <= slack[number]
            hits.append((near & ~is_site) | (places[:, axis] == self.corners[number, axis]))
        bottom, right, top, left = hits
        side = np.full(len(places), -1, dtype=np.int64)
        for number, hit in enumerate((bottom & ~right, right & ~top, top & ~left, left & ~bottom)):
            side[hit] = number
        (x, y), (low_x, low_y), (high_x, high_y) = places.T, self.low, self.high
        is_out = ((x < low_x) & ~left) | ((x > high_x) & ~right) | ((y < low_y) & ~bottom) | ((y > high_y) & ~top)
        side[is_out] = -1
        return side


class FrameOverlay(Overlay):
    """Borders in a frame, and its sides, in pieces between each other."""

    has_parts = True

    def __init__(self, borders: Borders, graph: PlanarGraph, frame: Extent) -> None:
        self.box = box = FrameBox(frame, graph)
        edges = box.edges()
        places = graph.coordinates(borders.places).reshape(-1, 2)
        at = np.flatnonzero(borders.radius == 0)
        given = graph.places_as_given(borders.places[at])
        on_side = _all_of((given >= box.low) & (given <= box.high)) & ~box.is_inside(given)
        places[at[on_side]] = given[on_side]  # the lattice may have them beside it
        side = box.side_of(places, borders.places, borders.radius == 0, edges.slack)
        drawn = _drawn(box, borders, places, side, edges)
        control = controls_of(borders, graph)
        state = _states(borders, places, graph, control, box)
        is_drawn = np.append(side >= 0, False)
        rows = np.flatnonzero((state == _CROSSING) | ((state == _WITHIN) & is_drawn[borders.ends].any(axis=1)))
        crossing = np.flatnonzero(state[rows] == _CROSSING)
        pairs = np.repeat(crossing, SIDES), np.tile(np.arange(SIDES), len(crossing))
        found = crossings_between(borders, edges, drawn, rows, cut_curves(borders, graph, rows), pairs)
        super().__init__(borders, graph, edges, np.broadcast_to(np.int64(0), len(borders.ends)), control, found)
        state[rows] = _CROSSING
        self.of_places, self.given = places, (at, given)
        self.put(pieces_between(borders, found, state == _WITHIN))
        self._leave_out_unused()

    def _leave_out_unused(self) -> None:
        """Leave sides whole where nothing ends that is kept."""
        used = np.zeros_like(self.is_cut)
        used[self.pieces.ends] = True
        corners = slice(self.count, self.count + SIDES)
        self.found.radius[corners] = np.where(used[corners], self.found.radius[corners], np.nan)
        self.is_cut &= used
        self.is_cut[corners] = True
        self.cuts = cut_pieces(self.edges, self.found, self.count, self.is_cut)

    def places(self) -> tuple[Floats, Floats]:
        """(v, 2) places in input units, those on sides exactly there, and vertices of sites as given."""
        box, found, count = self.box, self.found, self.count
        places = self.graph.coordinates(found.place).reshape(-1, 2)
        places[:count] = self.of_places
        places[count : count + SIDES] = box.corners
        inner = np.flatnonzero(found.edge >= 0)
        side = found.edge[inner]
        places[inner] = places[inner].clip(box.low, box.high)
        axis = 1 - side % 2
        places[inner, axis] = box.corners[side, axis]
        moved, (at, given) = places.copy(), self.given
        is_moved = box.is_inside(places[at]) & box.is_inside(given)
        moved[at[is_moved]] = given[is_moved]
        return places, moved

    def _tell_borders(self, pieces: Pieces, along: Indices) -> None:
        """Leave out what is along a side: borders that end there tell whose that is."""

    def _is_kept(self, pieces: Pieces) -> NDArray[np.bool_]:
        """Whether parts of borders are in the frame: they end inside, or their middle is there."""
        kept = np.ones(len(pieces.piece), dtype=bool)
        ends, first = pieces.ends[pieces.whole :], pieces.whole
        place = np.append(self.of_places, [[np.nan, np.nan]], axis=0)  # of what is no place of a border, none
        is_in = self.box.is_inside(place[np.where(ends < self.count, ends, -1)].reshape(-1, 2)).reshape(-1, 2)
        kept[first:] = (is_in & ~self.is_cut[ends]).any(axis=1)
        at = np.flatnonzero(~kept[first:] & self.is_cut[ends].all(axis=1))
        middle = self.found.curves[pieces.row[at]].place(pieces.t[at].mean(axis=1))
        low, high = self.box.on_lattice[[0, 2]]
        kept[first + at] = _all_of((middle > low) & (middle < high))
        return kept


def _drawn(box: FrameBox, borders: Borders, places: Floats, side: Indices, edges: CutEdges) -> Drawn:
    """Note the places of borders that are on sides of a frame, or at its corners."""
    count = len(places)
    drawn = Drawn.nowhere(count + SIDES)
    at = np.flatnonzero(side >= 0)
    far = edges.along(side[at], borders.places[at])
    drawn.edge[at], drawn.far[at] = side[at], far
    near = (np.abs(borders.places[at] - box.on_lattice[side[at]]) <= edges.end_slack[side[at], :1]).all(axis=1)
    corner = at[(places[at] == box.corners[side[at]]).all(axis=1) | (near & (borders.radius[at] > 0))]
    drawn.node[corner], drawn.edge[corner] = count + side[corner], -1
    return drawn


def _states(borders: Borders, places: Floats, graph: PlanarGraph, control: Floats, box: FrameBox) -> NDArray[np.int8]:
    """Whether pieces are within a box, off it, or cross it, as far as the triangles tell that they lie in."""
    state = np.empty(len(borders.ends), dtype=np.int8)
    padded = np.concatenate([places, [[np.nan, np.nan]]])  # that of -1, at infinity
    for first in range(0, len(state), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        source, target = borders.ends[some].T
        is_finite = (source >= 0) & (target >= 0)
        corners = [padded.take(source, axis=0), padded.take(target, axis=0), graph.coordinates(control[some])]
        corners[2] = np.where(np.isnan(corners[2]), corners[0], corners[2])
        a, b, c = corners
        low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
        _extend_to_circles(low, high, graph.coordinates(borders.center[some]), borders.level * graph.scale)
        is_within = is_finite & _all_of(low >= box.low) & _all_of(high <= box.high)
        is_off = is_finite & ~(_all_of(low < box.high) & _all_of(high > box.low))
        state[some] = np.where(is_off, _OFF, np.where(is_within, _WITHIN, _CROSSING))
    return state


def _extend_to_circles(low: Floats, high: Floats, center: Floats, radius: float) -> None:
    """Add what circular arcs, counter-clockwise and of at most half a circle, reach beyond their ends."""
    arc = np.flatnonzero(~np.isnan(center[:, 0]))
    low[arc], high[arc] = np.minimum(low[arc], center[arc] - radius), np.maximum(high[arc], center[arc] + radius)


def _all_of(pairs: NDArray[np.bool_]) -> NDArray[np.bool_]:
    return pairs[:, 0] & pairs[:, 1]
