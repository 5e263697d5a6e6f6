"""The planar map of borders and cuts: arcs with the site on each side, and the rings of cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.around_places import order_around, quarters
from vorotool.engines.voronoi.assembly import Arcs, Rings, by_ends, cycles_of, rings_of, without_lost
from vorotool.engines.voronoi.crossings import crossings_of
from vorotool.engines.voronoi.curves import controls_of
from vorotool.engines.voronoi.local_diagrams import LocalDiagrams
from vorotool.engines.voronoi.moves import Moves
from vorotool.engines.voronoi.nearest_elements import NearestElements
from vorotool.engines.voronoi.overlay import UNKNOWN, Overlay
from vorotool.engines.voronoi.regions import CutEdges
from vorotool.errors import VerificationError
from vorotool.numeric.ragged import owners
from vorotool.plain import plain
from vorotool.types.box import Extent
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.voronoi.voronoi_map import OUTSIDE

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


_ALONG = (0.5, 0.3125, 0.71875)
"""Of parts of cuts: where a limit only touches one of them, the others tell."""


@plain(eq=False)
class CutMap:
    """Cells between borders and cuts."""

    arcs: Arcs  # those inside regions and those along cuts; a part is a site
    is_cut: NDArray[np.bool_]  # (a,) bool array: whether each is along a cut
    rings: Rings
    frame: Extent  # bounds of what is shared out


def cut_map(local: LocalDiagrams, edges: CutEdges, joint: PlanarGraph, frame: Extent) -> CutMap:
    """Put the borders of all regions between the cuts, and tell whose each side of each cut is."""
    overlay = Overlay(local, edges, crossings_of(local, edges))
    sites, order = _sites_and_order(overlay)
    arcs = _with_all_sites(overlay, joint, sites, order)
    count = len(overlay.pieces.piece)
    is_cut = (np.arange(len(arcs.ends)) >= count) | (arcs.sites == OUTSIDE).any(axis=1)
    kept = np.flatnonzero(arcs.sites[:, 0] != arcs.sites[:, 1])
    made, sorting = _numbered(arcs, kept, overlay)
    return CutMap(made, is_cut[kept][sorting], rings_of(made), frame)


def _ends_of(overlay: Overlay) -> Indices:
    return np.concatenate([overlay.pieces.ends, overlay.cuts.ends])


def _sites_and_order(overlay: Overlay) -> tuple[Indices, Indices]:
    """(a, 2) sites, not all known, and the order around source and target."""
    borders, pieces, cuts = overlay.local.borders, overlay.pieces, overlay.cuts
    sites = np.concatenate([borders.sites[pieces.piece].astype(np.int64), cuts.sites])
    order = np.concatenate([borders.order[pieces.piece], np.zeros_like(cuts.ends)])
    is_cut = np.zeros(len(overlay.found.node), dtype=bool)
    is_cut[cuts.ends] = True
    ends = _ends_of(overlay)
    half = np.flatnonzero(is_cut[ends.ravel()])
    own = overlay.region[pieces.piece][:, None]
    regions = np.concatenate([np.repeat(own, 2, axis=1), overlay.edges.regions[cuts.edge]])
    left = np.column_stack([regions.ravel()[half], sites.ravel()[half]])
    right = np.column_stack([regions.ravel()[half ^ 1], sites.ravel()[half ^ 1]])
    order.reshape(-1)[half] = order_around(ends.ravel()[half], quarters(_directions(overlay))[half], left, right)
    return sites, order


def _directions(overlay: Overlay) -> Floats:
    """(2 a, 2) the directions in which arcs leave source and target."""
    borders, pieces, found = overlay.local.borders, overlay.pieces, overlay.found
    own = borders.ends[pieces.piece]
    places = np.concatenate([borders.places, np.full((1, 2), np.nan)])  # that of -1, at infinity
    control = controls_of(borders, overlay.local.owned.graph)[pieces.piece]
    ways = np.zeros((len(own), 2, 2))
    for end in (0, 1):
        here, there = places[own[:, end]], places[own[:, 1 - end]]
        ways[:, end] = np.where(np.isnan(control), there, control) - here
    bent = np.flatnonzero(pieces.row >= 0)
    curves, t = found.curves[pieces.row[bent]], pieces.t[bent]
    forward = np.sign(t[:, 1] - t[:, 0])[:, None]
    ways[bent, 0] = forward * curves.tangent(t[:, 0])
    ways[bent, 1] = -forward * curves.tangent(t[:, 1])
    along = overlay.lines.forward[overlay.cuts.edge]
    return np.concatenate([ways.reshape(-1, 2), np.stack([along, -along], axis=1).reshape(-1, 2)])


def _places(overlay: Overlay) -> tuple[Floats, Floats]:
    """Of all places where they are in input units, and their distances from sites."""
    found, graph = overlay.found, overlay.local.owned.graph
    places = _placed(overlay, graph.coordinates(overlay.local.borders.places).reshape(-1, 2), overlay.edges.places)
    radius = graph.scale * found.radius
    enclosure = overlay.edges.is_enclosure[overlay.cuts.edge]
    radius[overlay.cuts.ends[enclosure]] = np.nan
    return places, radius


def _placed(overlay: Overlay, of_borders: Floats, of_cuts: Floats) -> Floats:
    """Places of borders, of ends of cut edges, and of what is between these."""
    found, count = overlay.found, overlay.count
    inner = np.flatnonzero(found.edge >= 0)
    places = np.full((len(found.node), 2), np.nan)
    places[:count] = of_borders
    places[count : count + len(of_cuts)] = of_cuts
    places[inner] = overlay.lines.place(of_cuts[overlay.edges.ends], found.edge[inner], found.far[inner])
    return places


def _moves(overlay: Overlay, graph: PlanarGraph, places: Floats) -> Moves:
    """Of places at vertices of the input, of sites and of cuts, and of those on cuts between them."""
    given = _placed(overlay, graph.places_as_given(overlay.local.borders.places), overlay.edges.given)
    at = np.flatnonzero((given != places).any(axis=1))
    return Moves(at, given[at])


def _with_all_sites(overlay: Overlay, joint: PlanarGraph, sites: Indices, order: Indices) -> Arcs:
    """Arcs of which every side is known, by the arcs around the same face, or by a place in it."""
    places, radius = _places(overlay)
    ends = _ends_of(overlay)
    start, half_edge = cycles_of(ends, order, len(places))
    around = sites.ravel()[half_edge]
    begin = start[:-1]
    if len(begin):
        most = np.maximum.reduceat(around, begin)
        least = np.minimum.reduceat(np.where(around == UNKNOWN, np.iinfo(np.int64).max, around), begin)
        if ((most != least) & (most != UNKNOWN)).any():
            raise VerificationError(
                "the clip, an enclosure or the frame nearly coincides with a cell border, to within rounding: shift "
                "it slightly"
            )
        row = owners(np.diff(start))
        unknown = np.flatnonzero(most == UNKNOWN)
        if unknown.size:
            most[unknown] = _found_by_places(overlay, unknown, start, half_edge)
        sites.reshape(-1)[half_edge] = most[row]
    graph, pieces = overlay.local.owned.graph, overlay.pieces
    control = np.full((len(ends), 2), np.nan)
    own = controls_of(overlay.local.borders, graph)[pieces.piece]
    bent = np.flatnonzero(pieces.row >= 0)
    own[bent] = overlay.found.curves[pieces.row[bent]].control(*pieces.t[bent].T)
    control[: len(own)] = graph.coordinates(own)
    center = np.full((len(ends), 2), np.nan)
    center[: len(own)] = graph.coordinates(overlay.local.borders.center[pieces.piece])
    moves = _moves(overlay, joint, places)
    return Arcs(places, radius, ends, control, center, sites, sites, order, moves)


def _found_by_places(overlay: Overlay, rings: Indices, start: Indices, half_edge: Indices) -> Indices:
    """(r,) the site of each of some rings of cuts alone: nearest to places along most of its length."""
    nearest = NearestElements(overlay.local)
    first = 2 * len(overlay.pieces.piece)
    cuts, edges = overlay.cuts, overlay.edges
    made = np.empty(len(rings), dtype=np.int64)
    sizes = np.diff(start)[rings]
    half = half_edge[np.repeat(start[rings] - np.cumsum(sizes) + sizes, sizes) + np.arange(int(sizes.sum()))] - first
    part = half >> 1
    region = edges.regions[cuts.edge[part], half & 1]
    places, length = overlay.places_along(part, _ALONG)
    site = np.empty(places.shape[:2], dtype=np.int64)
    for each in np.unique(region).tolist():
        own = np.flatnonzero(region == each)
        site[own] = nearest.sites(places[own].reshape(-1, 2), each).reshape(len(own), -1)
    ring = np.repeat(owners(sizes), len(_ALONG))
    pairs, row = np.unique(np.stack([ring, site.ravel()], axis=1), axis=0, return_inverse=True)
    total = np.bincount(row.reshape(-1), np.repeat(length, len(_ALONG)), minlength=len(pairs))
    order = np.lexsort((-pairs[:, 1], total, pairs[:, 0]))
    made[pairs[order, 0]] = pairs[order, 1]  # the longest comes last, and stays
    return made


def _numbered(arcs: Arcs, kept: Indices, overlay: Overlay) -> tuple[Arcs, Indices]:
    """Some arcs, with vertices and arcs numbered by where they are, and the order of these."""
    is_cut = np.zeros(len(arcs.vertices), dtype=bool)
    is_cut[overlay.cuts.ends] = True
    used = np.zeros(len(arcs.vertices), dtype=bool)
    used[arcs.ends[kept]] = True
    along = overlay.cuts.ends.ravel()
    along = along[np.sort(np.unique(along, return_index=True)[1])]
    chosen = np.concatenate([np.flatnonzero(used & ~is_cut), along[used[along]]])
    number = np.full(len(arcs.vertices), -1, dtype=np.int64)
    number[chosen] = np.arange(len(chosen))
    ends, sites, order = number[arcs.ends[kept]], arcs.sites[kept], arcs.order[kept]
    control = arcs.control[kept]
    center = without_lost(arcs.center[kept], arcs.vertices[chosen], ends, sites[:, 0] != OUTSIDE)
    turned = ends[:, 0] > ends[:, 1]
    for each in (ends, sites, order):
        each[turned] = each[turned, ::-1]
    sorting = by_ends(ends, control, center)
    made = Arcs(
        arcs.vertices[chosen],
        arcs.radius[chosen],
        ends[sorting],
        control[sorting],
        center[sorting],
        sites[sorting],
        sites[sorting],
        order[sorting],
        arcs.moves.renumbered(number),
    )
    return made, sorting
