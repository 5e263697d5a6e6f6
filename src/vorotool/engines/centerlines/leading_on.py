"""Straight on from ends that are inside to the boundary: to the middle of the end ahead, or wherever it is met."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.centerlines.end_middles import end_middles
from vorotool.engines.from_skeleton.boundary_rays import first_hits
from vorotool.types.skeleton.led_on import LedOn

Floats = NDArray[np.float64]


def led_on(lines: LedOn, wanted: NDArray[np.bool_], *, to_middles: bool | NDArray[np.bool_]) -> Floats:
    """Lead ends of lines that are inside to the middle of the end ahead, or straight on."""
    path, ends = lines.path, lines.ends.copy()
    origin = path.vertices[lines.end_nodes]
    wanted = wanted & (path.radius[lines.end_nodes] > 0)
    if not wanted.any():
        return ends
    places = np.full((np.count_nonzero(wanted), 2), np.nan)
    is_led = (wanted & to_middles)[wanted]
    places[is_led] = end_middles(path, lines.end_nodes[wanted][is_led].astype(np.intp)).places
    rest = np.isnan(places[:, 0])
    way, origin = (origin - _places_before(lines))[wanted], origin[wanted]
    polygon = np.stack([lines.polygon] * 2, axis=1)[wanted]
    places[rest], _ = first_hits(path.polygons, polygon[rest], origin[rest], way[rest])
    ends[wanted] = places
    return ends


def _places_before(lines: LedOn) -> Floats:
    """(k, 2, 2) places on each path, one radius after its start and before its end, or its other end."""
    path, start = lines.path, lines.arc_starts
    along = np.concatenate([[0], np.cumsum(path.length)])
    first, last = along[start[:-1]], along[start[1:]]
    radius = path.radius[lines.end_nodes]
    position = np.stack([np.minimum(first + radius[:, 0], last), np.maximum(last - radius[:, 1], first)], axis=1)
    arc = np.clip(np.searchsorted(along, position, side="right") - 1, start[:-1, None], start[1:, None] - 1).reshape(-1)
    measures = path.measures(arc)
    places: Floats = measures.place(measures.parameter(position.reshape(-1) - along[arc]))
    return places.reshape(-1, 2, 2)


def rounded(lines: LedOn) -> tuple[Floats, Floats]:
    """Give nodes and ends to as many binary places as doubles have at the largest coordinate of their polygon."""
    polygons, path = lines.path.polygons, lines.path
    if not len(lines):
        return path.vertices, lines.ends
    largest = np.maximum.reduceat(np.abs(polygons.xy), polygons.ring_starts[polygons.polygon_starts[:-1]], axis=0)
    shift = 53 - np.frexp(largest.max(axis=1))[1]  # 53 binary places: the largest coordinates are what they were
    of_nodes = np.zeros(len(path.vertices), dtype=np.int64)
    of_nodes[path.arcs] = shift[path.polygon][:, None]

    def to_places(values: Floats, by: NDArray[np.integer]) -> Floats:
        return np.asarray(np.ldexp(np.rint(np.ldexp(values, by)), -by) + 0.0)

    return to_places(path.vertices, of_nodes[:, None]), to_places(lines.ends, shift[lines.polygon][:, None, None])
