"""Skeletons of broken polygons and lines under symmetries through both checkers: `--cases 100000 --seed 1`.

Cases 8 k to 8 k + 7 are one shape under the 8 symmetries of the square; `--first` and `--seconds` do the work in
pieces. With `--data` the shapes are those in data/, each under all symmetries.
"""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from skeleton_shapes import DATA, FAMILIES, under_symmetries
from vorotool import VorotoolError, read, verify_skeleton
from vorotool.engines.segment_verification import verify_segment_voronoi
from vorotool.engines.skeleton_exact import shape_diagram, skeleton_of
from vorotool.engines.skeleton_verification import verify_exterior


def failure(shape: object) -> str | None:
    """What is wrong with the skeletons of a shape, if anything."""
    try:
        shapes = shape_diagram(shape, threads=1)
        verify_segment_voronoi(shapes.diagram, threads=1)
        verify_exterior(shapes, threads=1)
        for side in ("interior", "exterior", "both"):
            verify_skeleton(skeleton_of(shapes, side=side, threads=1), threads=1)
    except VorotoolError as error:
        return str(error)
    return None


def of_data() -> int:
    """Run the shapes in data/; the number of failures."""
    failed = 0
    for path in DATA:
        shape = read(path)
        faults = [failure(turned) for turned in under_symmetries(shape)]
        for symmetry, wrong in enumerate(faults):
            if wrong:
                print(f"wrong: {path.name}, symmetry {symmetry}: {wrong}")
        right = faults.count(None)
        print(f"{path.name}, {len(shape.xy):,} vertices: right under {right} of {len(faults)} symmetries", flush=True)
        failed += len(faults) - right
    return failed


def at_random(arguments: argparse.Namespace) -> int:
    """Run the cases; the number of failures."""
    start, failed, case = time.monotonic(), 0, arguments.first
    while case < arguments.first + arguments.cases and time.monotonic() < start + arguments.seconds:
        drawing, symmetry = divmod(case, 8)
        family = FAMILIES[drawing % len(FAMILIES)]
        shape = list(under_symmetries(family(np.random.default_rng([arguments.seed, drawing]))))[symmetry]
        wrong = failure(shape)
        if wrong:
            print(f"wrong: seed {arguments.seed}, case {case}, {family.__name__}: {wrong}", flush=True)
        failed += wrong is not None
        case += 1
    count = case - arguments.first
    print(f"cases {arguments.first} to {case - 1}: {count:,} shapes, {failed} failures", end="")
    print(f", {time.monotonic() - start:.0f} s")
    return failed


def main() -> int:
    """Run all; exit 1 if any failed."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=10**5)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=np.inf, help="begin no case after so many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--data", action="store_true", help="the shapes in data/ only")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    failed = of_data() if arguments.data else at_random(arguments)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
