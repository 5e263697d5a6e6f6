"""The planar map of cut borders and their frame: arcs, and the rings of each cell."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import VerificationError
from vorotool.numeric.arrays import Floats, Indices, ranges, starts_of
from vorotool.numeric.curves.mixed_arcs import MixedArcs
from vorotool.plain import plain
from vorotool.types.voronoi.voronoi_map import OUTSIDE

_AT_ONCE = 2**18
"""Arcs that are measured together, so that this takes little memory."""


@plain(eq=False)
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
    cross = np.where(is_left[circular], 1, -1) * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    is_lost = ((a * b).sum(axis=1) > 0) & (cross <= 0)
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


@plain(eq=False)
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
    most = float(np.sqrt(np.square(xy - arcs.vertices[at]).sum(axis=1).max()))
    size = np.diff(rings.start)
    around = np.add.reduceat(_lengths(arcs)[rings.half_edge >> 1], rings.start[:-1])
    thin = np.flatnonzero(np.abs(rings.area) <= 2 * most * (around + size * most))
    kept = arcs.ends[rings.half_edge[ranges(rings.start[:-1][thin], size[thin])] >> 1]
    made[kept] = arcs.vertices[kept]
    return made


def _lengths(arcs: Arcs) -> Floats:
    """(a,) at least the lengths of arcs."""
    source, target = (arcs.vertices.take(end, axis=0) for end in arcs.ends.T)
    length = _norm(target - source)
    bent = np.flatnonzero(~np.isnan(arcs.control[:, 0]))
    control = arcs.control[bent]
    length[bent] = _norm(control - source[bent]) + _norm(target[bent] - control)
    round_ = np.flatnonzero(~np.isnan(arcs.center[:, 0]))
    length[round_] = 4 * _norm(source[round_] - arcs.center[round_])  # at most half a circle
    return length


def _norm(way: Floats) -> Floats:
    return np.sqrt(np.square(way).sum(axis=1))


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
    import shapely

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
