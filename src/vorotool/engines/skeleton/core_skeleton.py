"""Skeletons as the core takes them."""

from __future__ import annotations

import numpy as np

from vorotool import _core
from vorotool.types.skeleton.skeleton import Skeleton


def core_skeleton(skeleton: Skeleton, *, threads: int = 1, has_sites: bool = True) -> _core.skeleton.Skeleton:
    """The arrays of a skeleton, for the core; `scale` looks at no site."""
    return _core.skeleton.Skeleton(
        skeleton.vertices,
        skeleton.radius,
        skeleton.arcs,
        skeleton.control,
        skeleton.sites,
        skeleton.length,
        np.ascontiguousarray(skeleton.site_ends_on(threads).reshape(-1, 4)) if has_sites else None,
        skeleton.on_frame.view(np.uint8),
        skeleton.gap > 0,
        float(max(skeleton.vertices.max(initial=0), -skeleton.vertices.min(initial=0))),
    )
