"""The errors of an approximate skeleton in a few numbers, beside what the paper estimates (section 3.1)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.sampled_skeleton.approximate import ApproximateSkeleton
from vorotool.engines.sampled_skeleton.per_feature import FeatureApproximation
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.types.skeleton.skeleton import EDGE


def error_summary(found: ApproximateSkeleton | FeatureApproximation, *, step: float | None = None) -> dict[str, Any]:
    """Sum up the certified bounds of errors."""
    bound = found.skeleton.error_bound
    known = np.flatnonzero(~np.isnan(bound))
    summary: dict[str, Any] = {"largest": None, "mean": None, "arc": None, "x": None, "y": None}
    if len(known):
        arc = int(known[bound[known].argmax()])
        x, y = found.skeleton.vertices[found.skeleton.arcs[arc]].mean(axis=0).tolist()
        summary = {"largest": float(bound[arc]), "mean": float(bound[known].mean()), "arc": arc, "x": x, "y": y}
    summary["unproved"] = len(bound) - len(known)
    return summary if step is None else summary | _beside_the_paper(found, step)


def _beside_the_paper(found: ApproximateSkeleton | FeatureApproximation, step: float) -> dict[str, Any]:
    skeleton = found.skeleton
    is_edge = (skeleton.site_table.kind == EDGE)[skeleton.sites]
    sampled = (found.seeds >= 0).all(axis=1)
    bent = np.flatnonzero(sampled & (is_edge[:, 0] != is_edge[:, 1]))
    straight = np.flatnonzero(sampled & is_edge.all(axis=1))
    heights = _focal_heights(found, bent, is_edge[bent])
    with np.errstate(divide="ignore"):
        estimates = step * step / (8 * heights)
    return {
        "parabolas": {
            "arcs": len(bent),
            "largest_estimate": _largest(estimates),
            "largest_bound": _largest(skeleton.error_bound[bent]),
        },
        "lines": {
            "arcs": len(straight),
            "largest_bound": _largest(skeleton.error_bound[straight]),
            "largest_over_step": _largest(skeleton.error_bound[straight] / step),
        },
    }


def _focal_heights(
    found: ApproximateSkeleton | FeatureApproximation, arcs: NDArray[np.intp], is_edge: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """How far the vertex of each arc is from the line of its edge."""
    sites = found.skeleton.sites[arcs]
    ends = found.skeleton.site_ends
    edge = ends[np.where(is_edge[:, 0], sites[:, 0], sites[:, 1])]
    vertex = ends[np.where(is_edge[:, 0], sites[:, 1], sites[:, 0]), 0]
    along, way = edge[:, 1] - edge[:, 0], vertex - edge[:, 0]
    heights: NDArray[np.float64] = np.abs(along[:, 0] * way[:, 1] - along[:, 1] * way[:, 0]) / hypotenuse(*along.T)
    return heights


def _largest(values: NDArray[np.float64]) -> float | None:
    finite = values[np.isfinite(values)]
    return float(finite.max()) if len(finite) else None
