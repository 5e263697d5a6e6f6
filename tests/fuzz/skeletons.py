"""Skeletons of broken polygons and lines through both checkers: `--cases 100000 --seed 1`."""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from skeleton_shapes import FAMILIES
from vorotool import VorotoolError, verify_skeleton
from vorotool.engines.segment_verification import verify_segment_voronoi
from vorotool.engines.skeleton_exact import shape_diagram, skeleton_of
from vorotool.engines.skeleton_verification import verify_exterior


def failure(shape: object) -> str | None:
    """What is wrong with the skeletons of a shape, if anything."""
    try:
        shapes = shape_diagram(shape)
        verify_segment_voronoi(shapes.diagram)
        verify_exterior(shapes)
        for side in ("interior", "exterior", "both"):
            verify_skeleton(skeleton_of(shapes, side=side))
    except VorotoolError as error:
        return str(error)
    return None


def main() -> int:
    """Run all cases; exit 1 if any failed."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=10**5)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    start, failed = time.monotonic(), 0
    for case in range(arguments.cases):
        family = FAMILIES[case % len(FAMILIES)]
        wrong = failure(family(np.random.default_rng([arguments.seed, case])))
        if wrong:
            print(f"wrong: seed {arguments.seed}, case {case}, {family.__name__}: {wrong}")
        failed += wrong is not None
    print(f"{arguments.cases:,} shapes, {failed} failures, {time.monotonic() - start:.0f} s")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
