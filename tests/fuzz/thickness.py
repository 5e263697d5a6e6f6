"""Local thickness of random images, beside all arcs and bounds without a skeleton: `--cases 2000 --seed 1`."""

import warnings
from dataclasses import replace

import numpy as np

from fuzz.runner import of_families
from support.oracles.outline_oracle import random_labels
from support.oracles.thickness_oracle import check_thickness
from vorotool import VorotoolError, VorotoolWarning, outlines, skeleton_exact, verify_thickness
from vorotool.engines.from_skeleton.thickness import thickness_of_pixels

SIDES = ((1, 1), (1, 1), (2, 1), (3, 5))


def failure(labels: np.ndarray, random: np.random.Generator) -> str | None:
    """What is wrong with the thickness of an image, if anything."""
    connectivity, kind = int(random.choice([4, 8])), str(random.choice(["crack", "contour"]))
    sides = SIDES[int(random.integers(len(SIDES)))]
    if not labels.any():
        return None
    try:
        warnings.simplefilter("error", VorotoolWarning)
        shapes = outlines(labels, mode="labels", connectivity=connectivity, outline=kind)
        shapes = replace(shapes, xy=shapes.xy * sides[::-1])
        skeleton = skeleton_exact(shapes)
        made = thickness_of_pixels(skeleton, labels.shape, sides=sides, threads=int(random.integers(1, 4)))
        assert np.array_equal(made > 0, labels != 0)
        verify_thickness(made, skeleton, sides=sides, samples=labels.size)
        check_thickness(made, shapes, sides, min(sides) / 4)
    except (VorotoolError, VorotoolWarning, AssertionError) as error:
        return f"{kind}, {connectivity}, sides {sides}: {type(error).__name__} {error}"
    return None


COMPARISON = of_families(2000, [random_labels], failure)
