"""Which ring of a cell lies in which other one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.assembly import Arcs, Rings

Indices = NDArray[np.int64]


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
