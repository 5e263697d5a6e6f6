"""A checker of skeletons that are led on to their ends."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.engines.centerlines.extended_ends import HAIR, TIP
from vorotool.engines.common import fail, first_wrong
from vorotool.engines.pruning.verify_pruning import check_counts
from vorotool.engines.skeleton.parts import with_arcs
from vorotool.types.arguments import check_value
from vorotool.types.polygons.shapely_geometry import to_shapely
from vorotool.types.skeleton.lines import ExtendedSkeleton
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

PRECISION = 2.0**-40
"""Of the largest coordinate: how far rounded places may be from the boundary, or outside."""


def verify_extended(extended: ExtendedSkeleton, skeleton: Skeleton | None = None) -> None:
    """Check that the lines that extend a skeleton run from leaves inside polygons to the boundary.

    Parameters
    ----------
    extended : ExtendedSkeleton
        Result of `vorotool.extend_ends`.
    skeleton : Skeleton, optional
        The skeleton it was made of: nothing of it may be missing but ends. From each node that
        is missing, the skeleton beyond it ends within 3.62 radii of that node, as it does in corners of 45 degrees or
        more; and no piece is missing at the side of a branch that is longer than the disc it hangs on is wide.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.

    Examples
    --------
    >>> from vorotool import ExtendedSkeleton, extend_ends, skeleton_exact
    >>> extended = extend_ends(skeleton_exact([[0, 0], [6, 0], [6, 2], [0, 2]]))
    >>> verify_extended(extended)
    >>> verify_extended(ExtendedSkeleton(extended.path, extended.ends / 2))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: end 1 of branch 0 is extended to (3, 0.5), which is not on the boundary
    """
    check_value(extended, "extended", "ExtendedSkeleton")
    path = extended.path
    if skeleton is not None:
        check_value(skeleton, "skeleton", "Skeleton")
        _check_branches(path, with_arcs(skeleton, skeleton.side == INTERIOR))
    branch, end = np.nonzero(~np.isnan(extended.ends[:, :, 0]))
    places, nodes = extended.ends[branch, end], extended.end_nodes[branch, end]
    if (at := first_wrong((path.degree[nodes] != 1) | ~(path.radius[nodes] > 0))) is not None:
        fail(f"end {end[at]} of branch {branch[at]} is extended, but is not a leaf inside a polygon")
    if not len(branch):
        return
    shapes = np.array(to_shapely(path.polygons), dtype=object)[extended.polygon[branch]]
    off = PRECISION * float(np.abs(path.polygons.xy).max())
    if (at := first_wrong(shapely.distance(shapely.boundary(shapes), shapely.points(places)) > off)) is not None:
        x, y = places[at].tolist()
        fail(f"end {end[at]} of branch {branch[at]} is extended to ({x:g}, {y:g}), which is not on the boundary")
    lines = shapely.linestrings(np.stack([path.vertices[nodes], places], axis=1))
    if (at := first_wrong(shapely.length(shapely.difference(lines, shapely.buffer(shapes, off))) > 0)) is not None:
        fail(f"the extension of end {end[at]} of branch {branch[at]} leaves polygon {extended.polygon[branch[at]]}")


def _check_branches(path: Skeleton, skeleton: Skeleton) -> None:
    """Raise if a branch of a skeleton is missing."""
    check_counts(path, skeleton, "extended")
    kept, places = dict(zip(_named(path), path.degree.tolist(), strict=True)), _named(skeleton)
    beside = defaultdict(list)
    for (one, other), length in zip(skeleton.arcs.tolist(), skeleton.length.tolist(), strict=True):
        beside[one].append((other, length))
        beside[other].append((one, length))
    order = [(node, -1, 0.0, node) for node in beside if places[node] in kept]
    for node, before, _, stem in order:  # grows outwards
        order += [(to, node, way, stem) for to, way in beside[node] if to != before and places[to] not in kept]
    beyond, radius = [0.0] * len(places), skeleton.radius.tolist()
    for node, before, length, stem in reversed(order):
        if before < 0:
            continue
        is_side = before == stem and kept[places[stem]] > 1
        most = TIP * radius[node] + max(radius[node], HAIR * radius[stem])
        if beyond[node] > most or (is_side and beyond[node] + length > 2 * radius[stem]):
            x, y = skeleton.vertices[node].tolist()
            fail(f"a branch is missing: it continues for {beyond[node]:g} from ({x:g}, {y:g})")
        beyond[before] = max(beyond[before], beyond[node] + length)


def _named(skeleton: Skeleton) -> list[tuple[float, ...]]:
    """Return the polygon and the coordinates of each node."""
    polygon = np.zeros(len(skeleton.vertices))
    polygon[skeleton.arcs] = skeleton.polygon[:, None]
    table: NDArray[np.float64] = np.column_stack([polygon, skeleton.vertices])
    return list(map(tuple, table.tolist()))
