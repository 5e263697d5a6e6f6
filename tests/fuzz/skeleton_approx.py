"""Approximate skeletons of broken polygons and lines through their checker: `--cases 2000 --seed 1`."""

from typing import Any

import numpy as np

from fuzz.runner import of_families
from support.approximations import verify_approximate
from support.families.skeleton_shapes import FAMILIES
from vorotool import VorotoolError
from vorotool.convert.polygons import as_polygons
from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.arrangement.repaired_polygons import placed_shapes
from vorotool.engines.sampled_skeleton.approximate import SamplingOptions, Wanted, approximate_skeleton, sampled_graph
from vorotool.engines.sampled_skeleton.per_feature import skeleton_within
from vorotool.errors import LimitError

MOST_SEEDS = 10**5


def failure(shape: Any, rng: np.random.Generator) -> str | None:
    """What is wrong with the skeletons of a shape, if anything."""
    extent = float(np.ptp(as_polygons(shape).xy, axis=0).max()) or 1.0
    step, tolerance = extent * 10 ** rng.uniform(-2.5, 0), extent * 10 ** rng.uniform(-5, -2)
    sampling = str(rng.choice(["paper", "symmetric"]))
    try:
        graph = planar_graph(shape)
        placed = placed_shapes(graph)
        shapes = sampled_graph(graph, placed, SamplingOptions(step, None, sampling))
        for side in ("interior", "exterior", "both"):
            for complete in (False, True):
                verify_approximate(approximate_skeleton(shapes, Wanted(side, complete=complete)), step=step)
        side = str(rng.choice(["interior", "exterior", "both"]))
        verify_approximate(skeleton_within(graph, placed, tolerance, Wanted(side, complete=True, most=MOST_SEEDS)))
    except LimitError as error:
        return None if str(MOST_SEEDS) in str(error) else f"{side}, tolerance {tolerance}: {error}"
    except VorotoolError as error:
        return f"{sampling}, step {step}, tolerance {tolerance}: {error}"
    return None


COMPARISON = of_families(2000, FAMILIES, failure)
