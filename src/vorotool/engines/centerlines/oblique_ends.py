"""Ends of centerlines at oblique edges of pixel outlines: a wall of steps has no angle that would tell a fork."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.from_skeleton.boundary_rays import first_hits
from vorotool.types.skeleton.centerline import Centerlines
from vorotool.types.skeleton.skeleton import EDGE, Skeleton

Floats = NDArray[np.float64]
Numbers = NDArray[np.intp]
Booleans = NDArray[np.bool_]

WIDTH = 4.0
"""In radii of the place where the path comes to an edge: an end is no longer. A stroke cut at 30 degrees has 4."""

STEEP = (1 - sqrt(0.5)) / 2
"""Square of the sine of half of 45 degrees: by so much radii fall along the way into such a corner, which is no tip."""


def led_to_oblique_ends(lines: Centerlines, wanted: Booleans) -> Centerlines:
    """Cut off what leads along one edge into its corner, and lead on to the middle of that edge."""
    path, start = lines.path, lines.arc_starts
    if path.polygons.connectivity is None:  # no outlines of pixels
        return lines
    kept, ends = np.ones(len(path), dtype=bool), lines.ends.copy()
    outer = np.stack([start[:-1], start[1:] - 1], axis=1)
    begins = _edges_between_corners(lines, outer)
    xy, following = path.polygons.xy, path.polygons.following
    size = np.where(begins < 0, 0.0, np.abs(xy[following[begins]] - xy[begins]).max(axis=-1))
    for line, end in np.argwhere(wanted & (size[..., 0] != size[..., 1])).tolist():
        side = int(size[line, end].argmax())
        arcs = np.arange(start[line], start[line + 1])[:: -1 if end else 1]
        cut = _along(lines, arcs, int(path.sites[outer[line, end], side]))
        middle = _middle(lines, arcs, cut, end, int(begins[line, end, side]))
        if middle is not None and kept[arcs].sum() > cut:
            kept[arcs[:cut]] = False
            ends[line, end] = middle
    return lines if kept.all() else Centerlines(_part(lines, kept), ends)


def _edges_between_corners(lines: Centerlines, arcs: Numbers) -> NDArray[np.int64]:
    """(…, 2) where sites of arcs begin that are edges between two corners into which the inside goes; else -1."""
    polygons, table = lines.path.polygons, lines.path.site_table
    sites = lines.path.sites[arcs]
    vertex = (
        polygons.ring_starts[polygons.polygon_starts[table.polygon[sites]] + table.ring[sites]] + table.index[sites]
    )
    before = np.empty(len(polygons.xy), dtype=np.int64)
    before[polygons.following] = np.arange(len(before))
    end = polygons.following[vertex]
    p, a, b, q = (polygons.xy[at] for at in (before[vertex], vertex, end, polygons.following[end]))
    turns = [np.sign(_cross(a - p, b - a)), np.sign(_cross(b - a, q - b))]
    is_edge = (table.kind[sites] == EDGE) & (turns[0] == turns[1]) & (turns[0] != 0)
    return np.where(is_edge, vertex, -1)


def _cross(u: Floats, v: Floats) -> Floats:
    crossed: Floats = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return crossed


def _along(lines: Centerlines, arcs: Numbers, site: int) -> int:
    """How many arcs from the end of a line on are beside a site."""
    for count, arc in enumerate(arcs.tolist()):
        if site not in lines.path.sites[arc]:
            return count
    return len(arcs)


def _middle(lines: Centerlines, arcs: Numbers, cut: int, end: int, vertex: int) -> Floats | None:
    """The middle of an edge that a line can be led to when some arcs are cut off."""
    if not 0 < cut < len(arcs):
        return None
    path, polygons = lines.path, lines.path.polygons
    node, last = path.arcs[arcs[cut - 1], 1 - end], path.arcs[arcs[0], end]
    a, b = polygons.xy[vertex], polygons.xy[polygons.following[vertex]]
    (x, y), most = b - a, WIDTH * path.radius[node]
    is_short = x * x + y * y <= most * most
    (u, v), fall = path.vertices[last] - path.vertices[node], path.radius[node] - path.radius[last]
    is_steep = fall > 0 and fall * fall >= STEEP * (u * u + v * v)
    if not is_short or not (is_steep or path.radius[last] <= path.radius[node] / 2):
        return None
    middle: Floats = a / 2 + b / 2
    origin = path.vertices[node]
    _, met = first_hits(polygons, path.polygon[arcs[:1]], origin[None], (middle - origin)[None])
    return middle if met[0] == vertex else None


def _part(lines: Centerlines, kept: Booleans) -> Skeleton:
    """The path without some arcs at the ends of lines."""
    path = lines.path
    nodes = np.zeros(len(path.vertices), dtype=bool)
    nodes[path.arcs[kept]] = True
    number = np.cumsum(nodes) - 1
    names = ("control", "sites", "polygon", "side", "branch", "length", "error_bound")
    return replace(
        path,
        vertices=path.vertices[nodes],
        radius=path.radius[nodes],
        arcs=number[path.arcs[kept]],
        **{name: getattr(path, name)[kept] for name in names},
    )
