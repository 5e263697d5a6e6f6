"""Centerlines of strips with known axes, from 5 to 2,000 vertices or `--vertices`: `--cases 1000 --seed 1`."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from fuzz.runner import Cases, options
from support.families.strips import strip
from vorotool import centerline, prune, skeleton_exact

MOST_PRUNED = 20_000
"""Vertices of strips that are pruned, too."""


def failure(made) -> str | None:
    """What is wrong with the ends of a strip, if anything."""
    whole = skeleton_exact(made.ring)
    for name in ("whole", "pruned") if len(made.ring) <= MOST_PRUNED else ("whole",):
        skeleton = prune(whole, scale=1.3) if name == "pruned" else whole
        ends = centerline(skeleton).ends[0]
        off = max(np.hypot(*(ends - end).T).min() for end in made.axis[[0, -1]]) / made.width
        if not off < 0.01:
            return f"{name}: an end is {off:.3f} widths off"
    return None


if __name__ == "__main__":
    parser = options(1000)
    parser.add_argument("--vertices", type=int)
    arguments = parser.parse_args()
    cases = Cases(arguments)
    for case in cases:
        made = strip(cases.random(case), vertices=arguments.vertices)
        if made is not None:
            cases.judge(case, made.kind.rpartition(",")[0], failure(made))
    sys.exit(cases.end("strips"))
