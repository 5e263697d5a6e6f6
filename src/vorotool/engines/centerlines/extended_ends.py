"""Skeletons to the ends of strokes: what forks there is left out, and its stem is led on straight to the boundary.

The skeleton of a stroke ends where the disc touches its end, a radius before it, and forks to both corners from there.
In outlines of pixels one of both may be left when small side branches are pruned: a *hook*, which leads up to a radius
beside the axis. `vorotool.engines.centerlines.end_pieces` tells both from branches.
"""

from __future__ import annotations

import numpy as np

from vorotool.engines.centerlines.end_pieces import without_end_pieces
from vorotool.engines.centerlines.leading_on import led_on, rounded
from vorotool.engines.skeleton.parts import with_arcs
from vorotool.numeric.progress import Progress
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.extended import ExtendedSkeleton
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton


def extend_ends(skeleton: Skeleton, *, threads: int = 0, progress: Progress = None) -> ExtendedSkeleton:
    """Extend the ends of a skeleton to the boundary, so that it reaches the ends of strokes.

    First, the forks at the ends of strokes are left out, and the hooks that outlines of pixels make there: pieces
    whose radii fall as fast as into a corner of 45 degrees or more. No branch is left out, not even of a stroke on a
    blob: beyond each node of it the skeleton goes on for more than its own radius accounts for. Then each leaf that
    is inside is led on along a straight line to the middle of its end: the piece of outline between both sides of the
    stroke (see `vorotool.engines.centerlines.end_middles`). Leaves at corners, of less than 45 degrees, stay; and so
    do single places that are left of round shapes.

    Parameters
    ----------
    skeleton : Skeleton
        Pruned or not. Its arcs inside polygons are used.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done of the pruning.

    Returns
    -------
    ExtendedSkeleton
        Branches with the places that they are extended to.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [6, 0], [6, 2], [0, 2]])
    >>> extend_ends(skeleton).flattened(0.1)[0].tolist()
    [[0.0, 1.0], [6.0, 1.0]]
    """
    check_value(skeleton, "skeleton", "Skeleton")
    inside = with_arcs(skeleton, skeleton.side == INTERIOR)
    stems = without_end_pieces(inside, threads=threads, progress=progress)
    count = int(stems.branch[-1]) + 1 if len(stems) else 0
    lines = ExtendedSkeleton(stems, np.full((count, 2, 2), np.nan))
    has_length = np.bincount(stems.branch, stems.length, count) > 0
    wanted = (stems.degree[lines.end_nodes] == 1) & has_length[:, None]
    lines = ExtendedSkeleton(stems, led_on(lines, wanted, to_middles=True))
    return ExtendedSkeleton(stems, rounded(lines)[1])
