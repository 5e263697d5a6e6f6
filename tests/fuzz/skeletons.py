"""Skeletons of broken polygons and lines under symmetries through both checkers: `--cases 100000 --seed 1`.

Those inside must be the same when only what is needed for them is made of the diagram.
Cases 8 k to 8 k + 7 are one shape under the 8 symmetries of the square; `--first` and `--seconds` do the work in
pieces. With `--data` the shapes are those in data/, each under all symmetries.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from fuzz.runner import Cases, options
from support.families.skeleton_shapes import DATA, FAMILIES, under_symmetries
from support.readers.written import differing
from vorotool import VorotoolError, read, skeleton_exact, verify_skeleton
from vorotool.engines.segment_voronoi.segment_voronoi import verify_segment_voronoi
from vorotool.engines.skeleton.exact import shape_diagram, skeleton_of
from vorotool.engines.skeleton.verify_skeleton import verify_exterior


def failure(shape: object) -> str | None:
    """What is wrong with the skeletons of a shape, if anything."""
    try:
        shapes = shape_diagram(shape, threads=1)
        verify_segment_voronoi(shapes.diagram, threads=1)
        verify_exterior(shapes, threads=1)
        whole = {side: skeleton_of(shapes, side=side, threads=1) for side in ("interior", "exterior", "both")}
        for skeleton in whole.values():
            verify_skeleton(skeleton, threads=1)
        verify_skeleton(skeleton_exact(shape, threads=2), threads=1)  # of each feature by itself
        if names := differing(skeleton_exact(shape, features="together", threads=2), whole["interior"]):
            return f"{names[0]} inside are others when nothing else is made"
    except VorotoolError as error:
        return str(error)
    return None


def of_data() -> int:
    """Run the shapes in data/; exit 1 if any failed."""
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
    return int(failed > 0)


def at_random(arguments: argparse.Namespace) -> int:
    """Run the cases; exit 1 if any failed."""
    cases = Cases(arguments)
    for case in cases:
        drawing, symmetry = divmod(case, 8)
        family = FAMILIES[drawing % len(FAMILIES)]
        shape = list(under_symmetries(family(cases.random(drawing))))[symmetry]
        cases.judge(case, family.__name__, failure(shape))
    return cases.end("shapes")


def main() -> int:
    """Run all; exit 1 if any failed."""
    parser = options(10**5)
    parser.add_argument("--data", action="store_true", help="the shapes in data/ only")
    arguments = parser.parse_args()
    return of_data() if arguments.data else at_random(arguments)


if __name__ == "__main__":
    sys.exit(main())
