"""What is said of polygons on the lattice: repairs, and shapes for which it is coarse."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import STRICT, InputError, RepairWarning, warn
from vorotool.numeric.arrays import owners, ranges, starts_of
from vorotool.numeric.numbers import distinct
from vorotool.types.polygons.planar_graph import REPAIRS
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.values import counted

if TYPE_CHECKING:
    from vorotool.engines.arrangement.planar_graph import Placement

Found = dict[str, tuple[int, int, int]]

SMALL = 1 << 10
"""Steps of the lattice: what is smaller has sizes and radii that are wrong by a part in a thousand, or more."""

NAMED = 10
"""Features that a warning names."""


def report_repairs(
    given: PolygonSet, found: Found, is_repaired: NDArray[np.bool_], step: float, *, strict: bool
) -> None:
    """Warn of repairs, if there are any; raise InputError instead if `strict`."""
    repairs = {name: count for name, (count, _, _) in found.items()}
    if not any(repairs.values()):
        return
    if strict:
        raise InputError(_first_repair(given, found))
    names = _features(given, is_repaired)
    warn(_summary(repairs, step) + (f", in {names}" if names else ""), RepairWarning)


def report_small(given: PolygonSet, placement: Placement, *, strict: bool) -> None:
    """Warn of polygons and lines for which the lattice is coarse; raise InputError instead if `strict`."""
    step = math.ldexp(1.0, placement.exponent)
    if not placement.largest_move or not len(given):
        return
    is_small = _are_small(given, (given.xy - placement.origin) / step)
    if is_small.any():
        is_small &= _are_moved(given, placement, step)
    count = int(np.count_nonzero(is_small))
    if not count:
        return
    what = "1 polygon or line is" if count == 1 else f"{count} polygons or lines are"
    message = (
        f"{what} smaller than {SMALL} steps of the lattice ({step:.3g}) to which all coordinates are rounded: "
        f"{_features(given, is_small)}; remove features that are far away, or expect rough sizes and radii"
    )
    if strict:
        raise InputError(f"{message}; {STRICT} refuses this")
    warn(message, RepairWarning)


def _are_small(given: PolygonSet, steps: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(p,) whether each line is shorter and each polygon narrower than `SMALL`, but not a single place."""
    first = given.ring_starts[given.polygon_starts[:-1]]
    last = given.ring_starts[given.polygon_starts[:-1] + 1]
    sizes = last - first
    xy, own = steps[ranges(first, sizes)], owners(sizes)
    begin = starts_of(sizes)[:-1]
    sides = np.maximum.reduceat(xy, begin) - np.minimum.reduceat(xy, begin)
    width = np.where(given.is_line, sides.max(axis=1), sides.min(axis=1))
    way = np.roll(xy, -1, axis=0) - xy
    way[begin + sizes - 1] = xy[begin] - xy[begin + sizes - 1]
    length = np.sqrt((way * way).sum(axis=1))
    order = np.lexsort((length, own))[begin + sizes - 1]  # the longest edge of each
    across = way[order][:, ::-1] * (1, -1) / np.where(length[order] > 0, length[order], 1)[:, None]
    level = ((xy - xy[begin][own]) * across[own]).sum(axis=1)
    thin = np.maximum.reduceat(level, begin) - np.minimum.reduceat(level, begin)
    width = np.where(given.is_line, width, np.minimum(width, thin))
    width = np.where(width > 0, width, sides.max(axis=1))
    small: NDArray[np.bool_] = (width > 0) & (width < SMALL)
    return small


def _are_moved(given: PolygonSet, placement: Placement, step: float) -> NDArray[np.bool_]:
    """(p,) whether the lattice has a vertex of each elsewhere than it was given."""
    moved = (np.asarray(placement.origin) + step * placement.vertices.astype(np.float64) != given.xy).any(axis=1)
    of_vertex = np.repeat(given.ring_polygon, np.diff(given.ring_starts))
    return np.bincount(of_vertex, moved, minlength=len(given)) > 0


def _features(given: PolygonSet, chosen: NDArray[np.bool_]) -> str:
    """Name the features of some polygons, counted from 1: the first ten."""
    labels = distinct(given.labels[chosen]).tolist()
    if not labels:
        return ""
    more = f" and {len(labels) - NAMED} more" if len(labels) > NAMED else ""
    return f"feature{'s' * (len(labels) > 1)} {', '.join(map(str, labels[:NAMED]))}{more}"


_WORDS = {
    "repeated_vertices": ("repeated vertex dropped", "repeated vertices dropped"),
    "touching_vertices": ("edge cut at a vertex on it", "edges cut at a vertex on them"),
    "crossings": ("crossing of edges cut", "crossings of edges cut"),
    "moved_edges": ("edge bent by less than {step:.2g}", "edges bent by less than {step:.2g}"),
    "idle_segments": ("dangling segment dropped", "dangling segments dropped"),
    "empty_polygons": ("polygon without area", "polygons without area"),
}


def _summary(repairs: dict[str, int], step: float) -> str:
    parts = [f"{count} {_WORDS[name][count != 1].format(step=step)}" for name, count in repairs.items() if count]
    return f"repaired: {', '.join(parts)}"


def _first_repair(polygons: PolygonSet, found: Found) -> str:
    """Name the place of the first repair along the input."""
    names = [name for name in REPAIRS if found[name][0] and name != "moved_edges"]
    name = min(names, key=lambda each: (found[each][1], REPAIRS.index(each)))
    count, edge, other = found[name]
    ends = " to ".join(_position(polygons, vertex) for vertex in (edge, _next_vertex(polygons, edge)))
    where = f"{_edge(polygons, edge)} from {ends}"
    what = {
        "repeated_vertices": f"{polygons.place(edge)} at {_position(polygons, edge)} is repeated by the next one",
        "touching_vertices": f"{where} passes through {polygons.place(other)} at {_position(polygons, other)}",
        "crossings": f"{where} crosses {_edge(polygons, other)}",
        "idle_segments": f"{where} is dangling, or a part of it is: a spike or an overlap",
        "empty_polygons": f"{polygons.place(edge).split(',')[0]} at {_position(polygons, edge)} has no area",
    }[name]
    return f"{what} ({counted(count, 'such place')}): correct it, or leave out {STRICT}"


def _edge(polygons: PolygonSet, edge: int) -> str:
    return polygons.place(edge).replace("vertex", "edge")


def _position(polygons: PolygonSet, vertex: int) -> str:
    x, y = polygons.xy[vertex].tolist()
    return f"({x!r}, {y!r})"


def _next_vertex(polygons: PolygonSet, edge: int) -> int:
    ring = int(np.searchsorted(polygons.ring_starts, edge, side="right")) - 1
    return edge + 1 if edge + 1 < polygons.ring_starts[ring + 1] else int(polygons.ring_starts[ring])
