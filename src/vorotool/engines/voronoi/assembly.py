"""The planar map of cut borders and their frame: arcs, and the rings of each cell."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.voronoi.moves import Moves
from vorotool.errors import VerificationError
from vorotool.numeric.curves.mixed_arcs import MixedArcs
from vorotool.numeric.ragged import ranges, starts_of
from vorotool.plain import plain
from vorotool.types.voronoi.voronoi_map import OUTSIDE

Indices = NDArray[np.int64]
Floats = NDArray[np.float64]

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
    moves: Moves  # of vertices that are vertices of the input: all is decided where the lattice has them

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


@plain(eq=False)
class Cells:
    """Cells as rings in rows."""

    ring_arcs: NDArray[np.int32]  # (k,) int32 array: arcs along each ring, from 1; below 0 against their direction
    # int64 array: where each ring begins there, each polygon among the rings, each cell among the polygons
    ring_starts: Indices
    # int64 array: where each ring begins there, each polygon among the rings, each cell among the polygons
    polygon_starts: Indices
    # int64 array: where each ring begins there, each polygon among the rings, each cell among the polygons
    cell_starts: Indices


def cells_of(rings: Rings, shell: Indices, count: int) -> Cells:
    """Put rings into polygons, and polygons into cells."""
    is_hole = shell != np.arange(len(shell))
    sorting = np.lexsort((np.arange(len(shell)), is_hole, shell, rings.site[shell]))
    sizes = np.diff(rings.start)[sorting]
    half_edge = rings.half_edge[ranges(rings.start[:-1][sorting], sizes)]
    arc = (half_edge >> 1) + 1
    first = np.flatnonzero(~is_hole[sorting])
    of_site = np.bincount(rings.site[sorting[first]], minlength=count)
    return Cells(
        np.where(half_edge & 1, -arc, arc).astype(np.int32),
        starts_of(sizes),
        np.append(first, len(sorting)),
        starts_of(of_site),
    )
