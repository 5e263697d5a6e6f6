"""Borders in pieces between cuts, and cuts in pieces between borders."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.voronoi.borders import Borders, sites_beside_segments
from vorotool.engines.voronoi.crossings import Crossings, crossings_of
from vorotool.engines.voronoi.cut_curves import NOBODY, SLACK, CutEdges, controls_of
from vorotool.engines.voronoi.regions import LocalDiagrams, faces_of_sides
from vorotool.numeric.arrays import Floats, Indices, owners, ranges
from vorotool.numeric.numbers import rows_of
from vorotool.plain import plain
from vorotool.types.polygons.planar_graph import PlanarGraph, packed
from vorotool.types.voronoi.voronoi_map import OUTSIDE

UNKNOWN = -2
"""The site of what is not known yet."""


@plain(eq=False)
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


@plain(eq=False)
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
    sites = np.where(edges.regions[edge] == NOBODY, OUTSIDE, UNKNOWN)
    return CutPieces(edge, np.stack([nodes[is_next], nodes[is_next + 1]], axis=1), sites)


class Overlay:
    """Parts of borders and of cuts put together: those of borders that are within what is cut, and not along it."""

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
        self.cuts = cut_pieces(edges, found, self.count, self.is_cut)

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
        import shapely

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
        reaches = np.zeros(groups, dtype=bool)
        reaches[group[(pieces.ends < 0).any(axis=1)]] = True
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
        length[bent] = _norm(curves.place(t[:, 1]) - curves.place(t[:, 0]))
        plain = np.flatnonzero((pieces.ends[: pieces.whole] >= 0).all(axis=1))
        a, b = (places[node] for node in pieces.ends[plain].T)
        control = self.control[pieces.piece[plain]]
        control = np.where(np.isnan(control), (a + b) / 2, control)
        middle[plain] = (a + 2 * control + b) / 4
        length[plain] = _norm(b - a)
        return middle, length


def _rows_of(pairs: Indices, wanted: Indices) -> Indices:
    """(k,) the row that each pair has among others, either way round; -1 where it is none of them."""
    values, number = np.unique(np.concatenate([pairs, wanted]), return_inverse=True)
    low, high = np.sort(number.reshape(-1, 2), axis=1).T
    key = low * len(values) + high
    return rows_of(key[: len(pairs)], key[len(pairs) :])


def _norm(way: Floats) -> Floats:
    return np.sqrt((way * way).sum(axis=1))
