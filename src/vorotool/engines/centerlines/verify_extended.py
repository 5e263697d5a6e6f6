"""A checker of skeletons that are led on to their ends."""

from __future__ import annotations

import numpy as np
import shapely

from vorotool.engines.common.faults import fail, first_wrong
from vorotool.geometry.arguments.values import check_value
from vorotool.geometry.polygons.conversion import to_shapely
from vorotool.geometry.skeleton.extended import ExtendedSkeleton

PRECISION = 2.0**-40
"""Of the largest coordinate: how far rounded places may be from the boundary, or outside."""


def verify_extended(extended: ExtendedSkeleton) -> None:
    """Check the straight lines that lead on: from leaves inside, within their polygon, to its boundary.

    Parameters
    ----------
    extended : ExtendedSkeleton
        As `vorotool.extend_ends` made it.

    Raises
    ------
    VerificationError
        Naming the first fault.

    Examples
    --------
    >>> from vorotool import ExtendedSkeleton, extend_ends, skeleton_exact
    >>> extended = extend_ends(skeleton_exact([[0, 0], [6, 0], [6, 2], [0, 2]]))
    >>> verify_extended(extended)
    >>> verify_extended(ExtendedSkeleton(extended.path, extended.ends / 2))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: end 1 of branch 0 is led on to (3, 0.5), which is not on the boundary
    """
    check_value(extended, "extended", ExtendedSkeleton)
    path = extended.path
    branch, end = np.nonzero(~np.isnan(extended.ends[:, :, 0]))
    places, nodes = extended.ends[branch, end], extended.end_nodes[branch, end]
    at = first_wrong((path.degree[nodes] != 1) | ~(path.radius[nodes] > 0))
    if at is not None:
        fail(f"end {end[at]} of branch {branch[at]} is led on, but is no leaf inside")
    if not len(branch):
        return
    shapes = np.array(to_shapely(path.polygons), dtype=object)[extended.polygon[branch]]
    off = PRECISION * float(np.abs(path.polygons.xy).max())
    at = first_wrong(shapely.distance(shapely.boundary(shapes), shapely.points(places)) > off)
    if at is not None:
        x, y = places[at].tolist()
        fail(f"end {end[at]} of branch {branch[at]} is led on to ({x:g}, {y:g}), which is not on the boundary")
    lines = shapely.linestrings(np.stack([path.vertices[nodes], places], axis=1))
    at = first_wrong(shapely.length(shapely.difference(lines, shapely.buffer(shapes, off))) > 0)
    if at is not None:
        fail(f"what end {end[at]} of branch {branch[at]} is led on by leaves polygon {extended.polygon[branch[at]]}")
