"""Checks of sections across centerlines: from the sites of the skeleton, and with the geometry of shapely."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.engines.common import fail, first_wrong
from vorotool.engines.skeleton.clearance import SitePlaces
from vorotool.numeric.arrays import Booleans, Floats, owners, starts_of
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.types.polygons.shapely_geometry import to_shapely
from vorotool.types.skeleton.extended_lines import LedOn
from vorotool.types.skeleton.points_along import SkeletonPoints
from vorotool.types.skeleton.skeleton import Skeleton

_ROUNDING = 2.0**-26
"""Part of the extent that places may be off: the lattice has 31 bits, and lines are cut into chords."""
_LENGTHENED = 2.0**-16
"""Part of a way by which a curve may be longer than its chords."""
_SHORTENED = 2.0**-10
"""Part of a section that is left out at its ends where it is to be inside."""


def verify_sections(points: SkeletonPoints, lines: LedOn, every: float) -> None:
    """Check that places are at equal steps on their lines, and sections straight across from outline to outline."""
    polygons = lines.path.polygons.as_given
    tolerance = _ROUNDING * float(np.ptp(polygons.xy, axis=0).max(initial=0.0) or 1.0)
    line = points.skeleton.branch[points.arc].astype(np.int64)
    counts = np.bincount(line, minlength=len(lines))
    if (counts != np.floor(lines.length / every) + 1).any():
        fail("a line has more or fewer points than steps")
    _refuse(points.along != every * (np.arange(len(line)) - starts_of(counts)[line]), "is not at its step")
    xy, start = lines.as_given.flattened(tolerance / 4)
    paths = shapely.linestrings(xy, indices=owners(np.diff(start)))
    shapely.prepare(paths)
    _refuse(~shapely.dwithin(paths[line], shapely.points(points.xy), tolerance), "is off its line")
    way = points.xy - _interpolated(xy, start, line, points.along)
    _refuse(hypotenuse(*way.T) > tolerance + _LENGTHENED * points.along, "is at another distance along its line")
    _check_across(points, lines, line, tolerance)
    _check_ends(points, line, to_shapely(polygons), tolerance)


def _interpolated(xy: Floats, start: NDArray[np.int64], line: NDArray[np.int64], along: Floats) -> Floats:
    """Places along polylines, which end where these do."""
    steps = hypotenuse(*np.diff(xy, axis=0, append=xy[-1:]).T)
    steps[start[1:] - 1] = 0
    reached = np.concatenate([[0.0], np.cumsum(steps)])[:-1]
    wanted = np.minimum(along + reached[start[:-1]][line], reached[start[1:] - 1][line])
    at = np.clip(np.searchsorted(reached, wanted, side="right") - 1, start[line], start[line + 1] - 1)
    part = np.divide(wanted - reached[at], steps[at], out=np.zeros(len(at)), where=steps[at] > 0)
    return xy[at] + part[:, None] * (xy[np.minimum(at + 1, len(xy) - 1)] - xy[at])


def _check_across(points: SkeletonPoints, lines: LedOn, line: NDArray[np.int64], tolerance: float) -> None:
    """Sections go the way from foot to foot of the discs; where arcs meet, half-way between two of these ways."""
    path, (begin, end) = lines.path, lines.extension_length[line].T
    inside = (points.along > begin) & (points.along < lines.length[line] - end) & points.spans
    reached = np.concatenate([[0.0], np.cumsum(path.length)])
    along = points.along - begin + reached[lines.arc_starts[line]]
    nearest = np.clip(np.searchsorted(reached, along) - 1, 0, len(path) - 1)
    meets = np.minimum(np.abs(along - reached[nearest]), np.abs(along - reached[nearest + 1])) <= tolerance
    on_arc = np.flatnonzero(inside & ~meets)
    (ux, uy), (vx, vy) = _across(path, points, on_arc).T, (points.feet[on_arc, 0] - points.feet[on_arc, 1]).T
    lengths, radius = hypotenuse(ux, uy) * hypotenuse(vx, vy), points.radius[on_arc]
    off = np.zeros(len(points), dtype=bool)
    off[on_arc] = ~((ux * vy - uy * vx) * radius <= tolerance * lengths) | (ux * vx + uy * vy <= 0)
    _refuse(off, "has a section that is not straight across")


def _across(path: Skeleton, points: SkeletonPoints, chosen: NDArray[np.int64]) -> Floats:
    """From the foot on the right site to that on the left one; approximate arcs, which are straight, turned left."""
    arc, sites, places = points.arc[chosen], SitePlaces(path), points.xy[chosen]
    left, right = (sites.feet(site, places) for site in path.sites[arc].T)
    source, target = path.vertices[path.arcs[arc]].swapaxes(0, 1)
    turned = np.stack([source[:, 1] - target[:, 1], target[:, 0] - source[:, 0]], axis=1)
    is_exact = path.error_bound[arc] == 0
    return np.where(is_exact[:, None], left - right, turned)


def _check_ends(points: SkeletonPoints, line: NDArray[np.int64], shapes: NDArray[Any], tolerance: float) -> None:
    """Feet are on the outline, on different sides of the place, and nothing of it is between."""
    assert points.rings is not None
    polygon, spans = points.skeleton.polygon[points.arc], points.spans
    outlines = shapely.boundary(shapes)
    if points.skeleton.features == "together":
        outlines = np.full(len(shapes), shapely.GeometryCollection(list(outlines)))
    shapely.prepare(outlines)
    shapely.prepare(shapes)
    for side in (0, 1):
        far = ~shapely.dwithin(outlines[polygon], shapely.points(points.feet[:, side]), tolerance)
        _refuse(far & spans, "has a foot off the outline")
    a, b = (points.xy + (1 - _SHORTENED) * (points.feet[:, side] - points.xy) for side in (0, 1))
    whole = shapely.linestrings(np.stack([a, b], axis=1))
    met = np.flatnonzero(spans & shapely.intersects(outlines[polygon], whole))
    crossed = np.zeros(len(points), dtype=bool)  # what is touched only is not left
    crossed[met] = ~shapely.covers(shapes[polygon[met]], whole[met]) & shapely.crosses(
        whole[met], outlines[polygon[met]]
    )
    _refuse(crossed, "has a section that leaves its polygon")


def _refuse(wrong: Booleans, what: str) -> None:
    if (at := first_wrong(wrong)) is not None:
        fail(f"point {at} {what}")
