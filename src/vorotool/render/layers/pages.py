"""What the pages of pictures show."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from vorotool.numeric.arrays import Floats
from vorotool.products.formats import resolved
from vorotool.products.registry import is_of
from vorotool.render.canvas.layers import Page, bounds_of
from vorotool.types.box import extent_sides
from vorotool.types.fields import is_up

_FINE = 2.0**-10
"""Of the extent: chords of arcs whose bounds are shown."""


def page_of(value: Any, *, width: int = 1000, bounds: tuple[float, float, float, float] | None = None) -> Page:
    """Make the page of a picture: with all that is drawn of a value, or with other bounds."""
    shown = next((places for name, places in _SHOWN.items() if is_of(value, name)), lambda mesh: [mesh.points])
    y_up = is_up(value) or is_of(value, "Tetrahedralization", "SpaceAlphaShape")
    return Page(bounds or bounds_of(*shown(value)), width=width, y_up=y_up)


def _of_skeleton(skeleton: Any) -> list[Floats]:
    """All polygons, and the frame, if arcs are cut by one."""
    frame = [] if skeleton.frame is None else [np.array(extent_sides(skeleton.frame)).reshape(2, 2)]
    return [skeleton.polygons.xy, *frame]


def _of_discs(discs: Any) -> list[Floats]:
    across = discs.radius[:, None]
    return [discs.polygons.xy, discs.xy - across, discs.xy + across]


def _of_offsets(offsets: Any) -> list[Floats]:
    corners = np.concatenate([offsets.polygons.xy, offsets.start])
    tolerance = _FINE * (float(np.ptp(corners, axis=0).max()) or 1.0) if len(corners) else 1.0
    return [offsets.polygons.xy, offsets.flattened(tolerance).xy]


def _as_seen(value: Any) -> list[Floats]:
    return [resolved("render.layers.space:seen")(value.points)]


_SHOWN: dict[str, Callable[[Any], list[Floats]]] = {
    "CellSet": lambda cells: [np.array(cells.frame.sides).reshape(2, 2)],
    "VoronoiMap": lambda cells: [np.array(extent_sides(cells.frame)).reshape(2, 2)],
    "AlphaHull": lambda hull: [hull.shape.points],
    "PolygonSet": lambda polygons: [polygons.xy],
    "Parts": lambda parts: [parts.polygons.xy],
    "Distances": lambda found: [polygons.xy for polygons in found.shapes],
    "Discs": _of_discs,
    "Offsets": _of_offsets,
    "Skeleton": _of_skeleton,
    "LedOn": lambda lines: _of_skeleton(lines.path),
    "SmoothLines": lambda lines: _of_skeleton(lines.path),
    "SkeletonPoints": lambda points: _of_skeleton(points.skeleton),
    **dict.fromkeys(("Tetrahedralization", "SpaceAlphaShape"), _as_seen),
    "Necks": lambda necks: _of_skeleton(necks.skeleton),
}
"""Places that are drawn of values, by their types; of others these are points."""
