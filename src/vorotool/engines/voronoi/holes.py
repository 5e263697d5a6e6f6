"""Which ring of a cell lies in which other one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.assembly import Arcs, Rings

Indices = NDArray[np.int64]


def shells_of(rings: Rings, arcs: Arcs) -> Indices:
    """(r,) the shell around each hole; of a shell its own number.

    What is joined in the plane has one number in `Rings.part`: a hole belongs to the shell of its part. Only where a
    frame has cut that into several is it looked for by places. A ring that is alone in its part is a shell, even one so
    thin that rounding leaves no area in it.

    Parameters
    ----------
    rings : Rings
        Shells, whose areas are above 0, and holes.
    arcs : Arcs
        That they are made of.
    """
    shell = np.arange(len(rings.site))
    shells, holes = np.flatnonzero(rings.area > 0), np.flatnonzero(~(rings.area > 0))
    if not holes.size:
        return shell
    sorting = shells[np.argsort(rings.part[shells], kind="stable")]
    first = np.searchsorted(rings.part[sorting], rings.part[holes])
    last = np.searchsorted(rings.part[sorting], rings.part[holes], side="right")
    held = last > first
    shell[holes[held]] = sorting[first[held]]
    for at in np.flatnonzero(last - first > 1).tolist():
        shell[holes[at]] = _around(int(holes[at]), sorting[first[at] : last[at]], rings, arcs)
    return shell


def _around(hole: int, shells: Indices, rings: Rings, arcs: Arcs) -> int:
    """The smallest of several shells that a place of a hole lies in."""
    import shapely

    place = shapely.points(arcs.vertices[arcs.ends.ravel()[rings.half_edge[rings.start[hole]]]])
    distances: list[tuple[float, float, int]] = []
    for each in shells.tolist():
        around = shapely.Polygon(_outline(each, rings, arcs))
        distances.append((float(shapely.distance(around, place)), abs(float(rings.area[each])), each))
    return min(distances)[2]


def _outline(ring: int, rings: Rings, arcs: Arcs) -> NDArray[np.float64]:
    """Places along a ring, close enough to tell what is in it."""
    half_edge = rings.half_edge[rings.start[ring] : rings.start[ring + 1]]
    arc, is_back = half_edge >> 1, (half_edge & 1).astype(bool)
    along = arcs.mixed()[arc].reversed(is_back)
    tolerance = float(np.ptp(np.concatenate([along.source, along.target]), axis=0).max()) * 2.0**-20
    return along.polylines(tolerance)[0]
