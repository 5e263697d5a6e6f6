"""Compute segment diagrams of every family under symmetries and check them exactly: `--cases 10000 --seed 1`.

Cases 8 k to 8 k + 7 are one graph under the 8 symmetries of the square, but for `--symmetries 1`; `--first` and
`--seconds` do the work in pieces. Each diagram is checked by the shipped checker. It must be the same but for the
numbers when points and segments are numbered anew, segments reversed and another number of threads is used, and the
same but for its place when it is moved and scaled by a power of two. A share of the cases, placed on a coarse lattice,
is compared with Boost's diagram, which is wrong now and then even there if brute force says so; a share of those with
few sites with brute force.
"""

import argparse
from collections import Counter
from dataclasses import replace

import numpy as np

from fuzz.runner import Cases, Comparison, Verdict
from support.families.segment_families import FAMILIES, LIMIT, coarse, draw, renumbered, symmetries
from support.oracles import boost_oracle, segment_oracle
from vorotool import VorotoolError
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi, verify_segment_voronoi
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram

MOVED = 1 / 4
BESIDE_BOOST = 1 / 8
BESIDE_BRUTE_FORCE = ((26, 1 / 40), (60, 1 / 1000))
"""Shares of the cases; the last ones of those with up to so many sites."""


def changed_by_numbers(diagram: SegmentVoronoiDiagram, rng: np.random.Generator) -> str | None:
    """What changes with the numbers of points and segments, the direction of segments and the number of threads."""
    points, segments, number = renumbered(diagram.points, diagram.segments, rng)
    other = segment_voronoi(points, segments, threads=int(rng.choice([1, 2, 3, 8])))
    for name in ("vertices", "radius", "vertex_starts", "edges"):
        if not np.array_equal(getattr(diagram, name), getattr(other, name)):
            return f"a permutation changes {name}"
    if not np.array_equal(number[diagram.edge_sites], other.edge_sites):
        return "a permutation changes the sites of the edges"
    return None


def changed_by_motion(diagram: SegmentVoronoiDiagram, rng: np.random.Generator) -> str | None:
    """What changes, but for the place, when a graph is scaled by a power of two or moved on the lattice."""
    low, high = diagram.points.min(axis=0).astype(np.int64), diagram.points.max(axis=0).astype(np.int64)
    scale = 2 ** int(rng.integers(0, int(LIMIT // max(1, -low.min(), high.max())).bit_length()))
    shift = rng.integers(-LIMIT - low, LIMIT - high + 1)
    for name, factor, step in (("scaling", scale, np.zeros(2, np.int64)), ("moving", 1, shift)):
        moved = segment_voronoi((diagram.points * factor + step).astype(np.int32), diagram.segments, threads=1)
        expected = replace(diagram, vertices=diagram.vertices * factor + step, radius=diagram.radius * factor)
        verify_segment_voronoi(moved, threads=1)
        # Where values cancel, moving shows the rounding of the larger ones: then only the checker knows.
        wrong = segment_oracle.differences(moved, expected, 8 if factor > 1 else np.inf)
        if wrong:
            return f"{name} by {factor} and {step.tolist()} changes the diagram: {wrong[0]}"
    return None


def unlike_brute_force(points: np.ndarray, segments: np.ndarray) -> str | None:
    """What brute force says otherwise."""
    right = segment_oracle.voronoi_diagram(points, segments)
    wrong = segment_oracle.differences(segment_voronoi(points, segments, threads=1), right)
    return f"brute force differs: {wrong[0]}" if wrong else None


def boost_differs(points: np.ndarray, segments: np.ndarray) -> list[str]:
    """What Boost says otherwise."""
    diagram = segment_voronoi(points, segments, threads=1)
    return boost_oracle.differences(diagram, boost_oracle.boost_edges(points, segments))


def where_boost_differs(points: np.ndarray, segments: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A part of the graph of which nothing can be left out."""
    size = None
    while size != (size := len(points) + len(segments)):
        for k in reversed(range(len(segments))):
            fewer = np.delete(segments, k, axis=0)
            segments = fewer if boost_differs(points, fewer) else segments
        for k in reversed(range(len(points))):
            rest = np.delete(points, k, axis=0), segments - (segments > k)
            if (segments != k).all() and boost_differs(*rest):
                points, segments = rest
    return points, segments


def unlike_boost(points: np.ndarray, segments: np.ndarray, done: Counter[str]) -> str | None:
    """What Boost says otherwise, unless brute force agrees with us where it does."""
    wrong = boost_differs(points, segments)
    if not wrong:
        return None
    done["Boost differs"] += 1
    points, segments = where_boost_differs(points, segments)
    if len(points) + len(segments) > BESIDE_BRUTE_FORCE[-1][0]:
        return f"on a coarse lattice Boost differs: {wrong[0]}"
    return unlike_brute_force(points, segments)


def failure(points: np.ndarray, segments: np.ndarray, rng: np.random.Generator, done: Counter[str]) -> str | None:
    """What is wrong with the diagram of this graph, if anything."""
    sites = len(points) + len(segments)
    moves, beside_boost, beside_brute_force = rng.random(3)
    try:
        diagram = segment_voronoi(points, segments, threads=1)
        verify_segment_voronoi(diagram, threads=1)
        wrong = changed_by_numbers(diagram, rng)
        if not len(points):
            return wrong  # a drawing may be empty: there is nothing to move, and nothing to compare
        if wrong is None and moves < MOVED:
            done["moved"] += 1
            wrong = changed_by_motion(diagram, rng)
        if wrong is None and beside_boost < BESIDE_BOOST:
            done["beside Boost"] += 1
            wrong = unlike_boost(*coarse(points, segments, 2**12), done)
        if wrong is None and beside_brute_force < next((s for most, s in BESIDE_BRUTE_FORCE if sites <= most), 0):
            done["beside brute force"] += 1
            wrong = unlike_brute_force(points, segments)
    except (VorotoolError, RuntimeError) as error:
        return str(error)
    return wrong


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add which graphs are drawn."""
    parser.add_argument("--symmetries", type=int, choices=range(1, 9), default=8, help="to check each graph under")
    parser.add_argument("--largest", type=int, default=400)
    parser.add_argument("--family", choices=FAMILIES, nargs="+", default=list(FAMILIES))


def check(case: int, cases: Cases) -> Verdict:
    """Judge the diagram of a graph under one of the symmetries."""
    given = cases.arguments
    drawing, symmetry = divmod(case, given.symmetries)
    name = given.family[drawing % len(given.family)]
    n = int(np.exp(cases.random(drawing).uniform(0, np.log(given.largest))))
    points, segments = draw(name, n, cases.seed(drawing))
    points = list(symmetries(points))[(symmetry + drawing * (given.symmetries < 8)) % 8]
    cases.counts["segments"] += len(segments)
    return name, failure(points, segments, cases.random(drawing, symmetry), cases.counts), f"{len(segments)} segments"


COMPARISON = Comparison(10_000, check, add_options=add_options)
