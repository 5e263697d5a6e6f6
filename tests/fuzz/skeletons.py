"""Skeletons of broken polygons and lines under symmetries through both checkers: `--cases 100000 --seed 1`.

Those inside must be the same when only what is needed for them is made of the diagram.
Cases 8 k to 8 k + 7 are one shape under the 8 symmetries of the square; now and then it is one of those in data/.
`--first` and `--seconds` do the work in pieces.
"""

from fuzz.runner import Cases, Comparison, Verdict
from support.families.skeleton_shapes import DATA, FAMILIES, under_symmetries
from support.readers.written import differing
from vorotool import VorotoolError, read, skeleton_exact, verify_skeleton
from vorotool.engines.segment_voronoi.segment_voronoi import verify_segment_voronoi
from vorotool.engines.skeleton.exact import shape_diagram, skeleton_of
from vorotool.engines.skeleton.verify_skeleton import verify_exterior

REAL = 250
"""One of so many shapes is a file of data/."""


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


def check(case: int, cases: Cases) -> Verdict:
    """Judge a shape under one of the symmetries."""
    drawing, symmetry = divmod(case, 8)
    family, turn = FAMILIES[drawing % len(FAMILIES)], drawing // REAL
    is_real = drawing % REAL == REAL - 1
    shape = read(DATA[turn % len(DATA)]) if is_real else family(cases.random(drawing))
    name = DATA[turn % len(DATA)].name if is_real else family.__name__
    return name, failure(list(under_symmetries(shape))[symmetry]), ""


COMPARISON = Comparison(10**5, check)
