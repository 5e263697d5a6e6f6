"""A page that shows what pruning leaves of a skeleton, for all thresholds: one file, which needs nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, BinaryIO

import numpy as np

from vorotool.errors import LimitError
from vorotool.products.formats import AS_PICTURE
from vorotool.render.pages.page_data import Extent, packed, write_page
from vorotool.types.axis import is_up
from vorotool.types.box import bounds
from vorotool.types.skeleton.critical_values import ArcProfiles, CriticalValues
from vorotool.types.skeleton.skeleton import Skeleton

MOST_ARCS = 100_000
"""Some 20 MB of data: browsers draw so many in about a second."""

PAGE = "skeleton_page.html"


def check_html_size(skeleton: Skeleton) -> None:
    """Refuse a page that no browser would draw."""
    for count, what in ((len(skeleton), "arcs"), (len(skeleton.polygons.xy), "vertices of polygons")):
        if count > MOST_ARCS:
            raise LimitError(f"{count} {what} are too many for a page, at most {MOST_ARCS}: use {AS_PICTURE}")


def write_skeleton_html(
    out: BinaryIO,
    skeleton: Skeleton,
    values: Sequence[CriticalValues],
    profiles: ArcProfiles,
    *,
    shown: tuple[str, float] | None = None,
) -> None:
    """Write a page with a slider over the threshold of each criterion."""
    check_html_size(skeleton)
    data = _shapes(skeleton)
    data["shown"] = list(shown or (values[0].criterion, 0.0))
    data["profiles"] = {
        "kind": packed(profiles.kind, "<i1"),
        "ends": packed(profiles.ends, "<f8"),
        "size": packed(profiles.size, "<f8"),
    }
    data["criteria"] = {
        own.criterion: {
            "ends": packed(own.ends, "<f8"),
            "most": packed(own.most, "<f8"),
            "keptArc": packed(own.kept_arc, "<i4"),
            "keptPlace": packed(own.kept_place, "<f8"),
        }
        for own in values
    }
    write_page(out, PAGE, data)


def _shapes(skeleton: Skeleton) -> dict[str, Any]:
    """Arrays as the page decodes them."""
    polygons = skeleton.polygons
    shown = np.concatenate([polygons.xy, skeleton.vertices])
    low, high = bounds(shown) if len(shown) else (np.zeros(2), np.ones(2))
    extent = Extent(low, high, y_up=is_up(skeleton))
    return {
        **extent.sides,
        "xy": extent.places(skeleton.vertices),
        "radius": packed(skeleton.radius, "<f8"),
        "arcs": packed(skeleton.arcs, "<i4"),
        "control": extent.places(skeleton.control),
        "length": packed(skeleton.length, "<f8"),
        "rings": extent.places(polygons.xy),
        "ringStart": packed(polygons.ring_starts, "<i4"),
        "ringKind": packed(polygons.ring_kind, "<i1"),
    }
