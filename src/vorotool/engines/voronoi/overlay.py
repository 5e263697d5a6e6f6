"""Borders in pieces between cuts, and cuts in pieces between borders."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.voronoi.borders import Borders, sites_beside_segments
from vorotool.engines.voronoi.crossings import Crossings, Drawn, crossings_between, crossings_of
from vorotool.engines.voronoi.cut_curves import NO_REGION, SLACK, CutEdges, controls_of, cut_curves
from vorotool.engines.voronoi.regions import LocalDiagrams, faces_of_sides
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices, mask_of, norms, owners, ranges
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import rows_of
from vorotool.types.box import Extent, corners_of
from vorotool.types.polygons.planar_graph import PlanarGraph, packed
from vorotool.types.voronoi.voronoi_map import OUTSIDE

UNKNOWN = -2
"""The site of what is not known yet."""


@frozen(eq=False)
class Pieces:
    """Parts of borders between places: first those that are whole, then those of `Crossings.pieces`."""

    piece: Indices  # (k,) int64 array: of the borders
    ends: Indices  # (k, 2) int64 array: source and target; -1 at infinity
    row: Indices  # (c,) int64 array: of `Crossings.pieces`, of the last ones
    t: Floats  # (c, 2) float64 array: parameters of their ends

    @property
    def whole(self) -> int:
        """How many are whole."""
        return len(self.piece) - len(self.row)

    def __getitem__(self, chosen: Indices) -> Pieces:
        """Some of them, ascending."""
        cut = chosen[np.searchsorted(chosen, self.whole) :] - self.whole
        return Pieces(self.piece.take(chosen), self.ends.take(chosen, axis=0), self.row[cut], self.t[cut])


@frozen(eq=False)
class CutPieces:
    """Parts of cut edges between places."""

    edge: Indices  # (k,) int64 array: that each is a part of
    ends: Indices  # (k, 2) int64 array: source and target, along it
    # (k, 2) int64 array: left and right, where walls and borders along them tell; `OUTSIDE` where nobody has it, else
    # `UNKNOWN`
    sites: Indices


def pieces_between(borders: Borders, found: Crossings, whole: NDArray[np.bool_]) -> Pieces:
    """Cut borders at all places where they meet cuts, but for whole ones; what has no length is left out."""
    node = np.append(found.node, -1)  # that of -1, at infinity
    kept = np.flatnonzero(whole)
    ends = node.take(borders.ends.take(kept, axis=0))
    is_long = (ends[:, 0] != ends[:, 1]) | (ends[:, 0] < 0)
    if not is_long.all():
        kept, ends = kept[is_long], ends[is_long]
    source, target = node[borders.ends[found.pieces]].T
    row, curves = np.arange(len(found.pieces)), found.curves
    rows = np.concatenate([row, found.stop_row, row])
    nodes = np.concatenate([source, found.stop_node, target])
    t = np.concatenate([curves.first, found.stop_t, curves.last])
    rank = np.concatenate([np.zeros(len(row)), np.ones(len(found.stop_row)), np.full(len(row), 2)])
    forward = np.where(curves.first <= curves.last, 1.0, -1.0)
    order = np.lexsort((forward[rows] * t, rank, rows))
    rows, nodes, t = rows[order], nodes[order], t[order]
    is_next = np.flatnonzero(rows[1:] == rows[:-1])
    a, b = nodes[is_next], nodes[is_next + 1]
    is_next = is_next[(a != b) | (a < 0)]
    parts = np.stack([nodes[is_next], nodes[is_next + 1]], axis=1)
    return Pieces(
        np.concatenate([kept, found.pieces[rows[is_next]]]),
        np.concatenate([ends, parts]),
        rows[is_next],
        np.stack([t[is_next], t[is_next + 1]], axis=1),
    )


def cut_pieces(edges: CutEdges, found: Crossings, count: int, is_cut: NDArray[np.bool_]) -> CutPieces:
    """Divide cut edges at places inside."""
    number = np.arange(len(edges.ends))
    inner = np.flatnonzero(is_cut[:-1] & (found.edge >= 0))
    edge = np.concatenate([number, found.edge[inner], number])
    nodes = np.concatenate([count + edges.ends[:, 0], inner, count + edges.ends[:, 1]])
    far = np.concatenate([np.full(len(number), -np.inf), found.far[inner], np.full(len(number), np.inf)])
    order = np.lexsort((far, edge))
    edge, nodes = edge[order], nodes[order]
    is_next = np.flatnonzero(edge[1:] == edge[:-1])
    edge = edge[is_next]
    sites = np.where(edges.regions[edge] == NO_REGION, OUTSIDE, UNKNOWN)
    return CutPieces(edge, np.stack([nodes[is_next], nodes[is_next + 1]], axis=1), sites)


class Overlay:
    """Parts of borders and of cuts put together: those of borders that are within what is cut, and not along it."""

    cuts: CutPieces
    has_parts = False
    """Whether parts of cells are those of the borders; else what a site has is one part."""

    def __init__(
        self, borders: Borders, graph: PlanarGraph, edges: CutEdges, region: Indices, control: Floats, found: Crossings
    ) -> None:
        self.borders, self.graph, self.edges, self.found = borders, graph, edges, found
        self.region = region  # (b,) of each border
        self.control = control  # (b, 2) of each border, on the lattice
        self.count = len(borders.places)
        # (v + 1,) whether places are on cuts, the last one of -1, at infinity
        self.is_cut = np.append((found.edge >= 0) & (found.node == np.arange(len(found.node))), False)
        self.is_cut[self.count : self.count + len(edges.points)] = True

    def put(self, pieces: Pieces) -> None:
        """Take parts of borders; with those that cuts run along these are told whose their sides are."""
        along = self._along(pieces)
        self._tell_borders(pieces, along)
        kept = self._is_kept(pieces) & (along < 0)
        self.pieces = pieces if kept.all() else pieces[np.flatnonzero(kept)]

    def end_radii(self) -> Floats:
        """(k, 2) distances of the ends of parts from the sites of their borders, on the lattice."""
        pieces, borders = self.pieces, self.borders
        made: Floats = np.append(borders.radius, np.inf)[borders.ends.take(pieces.piece, axis=0)]  # of -1, at infinity
        for end, t in enumerate(pieces.t.T):
            made[pieces.whole :, end] = self.found.curves[pieces.row].radius(t)
        return made

    def places(self) -> tuple[Floats, Floats]:
        """(v, 2) where all places are in input units, and where the input has them, by its vertices."""
        raise NotImplementedError

    def _is_kept(self, pieces: Pieces) -> NDArray[np.bool_]:
        raise NotImplementedError

    # ---- what lies along cuts ---------------------------------------------------------------------------
    def _along(self, pieces: Pieces) -> Indices:
        """(k,) the cut edge that a part of a border runs along; -1 where it does not."""
        edge = np.full(len(pieces.piece), -1, dtype=np.int64)
        both = np.flatnonzero(self.is_cut[pieces.ends].all(axis=1))
        if both.size:
            edge[both] = self._edge_of(pieces[both])
        return edge

    def _edge_of(self, pieces: Pieces) -> Indices:
        """(k,) the same of parts between places on cuts."""
        found, ends = self.found, self.edges.ends
        is_straight = np.ones(len(pieces.piece), dtype=bool)
        is_finite: NDArray[np.bool_] = np.logical_and(*np.isfinite(pieces.t).T)
        t = np.where(is_finite[:, None], pieces.t, 0)
        is_straight[pieces.whole :] = is_finite & (found.curves[pieces.row].depth(*t.T) <= SLACK)
        on, corner = found.edge[pieces.ends], pieces.ends - self.count  # of an end of an edge, else another number
        edge = np.full(len(on), -1, dtype=np.int64)
        for one, other in ((0, 1), (1, 0)):
            own = on[:, one]
            is_end = (on[:, other] < 0) & (corner[:, other, None] == ends[own]).any(axis=1)
            hit = (own >= 0) & ((on[:, other] == own) | is_end)
            edge[hit] = own[hit]
        both = np.flatnonzero((on < 0).all(axis=1))
        edge[both] = _rows_of(ends, corner[both])
        is_beside = (self.edges.regions[edge] == self.region[pieces.piece][:, None]).any(axis=1)
        return np.where(is_straight & is_beside, edge, -1)

    def _far(self, node: Indices, edge: Indices) -> Floats:
        """How far along an edge a place on it is."""
        is_inner = self.found.edge[node] == edge
        is_source = node == self.count + self.edges.ends[edge, 0]
        return np.where(is_inner, self.found.far[node], np.where(is_source, 0, self.edges.length[edge]))

    def _tell_borders(self, pieces: Pieces, along: Indices) -> None:
        """Note the sites beside cuts that borders run along."""
        chosen = np.flatnonzero(along >= 0)
        if not chosen.size:
            return
        edge = along[chosen]
        first, last = (self._far(node, edge) for node in pieces.ends[chosen].T)
        piece = pieces.piece[chosen]
        sites, region = self.borders.sites[piece], self.region[piece]
        cuts = self.cuts
        start = np.searchsorted(cuts.edge, np.arange(len(self.edges.ends) + 1))
        sizes = start[edge + 1] - start[edge]
        row = owners(sizes)
        part = ranges(start[edge], sizes)
        middle = (self._far(cuts.ends[part, 0], edge[row]) + self._far(cuts.ends[part, 1], edge[row])) / 2
        held = (middle > np.minimum(first, last)[row]) & (middle < np.maximum(first, last)[row])
        row, part = row[held], part[held]
        turned = first[row] > last[row]
        for hand in (0, 1):
            own = (self.edges.regions[edge[row], hand] == region[row]) & (cuts.sites[part, hand] == UNKNOWN)
            told = np.where(turned, sites[row, 1 - hand], sites[row, hand])
            # of two limits with a strip beyond both between them that with a cell on this side is nearer to the region
            np.maximum.at(cuts.sites, (part[own], hand), told[own])

    def places_along(self, part: Indices, shares: tuple[float, ...]) -> tuple[Floats, Floats]:
        """Give places along parts of cuts, on the lattice, and the lengths of the parts."""
        edge = self.cuts.edge[part]
        first, last = (self._far(node, edge) for node in self.cuts.ends[part].T)
        far = first[:, None] + (last - first)[:, None] * np.array(shares)
        source, target = self.edges.lines[edge].swapaxes(0, 1)
        along = far / self.edges.length[edge, None]
        places: Floats = source[:, None] + along[..., None] * (target - source)[:, None]
        return places, last - first


class RegionOverlay(Overlay):
    """The same between regions, whose sides are on the lattice of the sites."""

    def __init__(self, local: LocalDiagrams, edges: CutEdges, joint: PlanarGraph) -> None:
        borders, graph = local.borders, local.owned.graph
        found = crossings_of(local, edges)
        super().__init__(borders, graph, edges, local.region, controls_of(borders, graph), found)
        self.local, self.joint = local, joint
        self.cuts = cut_pieces(edges, found, self.count, self.is_cut)
        self._tell_walls()
        whole = np.ones(len(borders.ends), dtype=bool)
        whole[found.pieces] = False
        self.put(pieces_between(borders, found, whole))

    def places(self) -> tuple[Floats, Floats]:
        """(v, 2) places in input units, and as given, those on cuts between ends that are."""
        borders, edges = self.borders, self.edges
        return (
            self._placed(self.graph.coordinates(borders.places).reshape(-1, 2), edges.places),
            self._placed(self.joint.places_as_given(borders.places), edges.given),
        )

    def _placed(self, of_borders: Floats, of_cuts: Floats) -> Floats:
        """Places of borders, of ends of cut edges, and of what is between these."""
        found = self.found
        inner = np.flatnonzero(found.edge >= 0)
        places = np.full((len(found.node), 2), np.nan)
        places[: self.count] = of_borders
        places[self.count : self.count + len(of_cuts)] = of_cuts
        places[inner] = self.edges.place(of_cuts[self.edges.ends], found.edge[inner], found.far[inner])
        return places

    def _tell_walls(self) -> None:
        """Note the sites beside cuts that are walls."""
        local, edges = self.local, self.edges
        graph = local.owned.graph
        if not len(graph):
            return
        row = _rows_of(packed(edges.points)[edges.ends], packed(graph.points)[graph.segments])
        chosen = np.flatnonzero(row >= 0)
        edge = row[chosen]
        sites = sites_beside_segments(local.owned)
        same = (graph.points[graph.segments[chosen, 0]] == edges.points[edges.ends[edge, 0]]).all(axis=1)
        told = np.full((len(edges.ends), 2), UNKNOWN, dtype=np.int64)
        for hand in (0, 1):
            own = edges.regions[edge, hand] == local.segment_region[chosen]
            told[edge[own], hand] = np.where(same, sites[chosen, hand], sites[chosen, 1 - hand])[own]
        self.cuts.sites[:] = np.where(self.cuts.sites == UNKNOWN, told[self.cuts.edge], self.cuts.sites)

    # ---- what lies in its region ------------------------------------------------------------------------
    def _is_kept(self, pieces: Pieces) -> NDArray[np.bool_]:
        """Whether parts of borders are in their region: all that hangs together between cuts is, or is not."""
        count, nodes = len(pieces.piece), len(self.found.node)
        is_cut = self.is_cut.copy()
        is_cut[-1] = True  # at infinity
        piece, end = np.nonzero(~is_cut[pieces.ends])
        pairs = np.stack([piece, count + pieces.ends[piece, end]], axis=1)
        root = _core.graphs.connected_components(pairs.astype(np.int32), count + nodes)[:count]
        _, group = np.unique(root, return_inverse=True)
        group = group.reshape(-1)
        groups = int(group.max(initial=-1)) + 1
        middle, length = self._middles(pieces)
        reaches = mask_of(group[(pieces.ends < 0).any(axis=1)], groups)
        order = np.lexsort((length, group))
        longest = order[np.append(np.diff(group[order]) > 0, True)] if count else order
        names, shapes = faces_of_sides(self.edges.lines, self.edges.regions)
        at = longest[~reaches[group[longest]]]
        row, place = shapely.STRtree(shapely.points(middle[at])).query(shapes, predicate="intersects")
        inside = np.zeros(groups, dtype=bool)
        held = names[row] == self.region[pieces.piece[at[place]]]
        inside[group[at[place[held]]]] = True
        return inside[group]

    def _middles(self, pieces: Pieces) -> tuple[Floats, Floats]:
        """Places in the middle of parts of borders, and how far their ends are apart."""
        places = self.found.place
        middle, length = np.zeros((len(pieces.piece), 2)), np.zeros(len(pieces.piece))
        curves, bent = self.found.curves[pieces.row], slice(pieces.whole, None)
        t = np.where(np.isfinite(pieces.t), pieces.t, 0)
        middle[bent] = curves.place(t.mean(axis=1))
        length[bent] = norms(curves.place(t[:, 1]) - curves.place(t[:, 0]))
        plain = np.flatnonzero((pieces.ends[: pieces.whole] >= 0).all(axis=1))
        a, b = (places[node] for node in pieces.ends[plain].T)
        control = self.control[pieces.piece[plain]]
        control = np.where(np.isnan(control), (a + b) / 2, control)
        middle[plain] = (a + 2 * control + b) / 4
        length[plain] = norms(b - a)
        return middle, length


def _rows_of(pairs: Indices, wanted: Indices) -> Indices:
    """(k,) the row that each pair has among others, either way round; -1 where it is none of them."""
    values, number = np.unique(np.concatenate([pairs, wanted]), return_inverse=True)
    low, high = np.sort(number.reshape(-1, 2), axis=1).T
    key = low * len(values) + high
    return rows_of(key[: len(pairs)], key[len(pairs) :])


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
        regions = np.tile([0, NO_REGION], (SIDES, 1))
        none = np.zeros(SIDES, dtype=bool)
        return CutEdges(self.on_lattice, self.corners, self.corners, ends, regions, none, self.scale)

    def is_inside(self, places: Floats) -> NDArray[np.bool_]:
        """(n,) whether places in input units are strictly inside."""
        return _are_within(places, self.low, self.high)

    def side_of(self, places: Floats, rounded: Floats, is_site: NDArray[np.bool_], slack: Floats) -> Indices:
        """(n,) the side that places are at: nearly on the lattice, sites exactly in input units; -1 of others."""
        hits = np.empty((SIDES, len(places)), dtype=bool)
        is_free = ~is_site
        for number, hit in enumerate(hits):
            axis = 1 - number % 2
            near = np.abs(rounded[:, axis] - self.on_lattice[number, axis]) <= slack[number]
            np.logical_or(near & is_free, places[:, axis] == self.corners[number, axis], out=hit)
        side = np.full(len(places), -1, dtype=np.int64)
        at = np.flatnonzero(hits.any(axis=0))
        bottom, right, top, left = hits[:, at]
        for number, hit in enumerate((bottom & ~right, right & ~top, top & ~left, left & ~bottom)):
            side[at[hit]] = number
        (x, y), (low_x, low_y), (high_x, high_y) = places[at].T, self.low, self.high
        is_out = ((x < low_x) & ~left) | ((x > high_x) & ~right) | ((y < low_y) & ~bottom) | ((y > high_y) & ~top)
        side[at[is_out]] = -1
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
        if np.isfinite(borders.level):
            _extend_to_circles(low, high, graph.coordinates(borders.center[some]), borders.level * graph.scale)
        (low_x, low_y), (high_x, high_y) = low.T, high.T
        (left, bottom), (right, top) = box.low, box.high
        is_within = is_finite & (low_x >= left) & (low_y >= bottom) & (high_x <= right) & (high_y <= top)
        is_off = is_finite & ~((low_x < right) & (low_y < top) & (high_x > left) & (high_y > bottom))
        state[some] = np.where(is_off, _OFF, np.where(is_within, _WITHIN, _CROSSING))
    return state


def _extend_to_circles(low: Floats, high: Floats, center: Floats, radius: float) -> None:
    """Add what circular arcs, counter-clockwise and of at most half a circle, reach beyond their ends."""
    arc = np.flatnonzero(~np.isnan(center[:, 0]))
    low[arc], high[arc] = np.minimum(low[arc], center[arc] - radius), np.maximum(high[arc], center[arc] + radius)


def _are_within(places: Floats, low: Floats, high: Floats) -> NDArray[np.bool_]:
    """(n,) whether places are between two corners, and not on a side: NumPy is slow along short rows."""
    x, y = places.T
    return (x > low[0]) & (y > low[1]) & (x < high[0]) & (y < high[1])


def _all_of(pairs: NDArray[np.bool_]) -> NDArray[np.bool_]:
    return pairs[:, 0] & pairs[:, 1]
