"""A page that shows what pruning leaves of a skeleton, for all thresholds: one file, which needs nothing else."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import LimitError
from vorotool.products.formats import AS_PICTURE
from vorotool.types.axis import is_up
from vorotool.types.box import bounds
from vorotool.types.skeleton.critical_values import ArcProfiles, CriticalValues
from vorotool.types.skeleton.skeleton import Skeleton

MOST_ARCS = 100_000
"""Some 20 MB of data: browsers draw so many in about a second."""

PAGE = "skeleton_page.html"
_PLACE = "/*DATA*/null"


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
    page = Path(__file__).with_name(PAGE).read_text(encoding="utf-8")
    before, after = page.split(_PLACE)
    data = _shapes(skeleton, is_up(skeleton))
    data["shown"] = list(shown or (values[0].criterion, 0.0))
    data["profiles"] = {
        "kind": _packed(profiles.kind, "<i1"),
        "ends": _packed(profiles.ends, "<f8"),
        "size": _packed(profiles.size, "<f8"),
    }
    data["criteria"] = {
        own.criterion: {
            "ends": _packed(own.ends, "<f8"),
            "most": _packed(own.most, "<f8"),
            "keptArc": _packed(own.kept_arc, "<i4"),
            "keptPlace": _packed(own.kept_place, "<f8"),
        }
        for own in values
    }
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    out.write(f"{before}{text}{after}".encode())


def _shapes(skeleton: Skeleton, y_up: bool) -> dict[str, Any]:
    """Arrays as the page decodes them; coordinates from the upper left corner, in parts of the larger side."""
    polygons = skeleton.polygons
    shown = np.concatenate([polygons.xy, skeleton.vertices])
    low, high = bounds(shown) if len(shown) else (np.zeros(2), np.ones(2))
    span = high - low
    size = float(span.max()) or 1.0

    def placed(xy: NDArray[np.float64]) -> str:
        y = (high[1] - xy[:, 1]) if y_up else (xy[:, 1] - low[1])
        return _packed(np.stack([xy[:, 0] - low[0], y], axis=1) / size, "<f4")

    return {
        "width": float(span[0]) / size or 1e-9,
        "height": float(span[1]) / size or 1e-9,
        "xy": placed(skeleton.vertices),
        "radius": _packed(skeleton.radius, "<f8"),
        "arcs": _packed(skeleton.arcs, "<i4"),
        "control": placed(skeleton.control),
        "length": _packed(skeleton.length, "<f8"),
        "rings": placed(polygons.xy),
        "ringStart": _packed(polygons.ring_starts, "<i4"),
        "ringKind": _packed(polygons.ring_kind, "<i1"),
    }


def _packed(values: NDArray[Any], dtype: DTypeLike) -> str:
    return b64encode(np.ascontiguousarray(values, dtype=dtype).tobytes()).decode()
